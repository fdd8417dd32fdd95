// Dual numbers: bits of the value, derivatives against central differences and against ceres::Jet, and the stated
// conventions where a function has no derivative.
#include "tuning/dual.hpp"

#include <ceres/jet.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <string>

#include "blocks/integral.hpp"

namespace ceres {
template <class T, int N>
Jet<T, N> power(const Jet<T, N>& base, const Jet<T, N>& exponent) {
  return pow(base, exponent);
}
}  // namespace ceres

namespace hysteron {
namespace {

std::uint64_t bits(double x) {
  return std::bit_cast<std::uint64_t>(x);
}

/// One function of two variables, over all scalars, on random points of a rectangle.
template <class F>
void compare_everywhere(const std::string& name, double low, double high, F f) {
  SCOPED_TRACE(name);
  using Jet = ceres::Jet<double, 2>;
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> uniform(low, high);
  for (int i = 0; i < 2000; ++i) {
    const double x = uniform(random);
    const double y = uniform(random);
    const double plain = f(x, y);
    const Dual<2> dual = f(Dual<2>::variable(x, 0), Dual<2>::variable(y, 1));
    ASSERT_EQ(bits(dual.value()), bits(plain)) << "at " << x << ", " << y;

    const Jet jet = f(Jet(x, 0), Jet(y, 1));
    for (int k = 0; k < 2; ++k) {
      const double scale = 1.0 + std::fabs(jet.v[k]);
      ASSERT_NEAR(dual.derivative(k), jet.v[k], 1e-13 * scale) << "jet, at " << x << ", " << y;
      const double step = 1e-6;
      const double difference =
          k == 0 ? (f(x + step, y) - f(x - step, y)) / (2 * step) : (f(x, y + step) - f(x, y - step)) / (2 * step);
      ASSERT_NEAR(dual.derivative(k), difference, 3e-8 * scale) << "difference, at " << x << ", " << y;
    }
  }
}

TEST(Dual, EveryFunctionHasTheBitsOfDoubleAndTheDerivativesOfJetAndOfDifferences) {
  compare_everywhere("+", -3.0, 3.0, [](auto x, auto y) { return x + y; });
  compare_everywhere("-", -3.0, 3.0, [](auto x, auto y) { return x - y; });
  compare_everywhere("*", -3.0, 3.0, [](auto x, auto y) { return x * y; });
  compare_everywhere("/", 0.5, 3.0, [](auto x, auto y) { return x / y; });
  compare_everywhere("unary -", -3.0, 3.0, [](auto x, auto y) { return -x * y; });
  compare_everywhere("abs", 0.1, 3.0, [](auto x, auto y) { return abs(x) + abs(-y * x); });
  compare_everywhere("sqrt", 0.1, 3.0, [](auto x, auto y) { return sqrt(x * y); });
  compare_everywhere("exp", -2.0, 2.0, [](auto x, auto y) { return exp(x * y); });
  compare_everywhere("log", 0.1, 3.0, [](auto x, auto y) { return log(x * y); });
  compare_everywhere("sin", -3.0, 3.0, [](auto x, auto y) { return sin(x * y); });
  compare_everywhere("cos", -3.0, 3.0, [](auto x, auto y) { return cos(x * y); });
  compare_everywhere("tan", -1.1, 1.1, [](auto x, auto y) { return tan(x * y); });
  compare_everywhere("asin", -0.9, 0.9, [](auto x, auto y) { return asin(x * y); });
  compare_everywhere("acos", -0.9, 0.9, [](auto x, auto y) { return acos(x * y); });
  compare_everywhere("atan", -3.0, 3.0, [](auto x, auto y) { return atan(x * y); });
  compare_everywhere("power", 0.1, 3.0, [](auto x, auto y) { return power(x, y); });
  compare_everywhere("a mixture", 0.2, 2.0, [](auto x, auto y) {
    const auto shared = power(x, y) / (y + sqrt(x));
    return exp(-shared) * sin(shared * x) + atan(shared / y);
  });
}

template <int N>
void closed_form_of_a_branch() {
  // y = C1·p + C2·p^(C3+1)/(C3+1), and its derivatives by hand
  const double c1 = 0.05;
  const double c2 = 1.3;
  const double c3 = 1.7;
  const double p = 0.6;
  using D = Dual<N>;
  const auto parameter = [](double value, int index) { return index < N ? D::variable(value, index) : D(value); };
  const D C1 = parameter(c1, 0);
  const D C2 = parameter(c2, 1);
  const D C3 = parameter(c3, 2);
  const D y = C1 * D(p) + C2 * power(D(p), C3 + D(1.0)) / (C3 + D(1.0));
  EXPECT_EQ(bits(y.value()), bits(c1 * p + c2 * std::pow(p, c3 + 1.0) / (c3 + 1.0)));
  const double q = std::pow(p, c3 + 1.0) / (c3 + 1.0);
  const std::array<double, 3> exact{p, q, c2 * q * (std::log(p) - 1.0 / (c3 + 1.0))};
  for (int i = 0; i < N; ++i) {
    EXPECT_NEAR(y.derivative(i), i < 3 ? exact[static_cast<std::size_t>(i)] : 0.0, 1e-15);
  }
}

TEST(Dual, ClosedFormOfABranchForEveryUsualNumberOfParameters) {
  closed_form_of_a_branch<1>();
  closed_form_of_a_branch<3>();
  closed_form_of_a_branch<4>();
  closed_form_of_a_branch<8>();
}

TEST(Dual, PowerDiffersFromItsShortcutOnlyInValue) {
  // ∂(b^e)/∂e = b^e·log b, also where the value is a shortcut
  for (const double exponent : {0.0, 0.5, 1.0, 2.0}) {
    for (const double base : {0.3, 1.0, 2.5}) {
      const auto result = power(Dual<2>::variable(base, 0), Dual<2>::variable(exponent, 1));
      EXPECT_EQ(bits(result.value()), bits(power(base, exponent)));
      EXPECT_NEAR(result.derivative(0), exponent * std::pow(base, exponent - 1.0), 1e-15);
      EXPECT_NEAR(result.derivative(1), std::pow(base, exponent) * std::log(base), 1e-15);
    }
  }
}

TEST(Dual, PowerAtBaseZeroIsFinite) {
  for (const double exponent : {0.0, 0.3, 0.5, 1.0, 1.7, 2.0, 3.0}) {
    const auto result = power(Dual<2>::variable(0.0, 0), Dual<2>::variable(exponent, 1));
    EXPECT_EQ(bits(result.value()), bits(power(0.0, exponent)));
    EXPECT_EQ(result.derivative(0), exponent == 1.0 ? 1.0 : 0.0) << exponent;
    EXPECT_EQ(result.derivative(1), 0.0) << exponent;
  }
  // continuous from the right where the derivative exists: 1e-300^(C3−1) is 0 for C3 well above 1
  const auto near = power(Dual<2>::variable(1e-300, 0), Dual<2>::variable(1.7, 1));
  EXPECT_NEAR(near.derivative(0), 0.0, 1e-200);
  EXPECT_NEAR(near.derivative(1), 0.0, 1e-200);
}

TEST(Dual, PowerOfANegativeBaseKeepsTheDerivativeOfTheBase) {
  const auto square = power(Dual<2>::variable(-3.0, 0), Dual<2>(2.0));
  EXPECT_EQ(square.value(), 9.0);
  EXPECT_EQ(square.derivative(0), -6.0);
  const auto cube = power(Dual<2>::variable(-2.0, 0), Dual<2>::variable(3.0, 1));
  EXPECT_EQ(cube.value(), -8.0);
  EXPECT_NEAR(cube.derivative(0), 12.0, 1e-14);
  EXPECT_EQ(cube.derivative(1), 0.0);
  EXPECT_TRUE(std::isnan(power(Dual<2>(-2.0), Dual<2>(0.3)).value()));
}

TEST(Dual, NoInfiniteSlopeBecomesNotANumber) {
  const auto zero = Dual<2>::variable(0.0, 0);
  EXPECT_EQ(sqrt(zero).value(), 0.0);
  EXPECT_EQ(sqrt(zero).derivative(0), 0.0);
  EXPECT_EQ(sqrt(zero).derivative(1), 0.0);
  for (const double end : {-1.0, 1.0}) {
    EXPECT_EQ(asin(Dual<2>::variable(end, 0)).derivative(0), 0.0);
    EXPECT_EQ(acos(Dual<2>::variable(end, 0)).derivative(0), 0.0);
    EXPECT_EQ(bits(asin(Dual<2>(end)).value()), bits(std::asin(end)));
  }
  EXPECT_EQ(abs(zero).derivative(0), 0.0);
  EXPECT_EQ(abs(Dual<2>::variable(-2.0, 0)).derivative(0), -1.0);
}

TEST(Dual, MinMaxAndSelectTakeTheDerivativeOfTheSideWhoseValueTheyReturn) {
  const auto a = Dual<2>::variable(1.0, 0);
  const auto b = Dual<2>::variable(1.0, 1);
  const auto c = Dual<2>::variable(2.0, 1);
  const Dual<2> nothing(std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(min(a, b).derivative(0), 1.0);
  EXPECT_EQ(max(a, b).derivative(0), 1.0);
  EXPECT_EQ(min(c, a).derivative(0), 1.0);
  EXPECT_EQ(max(a, c).derivative(1), 1.0);
  EXPECT_EQ(max(a, c).derivative(0), 0.0);
  EXPECT_EQ(min(a, nothing).derivative(0), 1.0);
  EXPECT_EQ(max(a, nothing).value(), 1.0);
  EXPECT_EQ(select(a < c, a, nothing).derivative(0), 1.0);
  EXPECT_EQ(select(a > c, nothing, c).derivative(1), 1.0);
}

TEST(Dual, ATermIsLeftOutOnlyWhereItsFactorStaysZero) {
  int worked_out = 0;
  const auto term_of = [&](const Dual<2>& factor) {
    return unless_zero(factor, Dual<2>(0.0), [&] {
      ++worked_out;
      return factor * Dual<2>(3.0);
    });
  };
  EXPECT_EQ(term_of(Dual<2>(0.0)).value(), 0.0);
  EXPECT_EQ(worked_out, 0);
  EXPECT_EQ(term_of(Dual<2>::variable(0.0, 1)).derivative(1), 3.0);
  EXPECT_EQ(term_of(Dual<2>(2.0)).value(), 6.0);
  EXPECT_EQ(worked_out, 2);
}

TEST(Dual, ComparesAndConvertsByValue) {
  const auto a = Dual<1>::variable(2.75, 0);
  EXPECT_TRUE(a == Dual<1>(2.75));
  EXPECT_FALSE(a != Dual<1>(2.75));
  EXPECT_TRUE(a >= Dual<1>(2.75) && a <= Dual<1>(2.75) && !(a < Dual<1>(2.75)) && !(a > Dual<1>(2.75)));
  EXPECT_EQ(to_int(a), 2);
  EXPECT_EQ(to_int(-a), -2);
  EXPECT_EQ(to_int(Dual<1>(1e20)), std::numeric_limits<std::int32_t>::max());
  EXPECT_EQ(value_of(a), 2.75);
  const auto seven = to_real<Dual<1>>(std::int32_t{7});
  EXPECT_EQ(seven.value(), 7.0);
  EXPECT_EQ(seven.derivative(0), 0.0);
  Array<Dual<1>, 3> table{};
  store(table, std::int32_t{9}, a);
  EXPECT_EQ(at(table, std::int32_t{2}).derivative(0), 1.0);
  static_assert(std::is_same_v<Bool<Dual<1>>, bool> && std::is_same_v<Int<Dual<1>>, std::int32_t>);
  static_assert(std::is_same_v<Word<Dual<1>>, std::uint16_t>);
  static_assert(!std::is_convertible_v<double, Dual<1>>, "a stray literal must not compile");
}

TEST(Dual, ARolloutHasTheBitsOfThePlainOne) {
  // A feedforward step in the paper's form with resets, 5000 steps, and the compensated integral behind it.
  const auto rollout = [](auto C1, auto C2, auto C3) {
    using S = decltype(C1);
    Integral::State<S> integral = Integral::initial<S>({});
    S momentum(0.0);
    S before(0.0);
    S last(0.0);
    for (int k = 0; k < 5000; ++k) {
      const S rate(std::cos(0.01 * k) + 0.3 * std::cos(0.073 * k));
      const bool reversed = rate * before < S(0.0);
      momentum = select(reversed, S(0.0), momentum);
      const S u = rate / (C1 + C2 * power(momentum, C3));
      momentum = momentum + abs(u) * S(1e-3);
      before = rate;
      const typename Integral::In<S> in{u, true, false, S(0.0)};
      last = Integral::output<S>({}, integral, in, S(1e-3)).XOUT;
      Integral::update<S>({}, integral, in, {}, S(1e-3));
    }
    return last;
  };
  const auto dual = rollout(Dual<3>::variable(0.6, 0), Dual<3>::variable(0.4, 1), Dual<3>::variable(0.8, 2));
  EXPECT_EQ(bits(dual.value()), bits(rollout(0.6, 0.4, 0.8)));
  const double h = 1e-6;
  EXPECT_NEAR(dual.derivative(0), (rollout(0.6 + h, 0.4, 0.8) - rollout(0.6 - h, 0.4, 0.8)) / (2 * h), 1e-7);
  EXPECT_NEAR(dual.derivative(1), (rollout(0.6, 0.4 + h, 0.8) - rollout(0.6, 0.4 - h, 0.8)) / (2 * h), 1e-7);
  EXPECT_NEAR(dual.derivative(2), (rollout(0.6, 0.4, 0.8 + h) - rollout(0.6, 0.4, 0.8 - h)) / (2 * h), 1e-7);
}

}  // namespace
}  // namespace hysteron
