// Literals: the value of a number as written, or what is wrong with it.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>

#include "codegen/language/syntax.hpp"

namespace hysteron::language {

struct LiteralError {
  int number = 0;
  std::string cause{};
  std::string mend{};
};

using Literal = std::variant<RealLiteral, IntLiteral, BoolLiteral, LiteralError>;

/// 42, 1_000, 16#FF, 1.5e-6. A DINT ends at 2147483647; 2147483648 is allowed only behind a minus.
Literal number_literal(std::string_view text, bool behind_minus);

/// LREAL#1.0, DINT#-3, WORD#16#FF, BOOL#TRUE; T#50us and its like are refused with their own advice.
Literal typed_literal(std::string_view text);

}  // namespace hysteron::language
