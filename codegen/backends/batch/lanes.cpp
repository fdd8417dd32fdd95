#include "codegen/backends/batch/lanes.hpp"

namespace hysteron {

const std::string_view lanes_text =
    R"(// What the code computes with: as many registers as eight lanes take. A truth value is 0 or -1 in each lane.
typedef double RealPart __attribute__((vector_size(8 * HYSTERON_LANES)));
typedef std::int64_t IntPart __attribute__((vector_size(8 * HYSTERON_LANES)));
constexpr int parts = static_cast<int>(width) / HYSTERON_LANES;

// Written out, since a compiler that unrolls a loop does it too late to keep the parts in registers.
template <class Function>
HYSTERON_INLINE void for_each_part(Function function) {
  function(0);
  if constexpr (parts > 1) {
    function(1);
  }
  if constexpr (parts > 2) {
    function(2);
    function(3);
  }
}

template <class Part, class Memory, class Number>
struct Lanes {
  Part part[parts];

  Lanes() = default;
  HYSTERON_INLINE Lanes(const Memory& memory) {
    for_each_part([&](int i) HYSTERON_ALWAYS {
      std::memcpy(&part[i], memory.lane + i * HYSTERON_LANES, sizeof(Part));
    });
  }
  HYSTERON_INLINE void store(Memory& memory) const {
    for_each_part([&](int i) HYSTERON_ALWAYS {
      std::memcpy(memory.lane + i * HYSTERON_LANES, &part[i], sizeof(Part));
    });
  }
  HYSTERON_INLINE operator Memory() const {
    Memory memory;
    store(memory);
    return memory;
  }
  HYSTERON_INLINE Number operator[](int lane) const { return part[lane / HYSTERON_LANES][lane % HYSTERON_LANES]; }
};
typedef Lanes<RealPart, HYSTERON_MEMORY(Real), double> Real;
typedef Lanes<IntPart, HYSTERON_MEMORY(Int), std::int64_t> Int;

// A function of parts, part by part.
template <class Result, class Function>
HYSTERON_INLINE Result by_part(Function function) {
  Result result;
  for_each_part([&](int i) HYSTERON_ALWAYS { result.part[i] = function(i); });
  return result;
}
#define HYSTERON_PARTS(Result, expression) by_part<Result>([&](int i) HYSTERON_ALWAYS { return expression; })

HYSTERON_INLINE Real operator+(const Real& a, const Real& b) { return HYSTERON_PARTS(Real, a.part[i] + b.part[i]); }
HYSTERON_INLINE Real operator-(const Real& a, const Real& b) { return HYSTERON_PARTS(Real, a.part[i] - b.part[i]); }
HYSTERON_INLINE Real operator*(const Real& a, const Real& b) { return HYSTERON_PARTS(Real, a.part[i] * b.part[i]); }
HYSTERON_INLINE Real operator/(const Real& a, const Real& b) { return HYSTERON_PARTS(Real, a.part[i] / b.part[i]); }
HYSTERON_INLINE Real operator-(const Real& a) { return HYSTERON_PARTS(Real, -a.part[i]); }
HYSTERON_INLINE Int operator<(const Real& a, const Real& b) { return HYSTERON_PARTS(Int, a.part[i] < b.part[i]); }
HYSTERON_INLINE Int operator<=(const Real& a, const Real& b) { return HYSTERON_PARTS(Int, a.part[i] <= b.part[i]); }
HYSTERON_INLINE Int operator==(const Real& a, const Real& b) { return HYSTERON_PARTS(Int, a.part[i] == b.part[i]); }
HYSTERON_INLINE Int operator!=(const Real& a, const Real& b) { return HYSTERON_PARTS(Int, a.part[i] != b.part[i]); }
HYSTERON_INLINE Int operator<(const Int& a, const Int& b) { return HYSTERON_PARTS(Int, a.part[i] < b.part[i]); }
HYSTERON_INLINE Int operator<=(const Int& a, const Int& b) { return HYSTERON_PARTS(Int, a.part[i] <= b.part[i]); }
HYSTERON_INLINE Int operator==(const Int& a, const Int& b) { return HYSTERON_PARTS(Int, a.part[i] == b.part[i]); }
HYSTERON_INLINE Int operator!=(const Int& a, const Int& b) { return HYSTERON_PARTS(Int, a.part[i] != b.part[i]); }

namespace lanes {

// The same value in all lanes.
#if HYSTERON_LANES == 8
#define HYSTERON_SPREAD(x) {x, x, x, x, x, x, x, x}
#elif HYSTERON_LANES == 4
#define HYSTERON_SPREAD(x) {x, x, x, x}
#else
#define HYSTERON_SPREAD(x) {x, x}
#endif
HYSTERON_INLINE Real all(double x) {
  const RealPart part = HYSTERON_SPREAD(x);
  return by_part<Real>([&](int) HYSTERON_ALWAYS { return part; });
}
HYSTERON_INLINE Int all(std::int32_t x) {
  const IntPart part = HYSTERON_SPREAD(x);
  return by_part<Int>([&](int) HYSTERON_ALWAYS { return part; });
}
#undef HYSTERON_SPREAD
HYSTERON_INLINE Int all(bool x) { return all(x ? -1 : 0); }

// A function of numbers, lane by lane.
template <class Function>
HYSTERON_INLINE Real each(Function function) {
  const HYSTERON_MEMORY(Real) memory = {function(0), function(1), function(2), function(3),
                                        function(4), function(5), function(6), function(7)};
  return memory;
}
template <class Function>
HYSTERON_INLINE Int each_int(Function function) {
  const HYSTERON_MEMORY(Int) memory = {function(0), function(1), function(2), function(3),
                                       function(4), function(5), function(6), function(7)};
  return memory;
}

HYSTERON_INLINE Int both(const Int& a, const Int& b) { return HYSTERON_PARTS(Int, a.part[i] & b.part[i]); }
HYSTERON_INLINE Int either(const Int& a, const Int& b) { return HYSTERON_PARTS(Int, a.part[i] | b.part[i]); }
HYSTERON_INLINE Int one_of(const Int& a, const Int& b) { return HYSTERON_PARTS(Int, a.part[i] ^ b.part[i]); }
HYSTERON_INLINE Int no(const Int& a) { return HYSTERON_PARTS(Int, ~a.part[i]); }

HYSTERON_INLINE bool any(const Int& x) {
  IntPart part = x.part[0];
  for (int i = 1; i < parts; ++i) {
    part |= x.part[i];
  }
#if HYSTERON_LANES == 8
  return _mm512_test_epi64_mask((__m512i)part, (__m512i)part) != 0;
#elif HYSTERON_LANES == 4
  return _mm256_testz_si256((__m256i)part, (__m256i)part) == 0;
#else
  return (part[0] | part[1]) != 0;
#endif
}

HYSTERON_INLINE Real select(const Int& which, const Real& yes, const Real& otherwise) {
  return HYSTERON_PARTS(Real, which.part[i] ? yes.part[i] : otherwise.part[i]);
}
HYSTERON_INLINE Int select(const Int& which, const Int& yes, const Int& otherwise) {
  return HYSTERON_PARTS(Int, which.part[i] ? yes.part[i] : otherwise.part[i]);
}
HYSTERON_INLINE Real min(const Real& a, const Real& b) { return select(b < a, b, a); }
HYSTERON_INLINE Real max(const Real& a, const Real& b) { return select(a < b, b, a); }
HYSTERON_INLINE Int min(const Int& a, const Int& b) { return select(b < a, b, a); }
HYSTERON_INLINE Int max(const Int& a, const Int& b) { return select(a < b, b, a); }

HYSTERON_INLINE Real abs(const Real& x) {
  const Int sign = all(-2147483647 - 1);
  return HYSTERON_PARTS(Real, (RealPart)((IntPart)x.part[i] & ~(sign.part[i] << 32)));
}
HYSTERON_INLINE RealPart root(RealPart x) {
#if HYSTERON_LANES == 8
  return (RealPart)_mm512_maskz_sqrt_pd(0xFF, (__m512d)x);
#elif HYSTERON_LANES == 4
  return (RealPart)_mm256_sqrt_pd((__m256d)x);
#else
  return RealPart{std::sqrt(x[0]), std::sqrt(x[1])};
#endif
}
HYSTERON_INLINE Real sqrt(const Real& x) { return HYSTERON_PARTS(Real, root(x.part[i])); }

// An integer of 32 bits stands in 64: it wraps at its ends; a division by zero gives 0.
HYSTERON_INLINE Int wrap(const Int& x) { return HYSTERON_PARTS(Int, (x.part[i] << 32) >> 32); }
HYSTERON_INLINE Int add(const Int& a, const Int& b) { return wrap(HYSTERON_PARTS(Int, a.part[i] + b.part[i])); }
HYSTERON_INLINE Int subtract(const Int& a, const Int& b) { return wrap(HYSTERON_PARTS(Int, a.part[i] - b.part[i])); }
HYSTERON_INLINE Int multiply(const Int& a, const Int& b) { return wrap(HYSTERON_PARTS(Int, a.part[i] * b.part[i])); }
HYSTERON_INLINE Int negate(const Int& a) { return wrap(HYSTERON_PARTS(Int, -a.part[i])); }
HYSTERON_INLINE Int divide(const Int& a, const Int& b) {
  return wrap(each_int([&](int i) { return b[i] == 0 ? std::int64_t{0} : a[i] / b[i]; }));
}
HYSTERON_INLINE Int modulo(const Int& a, const Int& b) {
  return wrap(each_int([&](int i) { return b[i] == 0 ? std::int64_t{0} : a[i] % b[i]; }));
}
HYSTERON_INLINE Int shift_left(const Int& a, const Int& places) {
  return wrap(HYSTERON_PARTS(Int, a.part[i] << places.part[i]));
}
HYSTERON_INLINE Int shift_right(const Int& a, const Int& places) {
  return wrap(each_int([&](int i) {
    return static_cast<std::int64_t>(static_cast<std::uint32_t>(a[i]) >> static_cast<std::uint32_t>(places[i]));
  }));
}
HYSTERON_INLINE Int word(const Int& x) { return both(x, all(0xFFFF)); }
HYSTERON_INLINE Int same(const Int& x) { return x; }

// Towards zero; saturates at the ends, 0 for not-a-number.
HYSTERON_INLINE std::int64_t to_int(double x) {
  return x >= 2147483648.0    ? std::int64_t{2147483647}
         : x > -2147483648.0  ? std::int64_t{static_cast<std::int32_t>(x)}
         : x <= -2147483648.0 ? std::int64_t{-2147483647} - 1
                              : std::int64_t{0};
}
HYSTERON_INLINE Int to_int(const Real& x) {
  return each_int([&](int i) { return to_int(x[i]); });
}
HYSTERON_INLINE Real to_real(const Int& x) {
  return each([&](int i) { return static_cast<double>(static_cast<std::int32_t>(x[i])); });
}
// The nearest number of 32 bits. Through memory, since GCC 12 leaves two of them side by side unrounded.
HYSTERON_INLINE Real single(const Real& x) {
  return each([&](int i) {
    volatile float nearest = static_cast<float>(x[i]);
    return static_cast<double>(nearest);
  });
}

HYSTERON_INLINE void set(HYSTERON_MEMORY(Real)& memory, const Real& value) { value.store(memory); }
HYSTERON_INLINE void set(HYSTERON_MEMORY(Int)& memory, const Int& value) { value.store(memory); }
template <std::size_t N>
HYSTERON_INLINE void fill(std::array<HYSTERON_MEMORY(Real), N>& array, const Real& value) {
  for (HYSTERON_MEMORY(Real)& one : array) {
    value.store(one);
  }
}

// An index outside of an array is taken to its nearest end.
HYSTERON_INLINE std::size_t place(std::int64_t index, std::size_t length) {
  return index < 0 ? 0 : static_cast<std::size_t>(index) < length ? static_cast<std::size_t>(index) : length - 1;
}
template <std::size_t N>
HYSTERON_INLINE Real at(const std::array<HYSTERON_MEMORY(Real), N>& array, const Int& index) {
  return each([&](int i) { return array[place(index[i], N)].lane[i]; });
}
template <std::size_t N>
HYSTERON_INLINE void store(std::array<HYSTERON_MEMORY(Real), N>& array, const Int& index, const Real& value) {
  for (int i = 0; i < static_cast<int>(width); ++i) {
    array[place(index[i], N)].lane[i] = value[i];
  }
}

)"
    R"(// The functions of the C library, lane by lane: the bits of the step.
namespace same_bits {
HYSTERON_INLINE Real exp(const Real& x) {
  return c_library(x, [](double a) { return std::exp(a); });
}
HYSTERON_INLINE Real log(const Real& x) {
  return c_library(x, [](double a) { return std::log(a); });
}
HYSTERON_INLINE Real sin(const Real& x) {
  return c_library(x, [](double a) { return std::sin(a); });
}
HYSTERON_INLINE Real cos(const Real& x) {
  return c_library(x, [](double a) { return std::cos(a); });
}
HYSTERON_INLINE Real tan(const Real& x) {
  return c_library(x, [](double a) { return std::tan(a); });
}
HYSTERON_INLINE Real asin(const Real& x) {
  return c_library(x, [](double a) { return std::asin(a); });
}
HYSTERON_INLINE Real acos(const Real& x) {
  return c_library(x, [](double a) { return std::acos(a); });
}
HYSTERON_INLINE Real atan(const Real& x) {
  return c_library(x, [](double a) { return std::atan(a); });
}
HYSTERON_INLINE Real pow(const Real& x, const Real& y) {
  return c_library(x, y, [](double a, double b) { return std::pow(a, b); });
}
}  // namespace same_bits

#ifdef HYSTERON_LIBMVEC
// libmvec's functions, for as many lanes as a register has: within 4 units in the last place.
#if HYSTERON_LANES == 8
#define HYSTERON_MVEC(form, name) _ZGVeN8##form##_##name
#elif HYSTERON_LANES == 4
#define HYSTERON_MVEC(form, name) _ZGVdN4##form##_##name
#else
#define HYSTERON_MVEC(form, name) _ZGVbN2##form##_##name
#endif
#define HYSTERON_FUNCTION(name)                               \
  extern "C" RealPart HYSTERON_MVEC(v, name)(RealPart);       \
  HYSTERON_INLINE Real name(const Real& x) {                  \
    return HYSTERON_PARTS(Real, HYSTERON_MVEC(v, name)(x.part[i])); \
  }
HYSTERON_FUNCTION(exp)
HYSTERON_FUNCTION(log)
HYSTERON_FUNCTION(sin)
HYSTERON_FUNCTION(cos)
#if __GLIBC_PREREQ(2, 35)
HYSTERON_FUNCTION(tan)
HYSTERON_FUNCTION(asin)
HYSTERON_FUNCTION(acos)
HYSTERON_FUNCTION(atan)
#else
using same_bits::acos;
using same_bits::asin;
using same_bits::atan;
using same_bits::tan;
#endif
extern "C" RealPart HYSTERON_MVEC(vv, pow)(RealPart, RealPart);
// A base of zero takes all lanes through the C library, one by one: such lanes go there alone.
HYSTERON_INLINE Real pow(const Real& x, const Real& y) {
  const Int zero = x == all(0.0);
  const Real base = select(zero, all(1.0), x);
  const Real result = HYSTERON_PARTS(Real, HYSTERON_MVEC(vv, pow)(base.part[i], y.part[i]));
  return any(zero) ? select(zero, same_bits::pow(select(zero, x, all(1.0)), y), result) : result;
}
#undef HYSTERON_FUNCTION
#undef HYSTERON_MVEC
#else
using namespace same_bits;
#endif

// base^exponent; the common exponents have a path of their own.
HYSTERON_INLINE Real power(const Real& base, const Real& exponent) {
  const Int one = exponent == all(1.0);
  const Int half = exponent == all(0.5);
  const Int two = exponent == all(2.0);
  const Int zero = exponent == all(0.0);
  const Int common = either(either(one, half), either(two, zero));
  Real result = base;
  if (any(no(common))) {
    result = pow(base, select(common, all(1.0), exponent));
  }
  if (any(common)) {
    result = select(one, base, result);
    result = select(two, base * base, result);
    result = select(zero, all(1.0), result);
    result = select(half, sqrt(base), result);
  }
  return result;
}

}  // namespace lanes

)";

}  // namespace hysteron
