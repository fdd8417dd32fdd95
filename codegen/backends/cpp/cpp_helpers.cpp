#include "codegen/backends/cpp/cpp_helpers.hpp"

#include <array>
#include <initializer_list>
#include <string_view>

namespace hysteron {
namespace {

struct Helper {
  Operations callers;  ///< none: called where an element of an array is set
  std::string_view text;
};

constexpr Operations any_of(std::initializer_list<Op> list) {
  unsigned long long bits = 0;
  for (const Op op : list) {
    bits |= 1ULL << static_cast<unsigned>(op);
  }
  return {bits};
}

constexpr std::array helpers{
    Helper{any_of({Op::Power}), R"(// base^exponent; the common exponents have a path of their own.
inline Real power(Real base, Real exponent) noexcept {
  if (exponent == Real(1)) {
    return base;
  }
  if (exponent == Real(0.5)) {
    return std::sqrt(base);
  }
  if (exponent == Real(2)) {
    return base * base;
  }
  if (exponent == Real(0)) {
    return Real(1);
  }
  return std::pow(base, exponent);
}
)"},
    Helper{any_of({Op::Min, Op::IntMin}), R"(template <class T>
T min(T a, T b) noexcept {
  return b < a ? b : a;
}
)"},
    Helper{any_of({Op::Max, Op::IntMax}), R"(template <class T>
T max(T a, T b) noexcept {
  return b > a ? b : a;
}
)"},
    Helper{any_of({Op::ToInt}), R"(// Towards zero; saturates at the ends, 0 for not-a-number.
inline std::int32_t to_int(Real x) noexcept {
  if (!(x > Real(-2147483648.0))) {
    return x != x ? 0 : std::numeric_limits<std::int32_t>::min();
  }
  return x < Real(2147483648.0) ? static_cast<std::int32_t>(x) : std::numeric_limits<std::int32_t>::max();
}
)"},
    Helper{any_of({Op::At}), R"(template <std::size_t N>
const Real& at(const std::array<Real, N>& array, std::int32_t index) noexcept {
  constexpr auto last = static_cast<std::int32_t>(N) - 1;
  return array[static_cast<std::size_t>(index < 0 ? 0 : (index > last ? last : index))];
}
)"},
    Helper{any_of({}), R"(template <std::size_t N>
void store(std::array<Real, N>& array, std::int32_t index, Real value) noexcept {
  constexpr auto last = static_cast<std::int32_t>(N) - 1;
  array[static_cast<std::size_t>(index < 0 ? 0 : (index > last ? last : index))] = value;
}
)"},
    Helper{any_of({Op::IntAdd, Op::IntSubtract, Op::IntMultiply, Op::IntDivide, Op::IntModulo, Op::IntNegate}),
           R"(// DINT wraps at its ends; a division by zero gives 0.
inline std::int32_t wrap(std::int64_t x) noexcept { return static_cast<std::int32_t>(static_cast<std::uint32_t>(x)); }
)"},
    Helper{any_of({Op::IntAdd}),
           "inline std::int32_t add(std::int32_t a, std::int32_t b) noexcept { return wrap(std::int64_t{a} + b); }\n"},
    Helper{any_of({Op::IntSubtract}),
           "inline std::int32_t subtract(std::int32_t a, std::int32_t b) noexcept { return wrap(std::int64_t{a} - b); "
           "}\n"},
    Helper{any_of({Op::IntMultiply}),
           "inline std::int32_t multiply(std::int32_t a, std::int32_t b) noexcept { return wrap(std::int64_t{a} * b); "
           "}\n"},
    Helper{any_of({Op::IntDivide}),
           "inline std::int32_t divide(std::int32_t a, std::int32_t b) noexcept { return b == 0 ? 0 : "
           "wrap(std::int64_t{a} / b); }\n"},
    Helper{any_of({Op::IntModulo}),
           "inline std::int32_t modulo(std::int32_t a, std::int32_t b) noexcept { return b == 0 ? 0 : "
           "wrap(std::int64_t{a} % b); }\n"},
    Helper{any_of({Op::IntAnd, Op::IntOr, Op::IntXor, Op::IntShiftLeft, Op::IntShiftRight}),
           R"(inline std::uint32_t bits(std::int32_t x) noexcept { return static_cast<std::uint32_t>(x); }
)"},
    Helper{any_of({Op::IntAnd}),
           "inline std::int32_t bits_and(std::int32_t a, std::int32_t b) noexcept { return "
           "static_cast<std::int32_t>(bits(a) & bits(b)); }\n"},
    Helper{any_of({Op::IntOr}),
           "inline std::int32_t bits_or(std::int32_t a, std::int32_t b) noexcept { return "
           "static_cast<std::int32_t>(bits(a) | bits(b)); }\n"},
    Helper{any_of({Op::IntXor}),
           "inline std::int32_t bits_xor(std::int32_t a, std::int32_t b) noexcept { return "
           "static_cast<std::int32_t>(bits(a) ^ bits(b)); }\n"},
    Helper{any_of({Op::IntShiftLeft}),
           "inline std::int32_t shift_left(std::int32_t a, std::int32_t places) noexcept { return "
           "static_cast<std::int32_t>(bits(a) << bits(places)); }\n"},
    Helper{any_of({Op::IntShiftRight}),
           "inline std::int32_t shift_right(std::int32_t a, std::int32_t places) noexcept { return "
           "static_cast<std::int32_t>(bits(a) >> bits(places)); }\n"},
    Helper{any_of({Op::ToSingle}),
           R"(// The nearest number of 32 bits. Through memory, since GCC 12 leaves two of them side by side unrounded.
inline Real single(Real x) noexcept {
  volatile float nearest = static_cast<float>(x);
  return static_cast<Real>(nearest);
}
)"},
    Helper{any_of({Op::IntNegate}),
           "inline std::int32_t negate(std::int32_t a) noexcept { return wrap(-std::int64_t{a}); }\n"},
};

}  // namespace

std::string cpp_helper_functions(const Operations& operations, bool stores) {
  std::string text;
  for (const Helper& helper : helpers) {
    if (helper.callers.none() ? stores : (helper.callers & operations).any()) {
      text.append(helper.text).append("\n");
    }
  }
  return text.empty() ? text : "namespace detail {\n\n" + text + "}  // namespace detail\n\n";
}

}  // namespace hysteron
