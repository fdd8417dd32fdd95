// What types, functions and literals of other systems are in a diagram.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "blocks/description.hpp"
#include "codegen/trace/block_type.hpp"

namespace hysteron::import {

struct KnownType {
  Type type = Type::Real;
  std::string_view note{};  ///< what to mind; empty where it is the same type
};

/// An elementary type, by its name in IEC 61131-3; nothing where no type of a diagram can stand for it.
[[nodiscard]] std::optional<KnownType> known_type(std::string_view name);

/// The block of the library that a function block of the standard is: TON is HY_TON. Null where there is none.
[[nodiscard]] const BlockType* known_block(std::string_view name);

/// The function of a diagram that does the same: REAL_TO_DINT is LREAL_TO_DINT. "MOVE" for what hands its input on;
/// empty where there is none.
[[nodiscard]] std::string known_function(std::string_view name);

/// A text with its literals as a diagram has them: T#500ms is 0.5, REAL#1.5 is LREAL#1.5, INT#3 is DINT#3.
[[nodiscard]] std::string with_known_literals(std::string_view text);

/// T#1s500ms in seconds; nothing where it is no duration.
[[nodiscard]] std::optional<double> seconds_of(std::string_view literal);

}  // namespace hysteron::import
