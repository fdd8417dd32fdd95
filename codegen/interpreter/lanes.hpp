// Eight numbers side by side, as a scalar: one step of a block does the same for eight sets of parameters.
//
// Each lane has the bits of the step with double: what IEEE 754 rounds exactly is done for all lanes at once, functions
// of the C library lane by lane, and a choice takes for each lane what that lane chooses. The blocks are compiled with
// it for registers of 512 bits (lanes_code.cpp); has_wide_registers() says whether this processor has them.
//
// Alignments are stated: by itself a compiler aligns a vector as the processor that it compiles for asks.
//
// Every function is inlined wherever it is called: one kept as a function of its own would be compiled twice, with wide
// registers and without, and the linker would keep one of them for all.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "blocks/filtered_rate.hpp"
#include "blocks/scalar.hpp"
#include "codegen/trace/operation.hpp"

#define HY_INLINE [[gnu::always_inline]] inline

namespace hysteron {

inline constexpr std::size_t lane_count = 8;

/// Whether this processor has registers of 512 bits, and the code for them was compiled.
[[nodiscard]] bool has_wide_registers();

namespace detail {
using LaneNumbers [[gnu::vector_size(64)]] = double;
using LaneChoices [[gnu::vector_size(64)]] = std::int64_t;  ///< −1 where it holds, else 0
using LaneIntegers [[gnu::vector_size(32)]] = std::int32_t;
using LaneBytes [[gnu::vector_size(8)]] = std::int8_t;
using LaneUnsigned [[gnu::vector_size(32)]] = std::uint32_t;

// Lane by lane, with the words of evaluate.hpp and of the blocks; compiled for every processor (lane_functions.cpp).
template <Op op>
void each_function(double* x);  ///< an operation with one real operand
void each_power(double* base, const double* exponent);
void each_decayed_part(double* u);
void each_to_int(const double* x, std::int32_t* result);
void each_int_operation(Op op, const std::int32_t* a, const std::int32_t* b, std::int32_t* result);
}  // namespace detail

/// Truth values.
struct alignas(64) LaneBools {
  detail::LaneChoices chosen;
  LaneBools() = default;
  HY_INLINE explicit LaneBools(bool value) : chosen(detail::LaneChoices{} - (value ? 1 : 0)) {}
  HY_INLINE explicit LaneBools(const detail::LaneChoices& choices) : chosen(choices) {}
  [[nodiscard]] HY_INLINE bool none() const { return bytes() == 0; }
  [[nodiscard]] HY_INLINE bool all() const { return bytes() == UINT64_MAX; }

 private:
  [[nodiscard]] HY_INLINE std::uint64_t bytes() const {
    return std::bit_cast<std::uint64_t>(__builtin_convertvector(chosen, detail::LaneBytes));
  }
};

/// Integers (IEC DINT).
struct alignas(32) LaneInts {
  detail::LaneIntegers numbers;
  LaneInts() = default;
  HY_INLINE explicit LaneInts(std::int32_t value) : numbers(detail::LaneIntegers{} + value) {}
  HY_INLINE explicit LaneInts(const detail::LaneIntegers& values) : numbers(values) {}
};

/// Words: the lower 16 bits of integers.
struct alignas(32) LaneWords {
  detail::LaneIntegers numbers;
  LaneWords() = default;
  HY_INLINE explicit LaneWords(std::uint16_t value) : numbers(detail::LaneIntegers{} + value) {}
  HY_INLINE explicit LaneWords(const detail::LaneIntegers& values) : numbers(values & 0xFFFF) {}
};

struct alignas(64) Lanes {
  detail::LaneNumbers numbers;
  Lanes() = default;
  HY_INLINE explicit Lanes(double value) : numbers(detail::LaneNumbers{} + value) {}
  HY_INLINE explicit Lanes(const detail::LaneNumbers& values) : numbers(values) {}
  [[nodiscard]] HY_INLINE double lane(std::size_t k) const { return numbers[k]; }
  HY_INLINE void set_lane(std::size_t k, double value) { numbers[k] = value; }
};

template <>
struct ScalarTypes<Lanes> {
  using Bool = LaneBools;
  using Int = LaneInts;
  using Word = LaneWords;
  template <std::size_t N>
  using Array = std::array<Lanes, N>;
};

HY_INLINE Lanes operator+(const Lanes& a, const Lanes& b) {
  return Lanes(a.numbers + b.numbers);
}
HY_INLINE Lanes operator-(const Lanes& a, const Lanes& b) {
  return Lanes(a.numbers - b.numbers);
}
HY_INLINE Lanes operator*(const Lanes& a, const Lanes& b) {
  return Lanes(a.numbers * b.numbers);
}
HY_INLINE Lanes operator/(const Lanes& a, const Lanes& b) {
  return Lanes(a.numbers / b.numbers);
}
HY_INLINE Lanes operator-(const Lanes& a) {
  return Lanes(-a.numbers);
}
HY_INLINE LaneBools operator<(const Lanes& a, const Lanes& b) {
  return LaneBools(detail::LaneChoices(a.numbers < b.numbers));
}
HY_INLINE LaneBools operator<=(const Lanes& a, const Lanes& b) {
  return LaneBools(detail::LaneChoices(a.numbers <= b.numbers));
}
HY_INLINE LaneBools operator>(const Lanes& a, const Lanes& b) {
  return b < a;
}
HY_INLINE LaneBools operator>=(const Lanes& a, const Lanes& b) {
  return b <= a;
}
HY_INLINE LaneBools operator==(const Lanes& a, const Lanes& b) {
  return LaneBools(detail::LaneChoices(a.numbers == b.numbers));
}
HY_INLINE LaneBools operator!=(const Lanes& a, const Lanes& b) {
  return LaneBools(detail::LaneChoices(a.numbers != b.numbers));
}

HY_INLINE LaneBools operator!(const LaneBools& a) {
  return LaneBools(~a.chosen);
}
HY_INLINE LaneBools operator&&(const LaneBools& a, const LaneBools& b) {
  return LaneBools(a.chosen & b.chosen);
}
HY_INLINE LaneBools operator||(const LaneBools& a, const LaneBools& b) {
  return LaneBools(a.chosen | b.chosen);
}
HY_INLINE LaneBools operator!=(const LaneBools& a, const LaneBools& b) {
  return LaneBools(a.chosen ^ b.chosen);
}
HY_INLINE LaneBools operator==(const LaneBools& a, const LaneBools& b) {
  return LaneBools(~(a.chosen ^ b.chosen));
}

HY_INLINE Lanes select(const LaneBools& condition, const Lanes& a, const Lanes& b) {
  return Lanes(condition.chosen ? a.numbers : b.numbers);
}
HY_INLINE LaneBools select(const LaneBools& condition, const LaneBools& a, const LaneBools& b) {
  return LaneBools((condition.chosen & a.chosen) | (~condition.chosen & b.chosen));
}
HY_INLINE LaneInts select(const LaneBools& condition, const LaneInts& a, const LaneInts& b) {
  const auto chosen = __builtin_convertvector(condition.chosen, detail::LaneIntegers);
  return LaneInts(chosen ? a.numbers : b.numbers);
}
HY_INLINE LaneWords select(const LaneBools& condition, const LaneWords& a, const LaneWords& b) {
  return LaneWords(select(condition, LaneInts(a.numbers), LaneInts(b.numbers)).numbers);
}

HY_INLINE Lanes abs(const Lanes& x) {
  return Lanes(detail::LaneNumbers(detail::LaneChoices(x.numbers) & INT64_MAX));
}
HY_INLINE Lanes min(const Lanes& a, const Lanes& b) {
  return select(b < a, b, a);
}
HY_INLINE Lanes max(const Lanes& a, const Lanes& b) {
  return select(b > a, b, a);
}

namespace detail {
/// The lanes, moved by a function that works in place.
template <class Function>
HY_INLINE Lanes each(Function* function, const Lanes& x) {
  alignas(64) std::array<double, lane_count> numbers;
  __builtin_memcpy(numbers.data(), &x, sizeof(numbers));
  function(numbers.data());
  Lanes result;
  __builtin_memcpy(&result, numbers.data(), sizeof(numbers));
  return result;
}
}  // namespace detail

HY_INLINE Lanes sqrt(const Lanes& x) {
  return detail::each(&detail::each_function<Op::Sqrt>, x);
}
HY_INLINE Lanes exp(const Lanes& x) {
  return detail::each(&detail::each_function<Op::Exp>, x);
}
HY_INLINE Lanes log(const Lanes& x) {
  return detail::each(&detail::each_function<Op::Log>, x);
}
HY_INLINE Lanes sin(const Lanes& x) {
  return detail::each(&detail::each_function<Op::Sin>, x);
}
HY_INLINE Lanes cos(const Lanes& x) {
  return detail::each(&detail::each_function<Op::Cos>, x);
}
HY_INLINE Lanes tan(const Lanes& x) {
  return detail::each(&detail::each_function<Op::Tan>, x);
}
HY_INLINE Lanes asin(const Lanes& x) {
  return detail::each(&detail::each_function<Op::Asin>, x);
}
HY_INLINE Lanes acos(const Lanes& x) {
  return detail::each(&detail::each_function<Op::Acos>, x);
}
HY_INLINE Lanes atan(const Lanes& x) {
  return detail::each(&detail::each_function<Op::Atan>, x);
}
HY_INLINE Lanes single(const Lanes& x) {
  return detail::each(&detail::each_function<Op::ToSingle>, x);
}
HY_INLINE Lanes decayed_part(const Lanes& u) {
  return detail::each(&detail::each_decayed_part, u);
}
HY_INLINE Lanes power(const Lanes& base, const Lanes& exponent) {
  alignas(64) std::array<double, lane_count> numbers;
  alignas(64) std::array<double, lane_count> exponents;
  __builtin_memcpy(numbers.data(), &base, sizeof(numbers));
  __builtin_memcpy(exponents.data(), &exponent, sizeof(exponents));
  detail::each_power(numbers.data(), exponents.data());
  Lanes result;
  __builtin_memcpy(&result, numbers.data(), sizeof(numbers));
  return result;
}

HY_INLINE LaneInts to_int(const Lanes& x) {
  alignas(64) std::array<double, lane_count> numbers;
  alignas(32) std::array<std::int32_t, lane_count> integers;
  __builtin_memcpy(numbers.data(), &x, sizeof(numbers));
  detail::each_to_int(numbers.data(), integers.data());
  LaneInts result;
  __builtin_memcpy(&result, integers.data(), sizeof(integers));
  return result;
}
template <class S>
requires std::is_same_v<S, Lanes> HY_INLINE Lanes to_real(const LaneInts& i) {
  return Lanes(__builtin_convertvector(i.numbers, detail::LaneNumbers));
}
HY_INLINE LaneWords int_to_word(const LaneInts& i) {
  return LaneWords(i.numbers);
}
HY_INLINE LaneInts word_to_int(const LaneWords& word) {
  return LaneInts(word.numbers);
}

namespace detail {
HY_INLINE LaneBools widened(const LaneIntegers& choices) {
  return LaneBools(__builtin_convertvector(choices, LaneChoices));
}
}  // namespace detail

// Integers wrap at the ends of DINT; a division or remainder by 0 gives 0.
HY_INLINE LaneInts operator+(const LaneInts& a, const LaneInts& b) {
  return LaneInts(detail::LaneIntegers(detail::LaneUnsigned(a.numbers) + detail::LaneUnsigned(b.numbers)));
}
HY_INLINE LaneInts operator-(const LaneInts& a, const LaneInts& b) {
  return LaneInts(detail::LaneIntegers(detail::LaneUnsigned(a.numbers) - detail::LaneUnsigned(b.numbers)));
}
HY_INLINE LaneInts operator*(const LaneInts& a, const LaneInts& b) {
  return LaneInts(detail::LaneIntegers(detail::LaneUnsigned(a.numbers) * detail::LaneUnsigned(b.numbers)));
}
HY_INLINE LaneInts operator-(const LaneInts& a) {
  return LaneInts(detail::LaneIntegers(-detail::LaneUnsigned(a.numbers)));
}
/// By the words of evaluate.hpp.
HY_INLINE LaneInts int_operation(Op op, const LaneInts& a, const LaneInts& b) {
  alignas(32) std::array<std::array<std::int32_t, lane_count>, 3> numbers;
  __builtin_memcpy(numbers[0].data(), &a, sizeof(a));
  __builtin_memcpy(numbers[1].data(), &b, sizeof(b));
  detail::each_int_operation(op, numbers[0].data(), numbers[1].data(), numbers[2].data());
  LaneInts result;
  __builtin_memcpy(&result, numbers[2].data(), sizeof(result));
  return result;
}
HY_INLINE LaneInts operator/(const LaneInts& a, const LaneInts& b) {
  return int_operation(Op::IntDivide, a, b);
}
HY_INLINE LaneInts operator%(const LaneInts& a, const LaneInts& b) {
  return int_operation(Op::IntModulo, a, b);
}
HY_INLINE LaneBools operator<(const LaneInts& a, const LaneInts& b) {
  return detail::widened(a.numbers < b.numbers);
}
HY_INLINE LaneBools operator<=(const LaneInts& a, const LaneInts& b) {
  return detail::widened(a.numbers <= b.numbers);
}
HY_INLINE LaneBools operator>(const LaneInts& a, const LaneInts& b) {
  return b < a;
}
HY_INLINE LaneBools operator>=(const LaneInts& a, const LaneInts& b) {
  return b <= a;
}
HY_INLINE LaneBools operator==(const LaneInts& a, const LaneInts& b) {
  return detail::widened(a.numbers == b.numbers);
}
HY_INLINE LaneBools operator!=(const LaneInts& a, const LaneInts& b) {
  return detail::widened(a.numbers != b.numbers);
}
HY_INLINE LaneInts min(const LaneInts& a, const LaneInts& b) {
  return select(b < a, b, a);
}
HY_INLINE LaneInts max(const LaneInts& a, const LaneInts& b) {
  return select(b > a, b, a);
}

namespace detail {
HY_INLINE bool are_alike(const LaneInts& a) {
  const LaneIntegers others = a.numbers ^ a.numbers[0];
  const auto parts = std::bit_cast<std::array<std::uint64_t, lane_count / 2>>(others);
  return (parts[0] | parts[1] | parts[2] | parts[3]) == 0;
}
}  // namespace detail

/// The element at an index, of each lane its own; an index outside is taken to the nearest end.
template <std::size_t N>
HY_INLINE Lanes at(const std::array<Lanes, N>& array, const LaneInts& index) {
  const LaneInts inside = min(max(index, LaneInts(0)), LaneInts(static_cast<std::int32_t>(N) - 1));
  if (detail::are_alike(inside)) {
    return array[static_cast<std::size_t>(inside.numbers[0])];
  }
  Lanes result;
  for (std::size_t k = 0; k < lane_count; ++k) {
    result.numbers[k] = array[static_cast<std::size_t>(inside.numbers[k])].numbers[k];
  }
  return result;
}
template <std::size_t N>
HY_INLINE void store(std::array<Lanes, N>& array, const LaneInts& index, const Lanes& value) {
  const LaneInts inside = min(max(index, LaneInts(0)), LaneInts(static_cast<std::int32_t>(N) - 1));
  if (detail::are_alike(inside)) {
    array[static_cast<std::size_t>(inside.numbers[0])] = value;
    return;
  }
  for (std::size_t k = 0; k < lane_count; ++k) {
    array[static_cast<std::size_t>(inside.numbers[k])].numbers[k] = value.numbers[k];
  }
}

}  // namespace hysteron

#undef HY_INLINE
