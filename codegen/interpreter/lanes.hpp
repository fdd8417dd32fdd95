// Eight numbers side by side, as a scalar: one step of a block does the same for eight sets of parameters.
//
// Each lane has the bits of the step with double: what IEEE 754 rounds exactly is done for all lanes at once, functions
// of the C library lane by lane, and a choice takes for each lane what that lane chooses. The eight are two registers
// of 256 bits, so that one half works while the other waits for its result. The blocks are compiled with it for such
// registers (lanes_code.cpp); has_registers_of_four() says whether this processor has them.
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

namespace detail {
/// Four of the eight.
using LaneNumbers [[gnu::vector_size(32)]] = double;
using LaneChoices [[gnu::vector_size(32)]] = std::int64_t;  ///< −1 where it holds, else 0
using LaneIntegers [[gnu::vector_size(16)]] = std::int32_t;
using LaneUnsigned [[gnu::vector_size(16)]] = std::uint32_t;

// Lane by lane, with the words of evaluate.hpp and of the blocks; compiled for every processor (lane_functions.cpp).
template <Op op>
void each_function(double* x);  ///< an operation with one real operand
void each_power(double* base, const double* exponent);
void each_decayed_part(double* u);
void each_to_int(const double* x, std::int32_t* result);
void each_int_operation(Op op, const std::int32_t* a, const std::int32_t* b, std::int32_t* result);
}  // namespace detail

/// Truth values.
struct alignas(32) LaneBools {
  detail::LaneChoices low;
  detail::LaneChoices high;
  LaneBools() = default;
  HY_INLINE explicit LaneBools(bool value) : low(detail::LaneChoices{} - (value ? 1 : 0)), high(low) {}
  HY_INLINE LaneBools(const detail::LaneChoices& first, const detail::LaneChoices& last) : low(first), high(last) {}
  [[nodiscard]] HY_INLINE bool none() const { return signs(low | high) == 0; }
  [[nodiscard]] HY_INLINE bool all() const { return signs(low & high) == 0xF; }

 private:
  /// A bit each.
  [[nodiscard]] HY_INLINE static int signs(const detail::LaneChoices& four) {
#ifdef __AVX__
    return __builtin_ia32_movmskpd256(detail::LaneNumbers(four));
#else  // code that only passes lanes on
    int result = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      result |= (four[k] < 0 ? 1 : 0) << k;
    }
    return result;
#endif
  }
};

/// Integers (IEC DINT).
struct alignas(16) LaneInts {
  detail::LaneIntegers low;
  detail::LaneIntegers high;
  LaneInts() = default;
  HY_INLINE explicit LaneInts(std::int32_t value) : low(detail::LaneIntegers{} + value), high(low) {}
  HY_INLINE LaneInts(const detail::LaneIntegers& first, const detail::LaneIntegers& last) : low(first), high(last) {}
  [[nodiscard]] HY_INLINE std::int32_t lane(std::size_t k) const { return k < 4 ? low[k] : high[k - 4]; }
};

/// Words: the lower 16 bits of integers.
struct alignas(16) LaneWords {
  detail::LaneIntegers low;
  detail::LaneIntegers high;
  LaneWords() = default;
  HY_INLINE explicit LaneWords(std::uint16_t value) : low(detail::LaneIntegers{} + value), high(low) {}
  HY_INLINE LaneWords(const detail::LaneIntegers& first, const detail::LaneIntegers& last)
      : low(first & 0xFFFF), high(last & 0xFFFF) {}
};

struct alignas(32) Lanes {
  detail::LaneNumbers low;
  detail::LaneNumbers high;
  Lanes() = default;
  HY_INLINE explicit Lanes(double value) : low(detail::LaneNumbers{} + value), high(low) {}
  HY_INLINE Lanes(const detail::LaneNumbers& first, const detail::LaneNumbers& last) : low(first), high(last) {}
  [[nodiscard]] HY_INLINE double lane(std::size_t k) const { return k < 4 ? low[k] : high[k - 4]; }
  HY_INLINE void set_lane(std::size_t k, double value) {
    if (k < 4) {
      low[k] = value;
    } else {
      high[k - 4] = value;
    }
  }
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
  return {a.low + b.low, a.high + b.high};
}
HY_INLINE Lanes operator-(const Lanes& a, const Lanes& b) {
  return {a.low - b.low, a.high - b.high};
}
HY_INLINE Lanes operator*(const Lanes& a, const Lanes& b) {
  return {a.low * b.low, a.high * b.high};
}
HY_INLINE Lanes operator/(const Lanes& a, const Lanes& b) {
  return {a.low / b.low, a.high / b.high};
}
HY_INLINE Lanes operator-(const Lanes& a) {
  return {-a.low, -a.high};
}
HY_INLINE LaneBools operator<(const Lanes& a, const Lanes& b) {
  return {detail::LaneChoices(a.low < b.low), detail::LaneChoices(a.high < b.high)};
}
HY_INLINE LaneBools operator<=(const Lanes& a, const Lanes& b) {
  return {detail::LaneChoices(a.low <= b.low), detail::LaneChoices(a.high <= b.high)};
}
HY_INLINE LaneBools operator>(const Lanes& a, const Lanes& b) {
  return b < a;
}
HY_INLINE LaneBools operator>=(const Lanes& a, const Lanes& b) {
  return b <= a;
}
HY_INLINE LaneBools operator==(const Lanes& a, const Lanes& b) {
  return {detail::LaneChoices(a.low == b.low), detail::LaneChoices(a.high == b.high)};
}
HY_INLINE LaneBools operator!=(const Lanes& a, const Lanes& b) {
  return {detail::LaneChoices(a.low != b.low), detail::LaneChoices(a.high != b.high)};
}

HY_INLINE LaneBools operator!(const LaneBools& a) {
  return {~a.low, ~a.high};
}
HY_INLINE LaneBools operator&&(const LaneBools& a, const LaneBools& b) {
  return {a.low & b.low, a.high & b.high};
}
HY_INLINE LaneBools operator||(const LaneBools& a, const LaneBools& b) {
  return {a.low | b.low, a.high | b.high};
}
HY_INLINE LaneBools operator!=(const LaneBools& a, const LaneBools& b) {
  return {a.low ^ b.low, a.high ^ b.high};
}
HY_INLINE LaneBools operator==(const LaneBools& a, const LaneBools& b) {
  return {~(a.low ^ b.low), ~(a.high ^ b.high)};
}

HY_INLINE Lanes select(const LaneBools& condition, const Lanes& a, const Lanes& b) {
  return {condition.low ? a.low : b.low, condition.high ? a.high : b.high};
}
HY_INLINE LaneBools select(const LaneBools& condition, const LaneBools& a, const LaneBools& b) {
  return {(condition.low & a.low) | (~condition.low & b.low), (condition.high & a.high) | (~condition.high & b.high)};
}
HY_INLINE LaneInts select(const LaneBools& condition, const LaneInts& a, const LaneInts& b) {
  return {__builtin_convertvector(condition.low, detail::LaneIntegers) ? a.low : b.low,
          __builtin_convertvector(condition.high, detail::LaneIntegers) ? a.high : b.high};
}
HY_INLINE LaneWords select(const LaneBools& condition, const LaneWords& a, const LaneWords& b) {
  const LaneInts chosen = select(condition, LaneInts(a.low, a.high), LaneInts(b.low, b.high));
  return {chosen.low, chosen.high};
}

HY_INLINE Lanes abs(const Lanes& x) {
  using Bits = detail::LaneChoices;
  return {detail::LaneNumbers(Bits(x.low) & INT64_MAX), detail::LaneNumbers(Bits(x.high) & INT64_MAX)};
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
  alignas(32) std::array<double, lane_count> numbers{};
  __builtin_memcpy(numbers.data(), &x, sizeof(numbers));
  function(numbers.data());
  Lanes result{};
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
  alignas(32) std::array<double, lane_count> numbers{};
  alignas(32) std::array<double, lane_count> exponents{};
  __builtin_memcpy(numbers.data(), &base, sizeof(numbers));
  __builtin_memcpy(exponents.data(), &exponent, sizeof(exponents));
  detail::each_power(numbers.data(), exponents.data());
  Lanes result{};
  __builtin_memcpy(&result, numbers.data(), sizeof(numbers));
  return result;
}

HY_INLINE LaneInts to_int(const Lanes& x) {
  alignas(32) std::array<double, lane_count> numbers{};
  alignas(16) std::array<std::int32_t, lane_count> integers{};
  __builtin_memcpy(numbers.data(), &x, sizeof(numbers));
  detail::each_to_int(numbers.data(), integers.data());
  LaneInts result{};
  __builtin_memcpy(&result, integers.data(), sizeof(integers));
  return result;
}
template <class S>
requires std::is_same_v<S, Lanes> HY_INLINE Lanes to_real(const LaneInts& i) {
  return {__builtin_convertvector(i.low, detail::LaneNumbers), __builtin_convertvector(i.high, detail::LaneNumbers)};
}
HY_INLINE LaneWords int_to_word(const LaneInts& i) {
  return {i.low, i.high};
}
HY_INLINE LaneInts word_to_int(const LaneWords& word) {
  return {word.low, word.high};
}

// Integers wrap at the ends of DINT; a division or remainder by 0 gives 0.
HY_INLINE LaneInts operator+(const LaneInts& a, const LaneInts& b) {
  using Wrapping = detail::LaneUnsigned;
  return {detail::LaneIntegers(Wrapping(a.low) + Wrapping(b.low)),
          detail::LaneIntegers(Wrapping(a.high) + Wrapping(b.high))};
}
HY_INLINE LaneInts operator-(const LaneInts& a, const LaneInts& b) {
  using Wrapping = detail::LaneUnsigned;
  return {detail::LaneIntegers(Wrapping(a.low) - Wrapping(b.low)),
          detail::LaneIntegers(Wrapping(a.high) - Wrapping(b.high))};
}
HY_INLINE LaneInts operator*(const LaneInts& a, const LaneInts& b) {
  using Wrapping = detail::LaneUnsigned;
  return {detail::LaneIntegers(Wrapping(a.low) * Wrapping(b.low)),
          detail::LaneIntegers(Wrapping(a.high) * Wrapping(b.high))};
}
HY_INLINE LaneInts operator-(const LaneInts& a) {
  using Wrapping = detail::LaneUnsigned;
  return {detail::LaneIntegers(-Wrapping(a.low)), detail::LaneIntegers(-Wrapping(a.high))};
}
/// By the words of evaluate.hpp.
HY_INLINE LaneInts int_operation(Op op, const LaneInts& a, const LaneInts& b) {
  alignas(16) std::array<std::array<std::int32_t, lane_count>, 3> numbers{};
  __builtin_memcpy(numbers[0].data(), &a, sizeof(a));
  __builtin_memcpy(numbers[1].data(), &b, sizeof(b));
  detail::each_int_operation(op, numbers[0].data(), numbers[1].data(), numbers[2].data());
  LaneInts result{};
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
  return {__builtin_convertvector(a.low < b.low, detail::LaneChoices),
          __builtin_convertvector(a.high < b.high, detail::LaneChoices)};
}
HY_INLINE LaneBools operator<=(const LaneInts& a, const LaneInts& b) {
  return {__builtin_convertvector(a.low <= b.low, detail::LaneChoices),
          __builtin_convertvector(a.high <= b.high, detail::LaneChoices)};
}
HY_INLINE LaneBools operator>(const LaneInts& a, const LaneInts& b) {
  return b < a;
}
HY_INLINE LaneBools operator>=(const LaneInts& a, const LaneInts& b) {
  return b <= a;
}
HY_INLINE LaneBools operator==(const LaneInts& a, const LaneInts& b) {
  return {__builtin_convertvector(a.low == b.low, detail::LaneChoices),
          __builtin_convertvector(a.high == b.high, detail::LaneChoices)};
}
HY_INLINE LaneBools operator!=(const LaneInts& a, const LaneInts& b) {
  return {__builtin_convertvector(a.low != b.low, detail::LaneChoices),
          __builtin_convertvector(a.high != b.high, detail::LaneChoices)};
}
HY_INLINE LaneInts min(const LaneInts& a, const LaneInts& b) {
  return select(b < a, b, a);
}
HY_INLINE LaneInts max(const LaneInts& a, const LaneInts& b) {
  return select(b > a, b, a);
}

namespace detail {
HY_INLINE bool are_alike(const LaneInts& a) {
  const LaneIntegers others = (a.low ^ a.low[0]) | (a.high ^ a.low[0]);
  const auto parts = std::bit_cast<std::array<std::uint64_t, lane_count / 4>>(others);
  return (parts[0] | parts[1]) == 0;
}
}  // namespace detail

/// The element at an index, of each lane its own; an index outside is taken to the nearest end.
template <std::size_t N>
HY_INLINE Lanes at(const std::array<Lanes, N>& array, const LaneInts& index) {
  const LaneInts inside = min(max(index, LaneInts(0)), LaneInts(static_cast<std::int32_t>(N) - 1));
  if (detail::are_alike(inside)) {
    return array[static_cast<std::size_t>(inside.lane(0))];
  }
  alignas(32) std::array<double, lane_count> numbers{};
  for (std::size_t k = 0; k < lane_count; ++k) {
    numbers[k] = array[static_cast<std::size_t>(inside.lane(k))].lane(k);
  }
  Lanes result{};
  __builtin_memcpy(&result, numbers.data(), sizeof(result));
  return result;
}
template <std::size_t N>
HY_INLINE void store(std::array<Lanes, N>& array, const LaneInts& index, const Lanes& value) {
  const LaneInts inside = min(max(index, LaneInts(0)), LaneInts(static_cast<std::int32_t>(N) - 1));
  if (detail::are_alike(inside)) {
    array[static_cast<std::size_t>(inside.lane(0))] = value;
    return;
  }
  for (std::size_t k = 0; k < lane_count; ++k) {
    array[static_cast<std::size_t>(inside.lane(k))].set_lane(k, value.lane(k));
  }
}

}  // namespace hysteron

#undef HY_INLINE
