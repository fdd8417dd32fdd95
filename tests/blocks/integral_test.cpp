// The two integrals: rules, resets, compensation, and the loop that the forward one closes.
#include "blocks/integral.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>

#include "blocks/integral_bounded.hpp"
#include "blocks/integral_forward.hpp"
#include "blocks/integral_forward_bounded.hpp"
#include "tests/blocks/stepper.hpp"

namespace hysteron::testing {
namespace {

TEST(Integral, CountsThePresentInputForwardDoesNot) {
  Stepper<Integral> backward(0.5);
  Stepper<IntegralForward> forward(0.5);
  double before = 0.0;
  for (const double x : {3.0, -1.0, 4.0, 1.5}) {
    EXPECT_EQ(forward({.XIN = x, .RUN = true, .R1 = false, .X0 = 0.0}).XOUT, before);
    before = backward({.XIN = x, .RUN = true, .R1 = false, .X0 = 0.0}).XOUT;
  }
  EXPECT_EQ(before, 0.5 * 7.5);
}

TEST(IntegralBounded, IsTheSumHeldInEachStepAndLeavesABoundAtOnce) {
  Stepper<IntegralBounded> backward(0.5, {.MN = -1.0, .MX = 2.0});
  Stepper<IntegralForwardBounded> forward(0.5, {.MN = -1.0, .MX = 2.0});
  double sum = 0.0;
  double before = 0.0;
  int high = 0;
  int low = 0;
  for (int k = 0; k < 400; ++k) {
    const double x = 3.0 * std::sin(0.05 * k) + std::sin(0.31 * k);
    const auto there = forward({.XIN = x, .RUN = true, .R1 = false, .X0 = 0.0});
    EXPECT_NEAR(there.XOUT, before, 1e-15);
    const double free = sum + 0.5 * x;
    sum = std::clamp(free, -1.0, 2.0);
    const auto out = backward({.XIN = x, .RUN = true, .R1 = false, .X0 = 0.0});
    EXPECT_NEAR(out.XOUT, sum, 1e-15);
    EXPECT_EQ(out.QHIGH, free > 2.0);
    EXPECT_EQ(out.QLOW, free < -1.0);
    high += out.QHIGH ? 1 : 0;
    low += out.QLOW ? 1 : 0;
    before = sum;
  }
  EXPECT_GT(high, 20);
  EXPECT_GT(low, 20);
}

TEST(IntegralBounded, AResetBeyondABoundIsHeldToo) {
  Stepper<IntegralBounded> backward(1.0, {.MN = 1.0, .MX = 4.0});
  Stepper<IntegralForwardBounded> forward(1.0, {.MN = 1.0, .MX = 4.0});
  EXPECT_EQ(forward({.XIN = 0.0, .RUN = true, .R1 = false, .X0 = 0.0}).XOUT, 1.0) << "it starts at 0, below MN";
  EXPECT_EQ(backward({.XIN = 0.0, .RUN = true, .R1 = true, .X0 = 9.0}).XOUT, 4.0);
  EXPECT_EQ(forward({.XIN = -2.0, .RUN = true, .R1 = true, .X0 = 9.0}).XOUT, 4.0);
  EXPECT_EQ(backward({.XIN = -1.0, .RUN = true, .R1 = false, .X0 = 0.0}).XOUT, 3.0);
  EXPECT_EQ(forward({.XIN = 0.0, .RUN = true, .R1 = false, .X0 = 0.0}).XOUT, 2.0);
}

template <class B>
std::complex<double> response(double w) {
  // X0 = Σ of the steady response at k = 0 removes the constant of integration: compare differences instead.
  Stepper<B> real(1.0);
  Stepper<B> imaginary(1.0);
  std::complex<double> last;
  std::complex<double> previous;
  const int count = 40;
  for (int k = 0; k <= count; ++k) {
    previous = last;
    last = {real({.XIN = std::cos(w * k), .RUN = true, .R1 = false, .X0 = 0.0}).XOUT,
            imaginary({.XIN = std::sin(w * k), .RUN = true, .R1 = false, .X0 = 0.0}).XOUT};
  }
  // y(k) = c + H·e^(jwk)  →  H = (y(k) − y(k−1))/(e^(jwk)·(1 − e^(−jw)))
  return (last - previous) / (std::polar(1.0, w * count) * (1.0 - std::polar(1.0, -w)));
}

TEST(Integral, DelayAndGainAreAsStated) {
  for (const double w : {0.01, 0.3, 1.0, 2.0}) {
    const std::complex<double> ideal(0.0, -1.0 / w);
    const auto backward = response<Integral>(w) / ideal;
    const auto forward = response<IntegralForward>(w) / ideal;
    EXPECT_NEAR(std::abs(backward), (w / 2) / std::sin(w / 2), 1e-10);
    EXPECT_NEAR(std::abs(forward), (w / 2) / std::sin(w / 2), 1e-10);
    EXPECT_NEAR(std::arg(backward) / w, 0.5, 1e-9) << "ahead by half a sample";
    EXPECT_NEAR(std::arg(forward) / w, -0.5, 1e-9) << "behind by half a sample";
  }
}

TEST(Integral, FloatLosesNothingOverTwoMillionSteps) {
  Stepper<Integral, float> backward(50e-6F);
  Stepper<IntegralForward, float> forward(50e-6F);
  float b = 0.0F;
  float f = 0.0F;
  for (int k = 0; k < 2'000'000; ++k) {
    b = backward({.XIN = 1.0F, .RUN = true, .R1 = false, .X0 = 0.0F}).XOUT;
    f = forward({.XIN = 1.0F, .RUN = true, .R1 = false, .X0 = 0.0F}).XOUT;
  }
  EXPECT_NEAR(b, 100.0F, 1e-4F) << "a plain sum gives 101.97";
  EXPECT_NEAR(f, 100.0F, 1e-4F);
}

TEST(Integral, RunHoldsAndResetDominates) {
  Stepper<Integral> block(1.0);
  block({.XIN = 5.0, .RUN = true, .R1 = false, .X0 = 0.0});
  EXPECT_EQ(block({.XIN = 5.0, .RUN = false, .R1 = false, .X0 = 0.0}).XOUT, 5.0);
  const auto out = block({.XIN = 5.0, .RUN = false, .R1 = true, .X0 = -2.0});
  EXPECT_EQ(out.XOUT, -2.0);
  EXPECT_FALSE(out.Q);
  EXPECT_EQ(block({.XIN = 1.0, .RUN = true, .R1 = false, .X0 = 0.0}).XOUT, -1.0);
}

TEST(IntegralForward, RunHoldsAndTheIntervalOfAResetCounts) {
  Stepper<IntegralForward> block(1.0);
  block({.XIN = 5.0, .RUN = true, .R1 = false, .X0 = 0.0});
  EXPECT_EQ(block({.XIN = 9.0, .RUN = false, .R1 = false, .X0 = 0.0}).XOUT, 5.0);
  EXPECT_EQ(block({.XIN = 3.0, .RUN = true, .R1 = true, .X0 = -2.0}).XOUT, -2.0);
  EXPECT_EQ(block({.XIN = 0.0, .RUN = true, .R1 = false, .X0 = 0.0}).XOUT, 1.0);
}

TEST(IntegralForward, ClosesTheLoopOfAPlant) {
  // x' = −x/T by forward Euler: x(k) = (1 − TS/T)^k.
  const double ts = 0.01;
  const double time_constant = 0.2;
  Stepper<IntegralForward> plant(ts);
  for (int k = 0; k < 300; ++k) {
    IntegralForward::In<double> in{.XIN = 0.0, .RUN = true, .R1 = k == 0, .X0 = 1.0};
    const double x = IntegralForward::output({}, plant.state, in, ts).XOUT;
    EXPECT_NEAR(x, std::pow(1.0 - ts / time_constant, k), 1e-14);
    in.XIN = -x / time_constant;
    EXPECT_EQ(plant(in).XOUT, x) << "no feedthrough";
  }
}

}  // namespace
}  // namespace hysteron::testing
