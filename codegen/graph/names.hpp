// Names and literals of the language: types, reserved words.
#pragma once

#include <string>
#include <string_view>

#include "blocks/description.hpp"

namespace hysteron {

/// Names that the portable subset keeps for itself.
bool is_reserved(std::string_view name);

/// Whether a name is given to a type: LREAL, BOOL, DINT, WORD.
bool elementary_type(std::string_view name, Type& type);
std::string_view type_name(Type type);

/// A literal of the language, as text: 1.5, TRUE, 3, WORD#16#1.
std::string literal_text(Type type, double value);

}  // namespace hysteron
