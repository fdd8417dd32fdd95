#include "codegen/language/binary_sign.hpp"

namespace hysteron::language {

BinarySign binary_sign(const Token& token) {
  switch (token.symbol) {
    case Symbol::Power:
      return {Operator::Power, 7};
    case Symbol::Star:
      return {Operator::Multiply, 6};
    case Symbol::Slash:
      return {Operator::Divide, 6};
    case Symbol::Plus:
      return {Operator::Add, 5};
    case Symbol::Minus:
      return {Operator::Subtract, 5};
    case Symbol::Less:
      return {Operator::Less, 4};
    case Symbol::LessEqual:
      return {Operator::LessEqual, 4};
    case Symbol::Greater:
      return {Operator::Greater, 4};
    case Symbol::GreaterEqual:
      return {Operator::GreaterEqual, 4};
    case Symbol::Equal:
      return {Operator::Equal, 3};
    case Symbol::NotEqual:
      return {Operator::NotEqual, 3};
    case Symbol::Ampersand:
      return {Operator::And, 2};
    default:
      break;
  }
  switch (token.keyword) {
    case Keyword::Mod:
      return {Operator::Modulo, 6};
    case Keyword::And:
      return {Operator::And, 2};
    case Keyword::Xor:
      return {Operator::Xor, 1};
    case Keyword::Or:
      return {Operator::Or, 0};
    default:
      return {};
  }
}

}  // namespace hysteron::language
