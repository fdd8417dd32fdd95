// An expression that a drawing holds as text, with its names replaced.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "blocks/description.hpp"

namespace hysteron::import {

/// A name as an expression reads it: V, INSTANCE.PIN, or V[2] where the place is a constant.
struct NameRead {
  std::string name{};
  std::string pin{};                    ///< empty: a variable
  std::optional<std::int64_t> place{};  ///< of a variable; a computed one, or one of a pin, stays behind the name
};

/// What it is called in the diagram.
using Rename = std::function<std::string(const NameRead&)>;

/// Nothing where the text is no single expression of the language. In brackets where it has an operator.
[[nodiscard]] std::optional<std::string> rewrite_expression(const std::string& text, const Rename& rename);

/// The type of a literal; nothing where the text is none.
[[nodiscard]] std::optional<Type> type_of_literal(const std::string& text);

}  // namespace hysteron::import
