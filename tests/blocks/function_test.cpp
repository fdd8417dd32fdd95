// The functions: identities that tie them together, accuracy against long double, domains and their ends.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "blocks/absolute.hpp"
#include "blocks/arctangent.hpp"
#include "blocks/cosine.hpp"
#include "blocks/exponential.hpp"
#include "blocks/hyperbolic_tangent.hpp"
#include "blocks/logarithm.hpp"
#include "blocks/maximum.hpp"
#include "blocks/minimum.hpp"
#include "blocks/power_function.hpp"
#include "blocks/sign.hpp"
#include "blocks/sine.hpp"
#include "blocks/square_root.hpp"
#include "blocks/tangent.hpp"
#include "tests/blocks/stepper.hpp"

namespace hysteron::testing {
namespace {

template <class B>
double apply(double x) {
  Stepper<B> block(1.0);
  return block({.XIN = x}).XOUT;
}

TEST(Functions, AbsoluteValueIsSignTimesSignal) {
  for (const double x : {-3.5, -0.0, 0.0, 1e-310, 7.0}) {
    EXPECT_EQ(apply<Absolute>(x), apply<Sign>(x) * x);
  }
  EXPECT_EQ(apply<Sign>(-infinity), -1.0);
  EXPECT_EQ(apply<Sign>(0.0), 0.0);
  EXPECT_EQ(apply<Sign>(not_a_number), 0.0);
}

TEST(Functions, TrigonometricIdentities) {
  for (double x = -10.0; x <= 10.0; x += 0.37) {
    const double s = apply<Sine>(x);
    const double c = apply<Cosine>(x);
    EXPECT_NEAR(s * s + c * c, 1.0, 4e-16);
    EXPECT_NEAR(apply<Tangent>(x) * c, s, 4e-16);
    EXPECT_NEAR(apply<Sine>(2.0 * x), 2.0 * s * c, 8e-16);
  }
  for (double x = -1.5; x <= 1.5; x += 0.1) {
    EXPECT_NEAR(apply<Arctangent>(apply<Tangent>(x)), x, 4e-16);
  }
  EXPECT_NEAR(4.0 * apply<Arctangent>(1.0), 3.141592653589793, 5e-16);
}

TEST(Functions, LogarithmUndoesExponential) {
  for (double x = -700.0; x <= 700.0; x += 13.7) {
    EXPECT_NEAR(apply<Logarithm>(apply<Exponential>(x)), x, 1e-13 * std::abs(x) + 1e-15);
  }
  EXPECT_NEAR(apply<Exponential>(1.0), 2.718281828459045, 5e-16);
}

TEST(Functions, LogarithmSaysWhereItIsNotDefined) {
  Stepper<Logarithm> logarithm(1.0);
  for (const double x : {0.0, -1.0, -infinity}) {
    const auto out = logarithm({.XIN = x});
    EXPECT_EQ(out.XOUT, 0.0);
    EXPECT_TRUE(out.ERROR);
    EXPECT_EQ(out.ERRORID, fault::outside_domain);
  }
  EXPECT_FALSE(logarithm({.XIN = std::numeric_limits<double>::denorm_min()}).ERROR);
}

TEST(Functions, SquareRootUndoesTheSquareAndRefusesBelowZero) {
  Stepper<SquareRoot> root(1.0);
  for (double x = 0.0; x < 50.0; x += 0.5) {
    const auto out = root({.XIN = x * x});
    EXPECT_EQ(out.XOUT, x);
    EXPECT_FALSE(out.ERROR);
  }
  const auto below = root({.XIN = -1e-300});
  EXPECT_EQ(below.XOUT, 0.0);
  EXPECT_TRUE(below.ERROR);
  EXPECT_EQ(below.ERRORID, fault::outside_domain);
}

TEST(Functions, MinimumAndMaximumAddUpToTheSum) {
  Stepper<Minimum> smaller(1.0);
  Stepper<Maximum> larger(1.0);
  for (const double a : {-2.0, 0.0, 3.0}) {
    for (const double b : {-5.0, 0.0, 3.0, 8.0}) {
      const double low = smaller({.IN1 = a, .IN2 = b}).XOUT;
      const double high = larger({.IN1 = a, .IN2 = b}).XOUT;
      EXPECT_LE(low, high);
      EXPECT_EQ(low + high, a + b);
    }
  }
  EXPECT_EQ(smaller({.IN1 = 1.0, .IN2 = not_a_number}).XOUT, 1.0);
  EXPECT_EQ(larger({.IN1 = 1.0, .IN2 = not_a_number}).XOUT, 1.0);
}

TEST(HyperbolicTangent, AgreesWithLongDoubleToAFewUlp) {
  for (double x = 1e-300; x < 25.0; x = x * 1.173 + 1e-12) {
    const auto exact = static_cast<double>(std::tanh(static_cast<long double>(x)));
    EXPECT_NEAR(apply<HyperbolicTangent>(x), exact, 4.0 * std::numeric_limits<double>::epsilon() * exact) << x;
    EXPECT_EQ(apply<HyperbolicTangent>(-x), -apply<HyperbolicTangent>(x)) << x;
  }
}

TEST(HyperbolicTangent, IsAccurateWhereTheTwoFormulasMeet) {
  for (double x = 0.5 - 1e-9; x < 0.5 + 1e-9; x += 1e-11) {
    const auto exact = static_cast<double>(std::tanh(static_cast<long double>(x)));
    EXPECT_NEAR(apply<HyperbolicTangent>(x), exact, 4e-16) << x;
  }
}

TEST(HyperbolicTangent, NeitherOverflowsNorLosesNotANumber) {
  EXPECT_EQ(apply<HyperbolicTangent>(1e308), 1.0);
  EXPECT_EQ(apply<HyperbolicTangent>(-infinity), -1.0);
  EXPECT_TRUE(std::isnan(apply<HyperbolicTangent>(not_a_number)));
}

TEST(PowerFunction, PowersAddUp) {
  Stepper<PowerFunction> first(1.0, {.EXPONENT = 1.3});
  Stepper<PowerFunction> second(1.0, {.EXPONENT = 0.7});
  for (double x = 0.01; x < 100.0; x *= 1.7) {
    EXPECT_NEAR(first({.XIN = x}).XOUT * second({.XIN = x}).XOUT, x * x, 1e-14 * x * x);
  }
}

TEST(PowerFunction, NegativeBaseNeedsAWholeExponent) {
  Stepper<PowerFunction> cube(1.0, {.EXPONENT = 3.0});
  EXPECT_EQ(cube({.XIN = -2.0}).XOUT, -8.0);
  EXPECT_FALSE(cube({.XIN = -2.0}).ERROR);
  Stepper<PowerFunction> root(1.0, {.EXPONENT = 1.5});
  const auto out = root({.XIN = -2.0});
  EXPECT_EQ(out.XOUT, 0.0);
  EXPECT_TRUE(out.ERROR);
  EXPECT_EQ(out.ERRORID, fault::outside_domain);
}

TEST(PowerFunction, ZeroNeedsAnExponentThatIsNotNegative) {
  Stepper<PowerFunction> inverse(1.0, {.EXPONENT = -1.0});
  EXPECT_TRUE(inverse({.XIN = 0.0}).ERROR);
  EXPECT_EQ(inverse({.XIN = 4.0}).XOUT, 0.25);
  Stepper<PowerFunction> one(1.0, {.EXPONENT = 0.0});
  EXPECT_EQ(one({.XIN = 0.0}).XOUT, 1.0);
  EXPECT_FALSE(one({.XIN = 0.0}).ERROR);
}

}  // namespace
}  // namespace hysteron::testing
