// The vocabulary of scalar operations: all that a block may compute with.
//
// A block is written once, templated over a scalar S. S is double or float on a machine, a dual number where
// a derivative is wanted, lanes where several run side by side, or a traced scalar where text is generated. Each kind
// of scalar offers:
//
//   arithmetic   + - * / unary-           comparison  < <= > >= == !=       logic   ! && || !=
//   abs sqrt exp log sin cos tan asin acos atan        power(base, exponent)   min max
//   select(condition, a, b)               to_int (towards zero)   to_real
//   at(array, index)   store(array, index, value)   fill(array, value)   value_of   vanishes
//
// What costs much is written with either(condition, a, b) and unless_zero(factor, at_zero, value), which leave out on a
// number what is not chosen.
//
// A signal-dependent choice is select, never `if`: a traced scalar has no truth value. Both sides of a select
// are evaluated, so a side may be infinite or NaN where it is not chosen. Literals are written S(0.5); integers
// Int<S>(3). Loops have a fixed length.
#pragma once

#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>

#if defined(__FAST_MATH__)
#error "Hysteron promises equal bits on every target; -ffast-math breaks that promise. Remove the flag."
#endif

namespace hysteron {

/// The companions of a real scalar: its truth values, its integers (IEC DINT), its words and its arrays.
template <class S>
struct ScalarTypes {
  using Bool = bool;
  using Int = std::int32_t;
  using Word = std::uint16_t;
  template <std::size_t N>
  using Array = std::array<S, N>;
};

template <class S>
using Bool = typename ScalarTypes<S>::Bool;
template <class S>
using Int = typename ScalarTypes<S>::Int;
template <class S>
using Word = typename ScalarTypes<S>::Word;
template <class S, std::size_t N>
using Array = typename ScalarTypes<S>::template Array<N>;

template <class S>
concept MachineReal = std::is_same_v<S, double> || std::is_same_v<S, float>;

/// A scalar whose conditions are known as it computes: all but the traced ones.
template <class S>
inline constexpr bool is_number = std::is_same_v<Bool<S>, bool>;

template <MachineReal S>
S abs(S x) {
  return std::fabs(x);
}
template <MachineReal S>
S sqrt(S x) {
  return std::sqrt(x);
}
template <MachineReal S>
S exp(S x) {
  return std::exp(x);
}
template <MachineReal S>
S log(S x) {
  return std::log(x);
}
template <MachineReal S>
S sin(S x) {
  return std::sin(x);
}
template <MachineReal S>
S cos(S x) {
  return std::cos(x);
}
template <MachineReal S>
S tan(S x) {
  return std::tan(x);
}
template <MachineReal S>
S asin(S x) {
  return std::asin(x);
}
template <MachineReal S>
S acos(S x) {
  return std::acos(x);
}
template <MachineReal S>
S atan(S x) {
  return std::atan(x);
}

/// base^exponent. The exponents 0, 1/2, 1 and 2 have a path of their own: pow is most of the cost of a hysteresis
/// step, and these are the common ones. Every target computes power by this same rule, so that bits agree.
template <MachineReal S>
S power(S base, S exponent) {
  if (exponent == S(1)) {
    return base;
  }
  if (exponent == S(0.5)) {
    return std::sqrt(base);
  }
  if (exponent == S(2)) {
    return base * base;
  }
  if (exponent == S(0)) {
    return S(1);
  }
  return std::pow(base, exponent);
}

/// The smaller (larger) of two; a where they are equal or where b is not a number.
template <class S>
requires MachineReal<S> || std::is_same_v<S, std::int32_t> S min(S a, S b) {
  return b < a ? b : a;
}
template <class S>
requires MachineReal<S> || std::is_same_v<S, std::int32_t> S max(S a, S b) {
  return b > a ? b : a;
}

/// a where the condition holds, else b. Both are evaluated.
template <class T>
T select(bool condition, const T& a, const T& b) {
  return condition ? a : b;
}

/// A scalar of several numbers side by side: as it computes, it is known whether all of them or none meet a condition.
template <class S>
concept SideBySide = requires(const Bool<S>& condition) {
  { condition.all() } -> std::same_as<bool>;
  { condition.none() } -> std::same_as<bool>;
};

/// select of two values that cost much: of numbers only the chosen one is worked out, of numbers side by side what any
/// of them chooses, of traced scalars both are.
template <class S, class First, class Second>
S either(const Bool<S>& condition, const First& a, const Second& b) {
  if constexpr (is_number<S>) {
    return condition ? a() : b();
  } else if constexpr (SideBySide<S>) {
    return condition.all() ? a() : condition.none() ? b() : select(condition, a(), b());
  } else {
    const S first = a();
    const S second = b();
    return select(condition, first, second);
  }
}

/// Whether a number is 0 and stays 0, as a parameter that is not used does: a dual one with a derivative does not.
template <MachineReal S>
bool vanishes(S x) {
  return x == S(0);
}

/// A value that costs much and is `at_zero` where `factor` is 0, also where the value is then infinite or not a number:
/// of numbers it is worked out only where that does not vanish, side by side where any does not, of traced scalars
/// always.
template <class T, class S, class Value>
T unless_zero(const S& factor, const T& at_zero, const Value& value) {
  if constexpr (is_number<S>) {
    return vanishes(factor) ? at_zero : value();
  } else if constexpr (SideBySide<S>) {
    const Bool<S> zero = factor == S(0.0);
    return zero.all() ? at_zero : zero.none() ? value() : select(zero, at_zero, value());
  } else {
    return select(factor == S(0.0), at_zero, value());
  }
}

/// Towards zero, as IEC 61131-3 TRUNC; saturates at the ends of DINT, and 0 for not-a-number, so that no input is
/// undefined.
template <MachineReal S>
std::int32_t to_int(S x) {
  constexpr auto lowest = std::numeric_limits<std::int32_t>::min();
  constexpr auto highest = std::numeric_limits<std::int32_t>::max();
  if (!(x > S(-2147483648.0))) {
    return x != x ? 0 : lowest;
  }
  return x < S(2147483648.0) ? static_cast<std::int32_t>(x) : highest;
}

/// An integer as a real number: to_real<S>(i). It stands here for every scalar whose integers are machine integers,
/// since a call whose only argument is an int finds no overload that is declared after the block.
template <class S>
requires std::is_same_v<Int<S>, std::int32_t> S to_real(std::int32_t i) {
  return static_cast<S>(static_cast<double>(i));
}

/// The element at an index; an index outside is taken to the nearest end.
template <class S, std::size_t N>
const S& at(const std::array<S, N>& array, std::int32_t index) {
  constexpr auto last = static_cast<std::int32_t>(N) - 1;
  return array[static_cast<std::size_t>(index < 0 ? 0 : (index > last ? last : index))];
}

/// Writes the element at an index, in place; an index outside is taken to the nearest end.
template <class S, std::size_t N>
void store(std::array<S, N>& array, std::int32_t index, const S& value) {
  constexpr auto last = static_cast<std::int32_t>(N) - 1;
  array[static_cast<std::size_t>(index < 0 ? 0 : (index > last ? last : index))] = value;
}

/// Writes every element.
template <class S, std::size_t N>
void fill(std::array<S, N>& array, const S& value) {
  array.fill(value);
}

/// The plain number inside a scalar.
template <MachineReal S>
double value_of(S x) {
  return static_cast<double>(x);
}

}  // namespace hysteron
