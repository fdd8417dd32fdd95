// The arithmetic blocks: order of rounding, and errors where nothing is defined.
#include <gtest/gtest.h>

#include <cmath>

#include "blocks/constant.hpp"
#include "blocks/gain.hpp"
#include "blocks/product.hpp"
#include "blocks/quotient.hpp"
#include "blocks/subtract.hpp"
#include "blocks/sum.hpp"
#include "tests/blocks/stepper.hpp"

namespace hysteron::testing {
namespace {

TEST(Sum, AddsFromTheFirstToTheLast) {
  Stepper<Sum> sum(1.0);
  // (1e16 + 1) − 1e16 + 1: from left to right the first 1 is lost, in another order it would not be.
  EXPECT_EQ(sum({.IN1 = 1e16, .IN2 = 1.0, .IN3 = -1e16, .IN4 = 1.0}).XOUT, 1.0);
}

TEST(Sum, OperandsThatAreNotConnectedChangeNothing) {
  Stepper<Sum> sum(1.0);
  auto in = presets<Sum::In<double>>();
  in.IN1 = 0.1;
  in.IN2 = 0.2;
  EXPECT_EQ(sum(in).XOUT, 0.1 + 0.2);
}

TEST(Subtract, TakesTheSecondFromTheFirst) {
  Stepper<Subtract> subtract(1.0);
  EXPECT_EQ(subtract({.IN1 = 2.0, .IN2 = 5.0}).XOUT, -3.0);
}

TEST(Product, MultipliesAndKeepsSigns) {
  Stepper<Product> product(1.0);
  EXPECT_EQ(product({.IN1 = -3.0, .IN2 = 0.5}).XOUT, -1.5);
  EXPECT_TRUE(std::isnan(product({.IN1 = 0.0, .IN2 = infinity}).XOUT));
}

TEST(Quotient, IsTheInverseOfTheProduct) {
  Stepper<Quotient> quotient(1.0);
  for (const double divisor : {-8.0, 0.125, 1e-300}) {
    const auto out = quotient({.IN1 = 3.0 * divisor, .IN2 = divisor});
    EXPECT_NEAR(out.XOUT, 3.0, 1e-15);
    EXPECT_FALSE(out.ERROR);
    EXPECT_EQ(out.ERRORID, 0);
  }
}

TEST(Quotient, SaysThatTheDivisorIsZero) {
  Stepper<Quotient> quotient(1.0);
  for (const double zero : {0.0, -0.0}) {
    for (const double dividend : {1.0, 0.0, -infinity}) {
      const auto out = quotient({.IN1 = dividend, .IN2 = zero});
      EXPECT_EQ(out.XOUT, 0.0);
      EXPECT_TRUE(out.ERROR);
      EXPECT_EQ(out.ERRORID, fault::zero_divisor);
    }
  }
}

TEST(Gain, ScalesAndPassesUnchangedAtOne) {
  Stepper<Gain> gain(1.0, {.K = -2.5});
  EXPECT_EQ(gain({.XIN = 2.0}).XOUT, -5.0);
  gain.params.K = 1.0;
  EXPECT_TRUE(same_bits(gain({.XIN = -0.0}).XOUT, -0.0));
}

TEST(Constant, IsItsParameter) {
  Stepper<Constant> constant(1.0, {.K = 9.81});
  EXPECT_EQ(constant({}).XOUT, 9.81);
}

}  // namespace
}  // namespace hysteron::testing
