#include "codegen/backends/shared/words.hpp"

namespace hysteron {

std::string_view word_for_result(Op op) {
  switch (op) {
    case Op::Add:
    case Op::IntAdd:
      return "sum";
    case Op::Subtract:
    case Op::IntSubtract:
      return "difference";
    case Op::Multiply:
    case Op::IntMultiply:
      return "product";
    case Op::Divide:
    case Op::IntDivide:
      return "quotient";
    case Op::IntModulo:
      return "remainder";
    case Op::Negate:
    case Op::IntNegate:
      return "negative";
    case Op::Abs:
      return "magnitude";
    case Op::Sqrt:
      return "root";
    case Op::Exp:
      return "exponential";
    case Op::Log:
      return "logarithm";
    case Op::Power:
      return "power";
    case Op::Sin:
      return "sine";
    case Op::Cos:
      return "cosine";
    case Op::Tan:
      return "tangent";
    case Op::Asin:
    case Op::Acos:
    case Op::Atan:
      return "angle";
    case Op::Min:
    case Op::IntMin:
      return "lower";
    case Op::Max:
    case Op::IntMax:
      return "higher";
    case Op::Less:
    case Op::IntLess:
      return "is_less";
    case Op::LessEqual:
    case Op::IntLessEqual:
      return "is_at_most";
    case Op::Equal:
    case Op::IntEqual:
      return "is_equal";
    case Op::NotEqual:
    case Op::IntNotEqual:
    case Op::Xor:
      return "differs";
    case Op::And:
      return "both";
    case Op::Or:
      return "either";
    case Op::Not:
      return "is_not";
    case Op::ToInt:
      return "whole";
    case Op::ToReal:
      return "number";
    case Op::ToSingle:
      return "rounded";
    case Op::IntAnd:
    case Op::IntOr:
    case Op::IntXor:
    case Op::IntShiftLeft:
    case Op::IntShiftRight:
    case Op::WordToInt:
      return "bits";
    case Op::IntToWord:
      return "word";
    case Op::At:
      return "element";
    default:
      return "choice";
  }
}

}  // namespace hysteron
