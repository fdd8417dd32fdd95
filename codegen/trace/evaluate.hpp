// The value of an operation, with any machine scalar: constant folding and the interpreter use the same words.
#pragma once

#include <cstdint>
#include <limits>

#include "blocks/scalar.hpp"
#include "codegen/trace/operation.hpp"
#include "support/single.hpp"

namespace hysteron {

/// DINT arithmetic: wraps at the ends; a division or remainder by zero gives 0.
inline std::int32_t wrap(std::int64_t x) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(x));
}
inline std::uint32_t bits(std::int32_t x) {
  return static_cast<std::uint32_t>(x);
}
inline std::int32_t int_operation(Op op, std::int32_t a, std::int32_t b) {
  const auto x = static_cast<std::int64_t>(a);
  const auto y = static_cast<std::int64_t>(b);
  switch (op) {
    case Op::IntAdd:
      return wrap(x + y);
    case Op::IntSubtract:
      return wrap(x - y);
    case Op::IntMultiply:
      return wrap(x * y);
    case Op::IntDivide:
      return y == 0 ? 0 : wrap(x / y);
    case Op::IntModulo:
      return y == 0 ? 0 : wrap(x % y);
    case Op::IntNegate:
      return wrap(-x);
    case Op::IntMin:
      return min(a, b);
    case Op::IntAnd:
      return wrap(bits(a) & bits(b));
    case Op::IntOr:
      return wrap(bits(a) | bits(b));
    case Op::IntXor:
      return wrap(bits(a) ^ bits(b));
    case Op::IntShiftLeft:
      return wrap(bits(a) << (bits(b) & 31U));
    case Op::IntShiftRight:
      return wrap(bits(a) >> (bits(b) & 31U));
    default:
      return max(a, b);
  }
}

/// The nearest number that an IEC REAL holds.
template <MachineReal S>
S single(S x) {
  return static_cast<S>(nearest_single(static_cast<double>(x)));
}
/// The lower 16 bits, and back.
inline std::uint16_t int_to_word(std::int32_t x) {
  return static_cast<std::uint16_t>(bits(x) & 0xFFFFU);
}
inline std::int32_t word_to_int(std::uint16_t x) {
  return x;
}

template <class S>
S real_operation(Op op, const S& a, const S& b) {
  switch (op) {
    case Op::Add:
      return a + b;
    case Op::Subtract:
      return a - b;
    case Op::Multiply:
      return a * b;
    case Op::Divide:
      return a / b;
    case Op::Negate:
      return -a;
    case Op::Abs:
      return abs(a);
    case Op::Sqrt:
      return sqrt(a);
    case Op::Exp:
      return exp(a);
    case Op::Log:
      return log(a);
    case Op::Sin:
      return sin(a);
    case Op::Cos:
      return cos(a);
    case Op::Tan:
      return tan(a);
    case Op::Asin:
      return asin(a);
    case Op::Acos:
      return acos(a);
    case Op::Atan:
      return atan(a);
    case Op::Power:
      return power(a, b);
    case Op::Min:
      return min(a, b);
    case Op::ToSingle:
      return single(a);
    default:
      return max(a, b);
  }
}

template <class T>
auto comparison(Op op, const T& a, const T& b) {
  switch (op) {
    case Op::Less:
    case Op::IntLess:
      return a < b;
    case Op::LessEqual:
    case Op::IntLessEqual:
      return a <= b;
    case Op::Equal:
    case Op::IntEqual:
      return a == b;
    default:
      return a != b;
  }
}

template <class T>
T bool_operation(Op op, const T& a, const T& b) {
  switch (op) {
    case Op::And:
      return a && b;
    case Op::Or:
      return a || b;
    case Op::Xor:
      return a != b;
    default:
      return !a;
  }
}

}  // namespace hysteron
