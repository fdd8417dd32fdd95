// An expression that a drawing holds as text, with its names replaced.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "blocks/description.hpp"

namespace hysteron::import {

/// What a name, and its pin where it has one, is called in the diagram.
using Rename = std::function<std::string(const std::string& name, const std::string& pin)>;

/// Nothing where the text is no single expression of the language. In brackets where it has an operator.
[[nodiscard]] std::optional<std::string> rewrite_expression(const std::string& text, const Rename& rename);

/// The type of a literal; nothing where the text is none.
[[nodiscard]] std::optional<Type> type_of_literal(const std::string& text);

}  // namespace hysteron::import
