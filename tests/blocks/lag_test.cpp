// The first-order lag and the lead-lag, against closed forms.
#include "blocks/lag.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>

#include "blocks/lead_lag.hpp"
#include "tests/blocks/random_io.hpp"
#include "tests/blocks/stepper.hpp"

namespace hysteron::testing {
namespace {

constexpr double lag_ts = 1e-3;

TEST(Lag, FollowsAPolygonExactly) {
  // A ramp of slope 1 for 40 samples, then a plateau: y = t − T(1 − e^(−t/T)), then an exponential.
  for (const double t1 :
       {0.001 * lag_ts, 0.02 * lag_ts, 0.3 * lag_ts, lag_ts, 7.0 * lag_ts, 33.0 * lag_ts, 1000.0 * lag_ts}) {
    Stepper<Lag> block(lag_ts, {.T1 = t1, .SETTLED = true});
    const double corner = 40 * lag_ts;
    const double at_corner = corner - t1 * (1.0 - std::exp(-corner / t1));
    for (int k = 0; k < 300; ++k) {
      const double t = k * lag_ts;
      const double expected = t <= corner ? t - t1 * (1.0 - std::exp(-t / t1))
                                          : corner - (corner - at_corner) * std::exp(-(t - corner) / t1);
      EXPECT_NEAR(block({.XIN = std::min(t, corner), .R1 = false, .X0 = 0.0}).XOUT, expected, 1e-15) << "T1 " << t1;
    }
  }
}

TEST(Lag, AStepFromX0IsTheExponential) {
  const double t1 = 12.3 * lag_ts;
  Stepper<Lag> block(lag_ts, {.T1 = t1, .SETTLED = false});
  for (int k = 0; k < 200; ++k) {
    const auto out = block({.XIN = 1.0, .R1 = false, .X0 = -2.0});
    EXPECT_NEAR(out.XOUT, 1.0 - 3.0 * std::exp(-k * lag_ts / t1), 1e-14);
    EXPECT_NEAR(out.RATE, (1.0 - out.XOUT) / t1, 1e-11);
  }
}

TEST(Lag, StartsSettled) {
  Stepper<Lag> block(lag_ts, {.T1 = 1.0, .SETTLED = true});
  for (int k = 0; k < 10; ++k) {
    EXPECT_EQ(block({.XIN = 37.0, .R1 = false, .X0 = 0.0}).XOUT, 37.0);
  }
}

TEST(Lag, AResetLoadsX0AndGoesOnFromThere) {
  const double t1 = 5.0 * lag_ts;
  Stepper<Lag> block(lag_ts, {.T1 = t1, .SETTLED = true});
  block({.XIN = 3.0, .R1 = false, .X0 = 0.0});
  EXPECT_EQ(block({.XIN = 1.0, .R1 = true, .X0 = 8.0}).XOUT, 8.0);
  EXPECT_EQ(block({.XIN = 1.0, .R1 = true, .X0 = 8.0}).XOUT, 8.0);
  EXPECT_NEAR(block({.XIN = 1.0, .R1 = false, .X0 = 0.0}).XOUT, 1.0 + 7.0 * std::exp(-0.2), 1e-14);
}

TEST(Lag, TheSlopeAtTheNeutralSettingIsThatOfALag) {
  // A lag of a small T1 is XIN − T1·XIN': what a tuner that starts at 0 must see.
  const double small = 1e-6 * lag_ts;
  Stepper<Lag> none(lag_ts, {.T1 = 0.0, .SETTLED = true});
  Stepper<Lag> some(lag_ts, {.T1 = small, .SETTLED = true});
  double last = 0.0;
  for (int k = 0; k < 50; ++k) {
    const double x = std::sin(0.2 * k);
    const double change = some({.XIN = x, .R1 = false, .X0 = 0.0}).XOUT - none({.XIN = x, .R1 = false, .X0 = 0.0}).XOUT;
    if (k > 0) {
      EXPECT_NEAR(change / small, -(x - last) / lag_ts, 1e-6 / lag_ts);
    }
    last = x;
  }
}

TEST(Lag, ResponseIsThatOfTheTransferFunctionThroughStraightLines) {
  // Ramp-invariant: H(e^jw) = Σ over the aliases of the transfer function times sinc²; here by its own closed form for
  // a sinusoid of few samples a period, which for slow ones tends to 1/(1 + jωT).
  const double t1 = 20.0 * lag_ts;
  for (const double w : {0.001, 0.01, 0.05}) {
    Stepper<Lag> cosine(lag_ts, {.T1 = t1, .SETTLED = true});
    auto sine = cosine;
    std::complex<double> last;
    const int settled = 2000;
    for (int k = 0; k <= settled; ++k) {
      last = {cosine({.XIN = std::cos(w * k), .R1 = false, .X0 = 0.0}).XOUT,
              sine({.XIN = std::sin(w * k), .R1 = false, .X0 = 0.0}).XOUT};
    }
    const auto response = last / std::polar(1.0, w * settled);
    const auto expected = 1.0 / std::complex<double>(1.0, w / lag_ts * t1);
    EXPECT_NEAR(std::abs(response - expected), 0.0, 0.1 * w * w) << "second order in w";
  }
}

TEST(Lag, FloatKeepsSlowTimeConstants) {
  // 1 s at 50 µs: y = x + a·(y − x) in float would be off by 6e-4 and stop short of its target by as much.
  const float fine = 50e-6F;
  Stepper<Lag, float> block(fine, {.T1 = 1.0F, .SETTLED = false});
  float y = 0.0F;
  for (int k = 0; k <= 20'000; ++k) {
    y = block({.XIN = 1.0F, .R1 = false, .X0 = 0.0F}).XOUT;
  }
  EXPECT_NEAR(y, 1.0 - std::exp(-1.0), 2e-5);
  for (int k = 0; k < 400'000; ++k) {
    y = block({.XIN = 1.0F, .R1 = false, .X0 = 0.0F}).XOUT;
  }
  EXPECT_EQ(y, 1.0F);
}

TEST(Lag, FloatLosesAShareOfTheRateThatGrowsWithTheTimeConstant) {
  // Each step takes TS/T1 of the rate off it, to a float's last digit: of a step's answer up to T1/10, at
  // most T1/TS times half of 2^-23 is wrong.
  for (const float samples : {1e4F, 1e5F, 1e6F}) {
    Stepper<Lag, float> block(1e-3F, {.T1 = samples * 1e-3F, .SETTLED = false});
    float y = 0.0F;
    const int steps = static_cast<int>(samples / 10.0F);
    for (int k = 0; k <= steps; ++k) {
      y = block({.XIN = 1.0F, .R1 = false, .X0 = 0.0F}).XOUT;
    }
    EXPECT_NEAR(y / (1.0 - std::exp(-0.1)), 1.0, samples * 0x1p-24 + 1e-5) << samples << " samples";
  }
  Stepper<Lag, float> still(1e-3F, {.T1 = 36000.0F, .SETTLED = false});
  float y = 0.0F;
  for (int k = 0; k < 100'000; ++k) {
    y = still({.XIN = 1.0F, .R1 = false, .X0 = 0.0F}).XOUT;
  }
  EXPECT_LT(y, 1e-6F) << "beyond 2^24 samples nothing moves, as docs/explanation/numerics.md says";
}

TEST(Lag, DecaysToZeroWithoutDenormalNumbers) {
  Stepper<Lag> wide(lag_ts, {.T1 = 4.0 * lag_ts, .SETTLED = false});
  Stepper<Lag, float> narrow(1e-3F, {.T1 = 4e-3F, .SETTLED = false});
  for (int k = 0; k < 2000; ++k) {
    const auto w = wide({.XIN = 0.0, .R1 = false, .X0 = 1.0});
    const auto n = narrow({.XIN = 0.0F, .R1 = false, .X0 = 1.0F});
    EXPECT_NE(std::fpclassify(w.RATE), FP_SUBNORMAL);
    EXPECT_NE(std::fpclassify(n.RATE), FP_SUBNORMAL);
    if (k > 600) {
      EXPECT_EQ(w.XOUT, 0.0);
      EXPECT_EQ(n.XOUT, 0.0F);
    }
  }
}

TEST(LeadLag, AStepJumpsByTheLeadAndSettlesWithTheLag) {
  // The step rises over one sample; after it the response falls exponentially with T2 onto 1.
  const double t1 = 30.0 * lag_ts;
  const double t2 = 6.0 * lag_ts;
  Stepper<LeadLag> block(lag_ts, {.T1 = t1, .T2 = t2});
  block({.XIN = 0.0, .R1 = false});
  // (1 + T1 s)/(1 + T2 s) = 1 + (T1 − T2)·s/(1 + T2 s); the ramp of one sample leaves (1 − e^(−TS/T2))/TS.
  const double first = 1.0 + (t1 - t2) * (1.0 - std::exp(-lag_ts / t2)) / lag_ts;
  for (int k = 0; k < 100; ++k) {
    EXPECT_NEAR(block({.XIN = 1.0, .R1 = false}).XOUT, 1.0 + (first - 1.0) * std::exp(-k * lag_ts / t2), 1e-13);
  }
}

TEST(LeadLag, UndoesALagOfItsLead) {
  const double t1 = 9.0 * lag_ts;
  Stepper<Lag> lag(lag_ts, {.T1 = t1, .SETTLED = true});
  Stepper<LeadLag> lead(lag_ts, {.T1 = t1, .T2 = 0.0});
  double worst = 0.0;
  for (int k = 0; k < 2000; ++k) {
    const double x = std::sin(0.01 * k);
    const double back = lead({.XIN = lag({.XIN = x, .R1 = false, .X0 = 0.0}).XOUT, .R1 = false}).XOUT;
    if (k > 200) {  // the corner at the start has died away
      worst = std::max(worst, std::fabs(back - x));
    }
  }
  // The two-point derivative is late by half a sample: an error of T1·TS/2·|y''|.
  EXPECT_NEAR(worst, 0.5 * t1 / lag_ts * 1e-4, 0.02 * t1 / lag_ts * 1e-4);
}

TEST(LeadLag, EqualTimeConstantsPassTheInputThrough) {
  Stepper<LeadLag> block(lag_ts, {.T1 = 5.0 * lag_ts, .T2 = 5.0 * lag_ts});
  RandomIo random(1, lag_ts);
  for (int k = 0; k < 100; ++k) {
    const double x = random.unit();
    EXPECT_EQ(block({.XIN = x, .R1 = false}).XOUT, x);
  }
}

TEST(LeadLag, AResetSettles) {
  Stepper<LeadLag> block(lag_ts, {.T1 = 0.5, .T2 = 0.1});
  block({.XIN = 0.0, .R1 = false});
  EXPECT_GT(block({.XIN = 1.0, .R1 = false}).XOUT, 4.0);
  EXPECT_EQ(block({.XIN = 2.0, .R1 = true}).XOUT, 2.0);
  EXPECT_EQ(block({.XIN = 2.0, .R1 = false}).XOUT, 2.0);
}

}  // namespace
}  // namespace hysteron::testing
