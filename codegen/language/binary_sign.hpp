// Which tokens are binary operators, and how strongly they bind: of diagrams and of sequential bodies alike.
#pragma once

#include "codegen/language/syntax.hpp"
#include "codegen/language/token.hpp"

namespace hysteron::language {

struct BinarySign {
  Operator op{};
  int strength = -1;  ///< -1: no binary operator
};

BinarySign binary_sign(const Token& token);

}  // namespace hysteron::language
