// Types and literals in Structured Text.
#pragma once

#include <string>
#include <string_view>

#include "codegen/trace/operation.hpp"

namespace hysteron {

std::string_view st_type(Type type, bool float32);

/// The range and the type of real literals.
struct StReals {
  bool float32 = false;
  bool small_literals = false;
};

/// A literal as an initial value; infinities are the largest number that the dialect can write.
std::string st_literal(Type type, double value, const StReals& reals);

/// A literal with its type. The sign stands before: LREAL#-0.5 is no number for some compilers.
std::string st_typed_literal(std::string_view type, std::string_view digits);

}  // namespace hysteron
