// The second-order lag, against closed forms for every damping and against a fine Runge-Kutta solution.
#include "blocks/second_order.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/blocks/random_io.hpp"
#include "tests/blocks/stepper.hpp"

namespace hysteron::testing {
namespace {

using SecondOrderParams = SecondOrder::Params<double>;
constexpr double second_order_ts = 1e-3;

TEST(SecondOrder, AStepFromRestIsTheClosedForm) {
  const double t = 8.0 * second_order_ts;
  for (const double zeta : {0.0, 0.1, 0.7, 1.0, 1.5, 20.0}) {
    Stepper<SecondOrder> block(second_order_ts, SecondOrderParams{.K = 3.0, .T = t, .ZETA = zeta, .SETTLED = false});
    for (int k = 0; k < 400; ++k) {
      const double s = k * second_order_ts / t;  // time in units of T
      double rest = 0.0;                         // what is left of the step
      if (zeta < 1.0) {
        const double root = std::sqrt(1.0 - zeta * zeta);
        rest = std::exp(-zeta * s) * (std::cos(root * s) + zeta / root * std::sin(root * s));
      } else if (zeta == 1.0) {
        rest = std::exp(-s) * (1.0 + s);
      } else {
        const double root = std::sqrt(zeta * zeta - 1.0);
        const double slow = 1.0 / (zeta + root);
        const double fast = zeta + root;
        rest = (fast * std::exp(-slow * s) - slow * std::exp(-fast * s)) / (fast - slow);
      }
      const auto out = block({.XIN = 1.0, .R1 = false, .X0 = 0.0});
      ASSERT_NEAR(out.XOUT, 3.0 * (1.0 - rest), 1e-12) << "ZETA " << zeta << ", step " << k;
    }
  }
}

TEST(SecondOrder, IsExactBetweenStraightLines) {
  // Against the differential equation, solved by classical Runge-Kutta with 200 steps a sample.
  RandomIo random(1, second_order_ts);
  for (const double zeta : {0.02, 0.6, 1.0, 3.0}) {
    for (const double t : {0.4 * second_order_ts, 1.0 * second_order_ts, 6.0 * second_order_ts}) {
      Stepper<SecondOrder> block(second_order_ts, SecondOrderParams{.K = 1.0, .T = t, .ZETA = zeta, .SETTLED = false});
      double y = 0.0;
      double v = 0.0;
      double x = 0.0;
      block({.XIN = 0.0, .R1 = false, .X0 = 0.0});
      for (int k = 0; k < 100; ++k) {
        const double next = random.unit() - 0.5;
        const int parts = 200;
        const double h = second_order_ts / parts;
        const auto acceleration = [&](double time, double position, double velocity) {
          return (x + (next - x) * time / second_order_ts - position - 2.0 * zeta * t * velocity) / (t * t);
        };
        for (int i = 0; i < parts; ++i) {
          const double time = i * h;
          const double a1 = acceleration(time, y, v);
          const double a2 = acceleration(time + h / 2, y + h / 2 * v, v + h / 2 * a1);
          const double a3 = acceleration(time + h / 2, y + h / 2 * (v + h / 2 * a1), v + h / 2 * a2);
          const double a4 = acceleration(time + h, y + h * (v + h / 2 * a2), v + h * a3);
          y += h * v + h * h / 6 * (a1 + a2 + a3);
          v += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
        }
        x = next;
        const auto out = block({.XIN = x, .R1 = false, .X0 = 0.0});
        ASSERT_NEAR(out.XOUT, y, 1e-6) << "ZETA " << zeta << ", T " << t << ", step " << k;
        ASSERT_NEAR(out.RATE * second_order_ts, v * second_order_ts, 1e-5);
      }
    }
  }
}

TEST(SecondOrder, IsContinuousThroughCriticalDamping) {
  const double t = 5.0 * second_order_ts;
  std::vector<Stepper<SecondOrder>> blocks;
  for (const double zeta : {0.98, 0.9999, 1.0, 1.0001, 1.02}) {
    blocks.emplace_back(second_order_ts, SecondOrderParams{.K = 1.0, .T = t, .ZETA = zeta, .SETTLED = false});
  }
  for (int k = 0; k < 100; ++k) {
    std::vector<double> y;
    y.reserve(blocks.size());
    for (auto& block : blocks) {
      y.push_back(block({.XIN = 1.0, .R1 = false, .X0 = 0.0}).XOUT);
    }
    EXPECT_NEAR(y[1], y[2], 1e-4);
    EXPECT_NEAR(y[3], y[2], 1e-4);
    EXPECT_NEAR(y[0] - y[2], y[2] - y[4], 1e-3) << "the slope with respect to ZETA does not jump";
    EXPECT_NEAR((y[2] - y[4]) / 0.02, (y[2] - y[3]) / 0.0001, 0.02);
  }
}

TEST(SecondOrder, ResonatesAtItsFrequency) {
  // |H| at ω = 1/T is K/(2·ZETA), a quarter of a period behind.
  const double t = 50.0 * second_order_ts;
  const double zeta = 0.05;
  Stepper<SecondOrder> block(second_order_ts, SecondOrderParams{.K = 2.0, .T = t, .ZETA = zeta, .SETTLED = true});
  double largest = 0.0;
  for (int k = 0; k < 20000; ++k) {
    const double y = block({.XIN = std::sin(k * second_order_ts / t), .R1 = false, .X0 = 0.0}).XOUT;
    if (k > 10000) {
      largest = std::max(largest, y);
      EXPECT_NEAR(y, -2.0 / (2.0 * zeta) * std::cos(k * second_order_ts / t), 0.02);
    }
  }
  EXPECT_NEAR(largest, 20.0, 0.02);
}

TEST(SecondOrder, AboveHalfTheSampleRateOnlyTheLagIsLeft) {
  const double t = 0.1 * second_order_ts;
  const double zeta = 0.3;
  Stepper<SecondOrder> block(second_order_ts, SecondOrderParams{.K = 1.0, .T = t, .ZETA = zeta, .SETTLED = true});
  double last = 1.0;
  for (int k = 0; k < 50; ++k) {
    const double x = std::cos(0.3 * k);
    EXPECT_NEAR(block({.XIN = x, .R1 = false, .X0 = 0.0}).XOUT, x - 2.0 * zeta * t * (x - last) / second_order_ts,
                1e-15);
    last = x;
  }
}

TEST(SecondOrder, StartsSettledAndAResetLoadsX0AtRest) {
  const double t = 4.0 * second_order_ts;
  Stepper<SecondOrder> block(second_order_ts, SecondOrderParams{.K = 2.0, .T = t, .ZETA = 1.0, .SETTLED = true});
  EXPECT_EQ(block({.XIN = 5.0, .R1 = false, .X0 = 0.0}).XOUT, 10.0);
  EXPECT_EQ(block({.XIN = 5.0, .R1 = false, .X0 = 0.0}).XOUT, 10.0);
  const auto reset = block({.XIN = 5.0, .R1 = true, .X0 = 4.0});
  EXPECT_EQ(reset.XOUT, 4.0);
  EXPECT_EQ(reset.RATE, 0.0);
  EXPECT_NEAR(block({.XIN = 5.0, .R1 = false, .X0 = 0.0}).XOUT, 10.0 - 6.0 * std::exp(-0.25) * 1.25, 1e-13);
}

TEST(SecondOrder, AnUndampedOscillationKeepsItsEnergy) {
  const double t = 3.0 * second_order_ts;
  Stepper<SecondOrder> block(second_order_ts, SecondOrderParams{.K = 1.0, .T = t, .ZETA = 0.0, .SETTLED = false});
  for (int k = 0; k < 1'000'000; ++k) {
    const auto out = block({.XIN = 0.0, .R1 = false, .X0 = 1.0});
    ASSERT_NEAR(out.XOUT * out.XOUT + t * t * out.RATE * out.RATE, 1.0, 1e-9) << "step " << k;
  }
}

TEST(SecondOrder, DecaysToZeroWithoutDenormalNumbers) {
  Stepper<SecondOrder, float> block(1e-3F, {.K = 1.0F, .T = 4e-3F, .ZETA = 0.3F, .SETTLED = false});
  for (int k = 0; k < 5000; ++k) {
    const auto out = block({.XIN = 0.0F, .R1 = false, .X0 = 1.0F});
    EXPECT_NE(std::fpclassify(out.XOUT), FP_SUBNORMAL);
    EXPECT_NE(std::fpclassify(out.RATE), FP_SUBNORMAL);
    if (k > 2500) {
      EXPECT_EQ(out.XOUT, 0.0F);
    }
  }
}

}  // namespace
}  // namespace hysteron::testing
