// The momentum, and the feedforward loop that closes through it.
#include "blocks/momentum.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "blocks/branch.hpp"
#include "blocks/derivative.hpp"
#include "blocks/hysteresis_ro_inverse.hpp"
#include "blocks/integral.hpp"
#include "blocks/m_inverse.hpp"
#include "tests/blocks/stepper.hpp"

namespace hysteron::testing {
namespace {

TEST(Momentum, IsTheTravelAtTheStartOfTheInterval) {
  Stepper<Momentum> block(0.5, {.G = 0});
  EXPECT_EQ(block({.XIN = -4.0, .R1 = false, .P0 = 0.0}).XOUT, 0.0) << "the present input does not count yet";
  EXPECT_EQ(block({.XIN = 2.0, .R1 = false, .P0 = 0.0}).XOUT, 2.0);
  EXPECT_EQ(block({.XIN = 0.0, .R1 = false, .P0 = 0.0}).XOUT, 3.0);
}

TEST(Momentum, SignedMomentumIsTheIntegral) {
  Stepper<Momentum> block(0.5, {.G = 1});
  block({.XIN = -4.0, .R1 = false, .P0 = 0.0});
  EXPECT_EQ(block({.XIN = 2.0, .R1 = false, .P0 = 0.0}).XOUT, -2.0);
  EXPECT_EQ(block({.XIN = 0.0, .R1 = false, .P0 = 0.0}).XOUT, -1.0);
}

TEST(Momentum, TheIntervalOfAResetCounts) {
  Stepper<Momentum> block(1.0, {.G = 0});
  block({.XIN = 7.0, .R1 = false, .P0 = 0.0});
  EXPECT_EQ(block({.XIN = 2.0, .R1 = true, .P0 = 0.25}).XOUT, 7.0) << "the state alone: no feedthrough from R1";
  EXPECT_EQ(block({.XIN = 0.0, .R1 = false, .P0 = 0.25}).XOUT, 2.25);
}

TEST(Momentum, FloatLosesNothingOverTwoMillionSteps) {
  Stepper<Momentum, float> block(50e-6F, {.G = 0});
  float momentum = 0.0F;
  for (int k = 0; k < 2'000'000; ++k) {
    momentum = block({.XIN = -1.0F, .R1 = false, .P0 = 0.0F}).XOUT;
  }
  EXPECT_NEAR(momentum, 100.0F, 1e-4F) << "a plain sum gives 101.97";
}

/// The feedforward as the paper writes it, equations (15) and (16): its largest error against the closed form, as a
/// share of the range, for two periods of a sine that starts at its lower turn.
double feedforward_error(double ts) {
  const double c1 = 2.45e-9;
  const double c2 = 1.6e-11;
  const double half_range = 250.0;
  const double y_turn = c1 * half_range + c2 * half_range * half_range;  // Y(2·250)/2
  Stepper<Derivative> rate(ts);
  Stepper<Branch> branch(ts);
  Stepper<Momentum> momentum(ts, {.G = 0});
  Stepper<SlopeMInverse> inverse(ts, {.C1 = c1, .C2 = c2, .C3 = 1.0});
  Stepper<Integral> sum(ts);
  Stepper<HysteresisRoInverse> closed_form(
      ts, {.C1 = c1, .C2 = c2, .C3 = 1.0, .EPS = 0.0, .START = 1, .U0 = -half_range, .Y0 = -y_turn});

  double worst = 0.0;
  const auto steps = static_cast<int>(std::lround(2.0 / ts));
  for (int k = 0; k <= steps; ++k) {
    const double y = -y_turn * std::cos(2.0 * std::numbers::pi * k * ts);
    const bool reversal = branch({.XIN = y, .R1 = false}).Q;
    const double p = Momentum::output(momentum.params, momentum.state, {}, ts).XOUT;
    const double u_rate = inverse({.XIN = rate({.XIN = y, .RUN = true}).XOUT, .P = p, .R1 = reversal}).XOUT;
    momentum({.XIN = u_rate, .R1 = reversal, .P0 = 0.0});
    const double u = sum({.XIN = u_rate, .RUN = true, .R1 = k == 0, .X0 = -half_range}).XOUT;
    worst = std::max(worst, std::fabs(u - closed_form({.XIN = y, .R1 = false}).XOUT));
  }
  return worst / (2.0 * half_range);
}

TEST(Momentum, ClosesTheFeedforwardLoopAtFirstOrder) {
  const double coarse = feedforward_error(2e-3);
  const double fine = feedforward_error(1e-3);
  EXPECT_LT(fine, 1e-2);
  EXPECT_NEAR(coarse / fine, 2.0, 0.1) << "forward Euler: half the step, half the error";
}

}  // namespace
}  // namespace hysteron::testing
