// The blocks that shape a signal: their curves, and that each effect passes its input at the neutral setting.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "blocks/backlash.hpp"
#include "blocks/dead_band.hpp"
#include "blocks/hysteresis_switch.hpp"
#include "blocks/limit.hpp"
#include "blocks/quantizer.hpp"
#include "blocks/rate_limit.hpp"
#include "blocks/sample_and_hold.hpp"
#include "blocks/switch.hpp"
#include "tests/blocks/neutral_run.hpp"
#include "tests/blocks/random_io.hpp"
#include "tests/blocks/stepper.hpp"

namespace hysteron::testing {
namespace {

/// Signals on which a formula that is only nearly neutral fails: signed zeros, the ends of the range, no number.
std::vector<double> awkward_signal() {
  std::vector<double> signal{
      -0.0,   0.0,       0.1,      -0.0, 1e308,        -1e308, std::numeric_limits<double>::denorm_min(),
      1e-310, -infinity, infinity, 3.0,  not_a_number, 0.3,    -0.7};
  std::mt19937 random(7);
  std::uniform_real_distribution<double> exponent(-300.0, 300.0);
  for (int i = 0; i < 1000; ++i) {
    signal.push_back((i % 2 == 0 ? 1.0 : -1.0) * std::pow(10.0, exponent(random)));
  }
  return signal;
}

TEST(Neutral, PassesItsInputBitForBit) {
  for (const About& about : {Limit::about, DeadBand::about, RateLimit::about, Quantizer::about, Backlash::about}) {
    SCOPED_TRACE(std::string(about.name));
    NeutralRun run(about.name, 5e-5);
    const std::vector<double> in(places(run.inputs()).back());
    for (const double x : awkward_signal()) {
      EXPECT_TRUE(same_bits(run.step(in, x), x)) << x;
    }
  }
}

TEST(Limit, HoldsTheBoundsAndSaysWhich) {
  Stepper<Limit> limit(1.0, {.MN = -1.0, .MX = 2.0});
  for (double x = -3.0; x <= 3.0; x += 0.25) {
    const auto out = limit({.XIN = x});
    EXPECT_EQ(out.XOUT, x < -1.0 ? -1.0 : (x > 2.0 ? 2.0 : x));
    EXPECT_EQ(out.QLOW, x < -1.0);
    EXPECT_EQ(out.QHIGH, x > 2.0);
  }
}

TEST(DeadBand, LeavesWhatTheLimiterCutsOff) {
  Stepper<DeadBand> band(1.0, {.WIDTH = 1.0, .SPREAD = 0.0});
  Stepper<Limit> limit(1.0, {.MN = -0.5, .MX = 0.5});
  for (double x = -2.0; x <= 2.0; x += 0.125) {
    EXPECT_EQ(band({.XIN = x}).XOUT, x - limit({.XIN = x}).XOUT);
  }
}

TEST(RateLimit, FollowsAStepInStraightLines) {
  Stepper<RateLimit> limiter(0.25, {.RISE = 2.0, .FALL = 1.0});
  EXPECT_EQ(limiter({.XIN = -3.0}).XOUT, -3.0) << "the first sample passes";
  for (int k = 1; k <= 20; ++k) {
    EXPECT_EQ(limiter({.XIN = 1.0}).XOUT, std::min(1.0, -3.0 + 0.5 * k));
  }
  for (int k = 1; k <= 20; ++k) {
    EXPECT_EQ(limiter({.XIN = 0.0}).XOUT, std::max(0.0, 1.0 - 0.25 * k));
  }
}

TEST(RateLimit, ZeroRateHolds) {
  Stepper<RateLimit> limiter(0.1, {.RISE = 0.0, .FALL = infinity});
  EXPECT_EQ(limiter({.XIN = 1.0}).XOUT, 1.0);
  EXPECT_EQ(limiter({.XIN = 5.0}).XOUT, 1.0);
  EXPECT_EQ(limiter({.XIN = -5.0}).XOUT, -5.0);
}

TEST(RateLimit, PassesASineBelowItsRateAndMakesATriangleOfOneFarAboveIt) {
  const double ts = 1e-3;
  const double omega = 2.0;
  Stepper<RateLimit> wide(ts, {.RISE = 2.001, .FALL = 2.001});
  Stepper<RateLimit> narrow(ts, {.RISE = 0.2, .FALL = 0.2});
  double highest = 0.0;
  for (int k = 0; k < 200000; ++k) {
    const double x = std::sin(omega * ts * k);
    EXPECT_NEAR(wide({.XIN = x}).XOUT, x, 1e-15);
    const double y = narrow({.XIN = x}).XOUT;
    if (k > 190000) {
      highest = std::max(highest, std::abs(y));
    }
  }
  // Far into slewing the output is a triangle of rate 0.2 that turns where the sine meets it, so its peak is the rate
  // times a quarter of the period, 0.2·π/4, to a step.
  EXPECT_NEAR(highest, 0.2 * 3.141592653589793 / 4.0, 0.2 * ts);
}

TEST(Switch, PassesTheChosenSignalOnly) {
  Stepper<Switch> two_way(1.0);
  EXPECT_EQ(two_way({.G = false, .IN0 = 1.0, .IN1 = not_a_number}).XOUT, 1.0);
  EXPECT_EQ(two_way({.G = true, .IN0 = not_a_number, .IN1 = 2.0}).XOUT, 2.0);
}

TEST(Quantizer, ErrorIsHalfAQuantumAtMost) {
  Stepper<Quantizer> quantizer(1.0, {.QUANTUM = 0.1, .SPREAD = 0.0});
  for (double x = -5.0; x < 5.0; x += 0.00137) {
    const double y = quantizer({.XIN = x}).XOUT;
    EXPECT_LE(std::abs(y - x), 0.05 * (1.0 + 1e-12));
    EXPECT_NEAR(y / 0.1, std::round(y / 0.1), 1e-12);
    EXPECT_TRUE(same_bits(quantizer({.XIN = y}).XOUT, y)) << "a quantized signal is on the grid";
  }
}

TEST(Quantizer, HalvesGoAwayFromZeroAndNothingElseDoes) {
  Stepper<Quantizer> quantizer(1.0, {.QUANTUM = 1.0, .SPREAD = 0.0});
  EXPECT_EQ(quantizer({.XIN = 2.5}).XOUT, 3.0);
  EXPECT_EQ(quantizer({.XIN = -2.5}).XOUT, -3.0);
  EXPECT_EQ(quantizer({.XIN = 0.49999999999999994}).XOUT, 0.0) << "adding 1/2 and truncating would give 1";
  EXPECT_EQ(quantizer({.XIN = 2147482999.4}).XOUT, 2147482999.0);
  EXPECT_EQ(quantizer({.XIN = 1e10 + 0.25}).XOUT, 1e10 + 0.25) << "beyond the integers the signal passes";
}

TEST(Quantizer, ErrorOfARampIsWhiteWithVarianceOfATwelfth) {
  const double quantum = 0.01;
  Stepper<Quantizer> quantizer(1.0, {.QUANTUM = quantum, .SPREAD = 0.0});
  double sum = 0.0;
  const int count = 100000;
  for (int k = 0; k < count; ++k) {
    const double x = 1.0 + 1.2345678e-4 * k;
    const double e = quantizer({.XIN = x}).XOUT - x;
    sum += e * e;
  }
  EXPECT_NEAR(sum / count, quantum * quantum / 12.0, 1e-3 * quantum * quantum);
}

TEST(Quantizer, SpreadThresholdsGiveTheMeanOfManyQuantizers) {
  const double spread = 0.15;
  Stepper<Quantizer> spread_out(1.0, {.QUANTUM = 2.0, .SPREAD = spread});
  const int count = 2000;
  for (double x = -5.0; x < 5.0; x += 0.0371) {
    double sum = 0.0;
    for (int k = 0; k < count; ++k) {
      sum += 2.0 * std::round(0.5 * x + spread * ((2.0 * k + 1.0) / count - 1.0));
    }
    EXPECT_NEAR(spread_out({.XIN = x}).XOUT, sum / count, 2.0 / count) << x;
  }
}

TEST(Backlash, FollowsHalfAGapBehindAndRestsInTheGap) {
  Stepper<Backlash> play(1.0, {{.WIDTH = 0.5, .SPREAD = 0.0}, 0.0});
  EXPECT_EQ(play({.XIN = 1.0}).XOUT, 1.0) << "starts in the middle of the gap";
  EXPECT_EQ(play({.XIN = 1.25}).XOUT, 1.0);
  EXPECT_EQ(play({.XIN = 3.0}).XOUT, 2.75);
  EXPECT_EQ(play({.XIN = 2.5}).XOUT, 2.75);
  EXPECT_EQ(play({.XIN = 0.0}).XOUT, 0.25);
}

TEST(Backlash, WithSpreadIsTheMeanOfThreePlays) {
  Stepper<Backlash> soft(1.0, {{.WIDTH = 0.4, .SPREAD = 0.75}, 0.5});
  Stepper<Backlash> narrow(1.0, {{.WIDTH = 0.1, .SPREAD = 0.0}, 0.5});
  Stepper<Backlash> middle(1.0, {{.WIDTH = 0.4, .SPREAD = 0.0}, 0.5});
  Stepper<Backlash> wide(1.0, {{.WIDTH = 0.7, .SPREAD = 0.0}, 0.5});
  for (int k = 0; k < 300; ++k) {
    const double x = std::sin(0.1 * k) + 0.4 * std::sin(0.37 * k);
    const double mean = (narrow({.XIN = x}).XOUT + middle({.XIN = x}).XOUT + wide({.XIN = x}).XOUT) / 3.0;
    EXPECT_NEAR(soft({.XIN = x}).XOUT, mean, 1e-15);
  }
}

TEST(DeadBand, WithSpreadHasSoftEdges) {
  Stepper<DeadBand> soft(1.0, {.WIDTH = 1.0, .SPREAD = 0.5});
  EXPECT_EQ(soft({.XIN = 0.25}).XOUT, 0.0);
  EXPECT_NEAR(soft({.XIN = 0.5}).XOUT, 0.25 / 3.0, 1e-15);
  EXPECT_NEAR(soft({.XIN = -0.75}).XOUT, -(0.5 + 0.25) / 3.0, 1e-15);
  EXPECT_NEAR(soft({.XIN = 2.0}).XOUT, 1.5, 1e-15);
}

TEST(Backlash, StartsWhereItIsToldInTheGap) {
  Stepper<Backlash> at_the_edge(1.0, {{.WIDTH = 0.5, .SPREAD = 0.0}, 1.0});
  EXPECT_EQ(at_the_edge({.XIN = 1.0}).XOUT, 1.0) << "the first sample passes as it is";
  EXPECT_EQ(at_the_edge({.XIN = 0.75}).XOUT, 0.75) << "followed at once downwards";
  EXPECT_EQ(at_the_edge({.XIN = 1.25}).XOUT, 0.75) << "the whole gap upwards";
  EXPECT_EQ(at_the_edge({.XIN = 2.0}).XOUT, 1.5);
  Stepper<Backlash> a_quarter(1.0, {{.WIDTH = 0.5, .SPREAD = 0.0}, -0.5});
  EXPECT_EQ(a_quarter({.XIN = 1.0}).XOUT, 1.0);
  EXPECT_EQ(a_quarter({.XIN = 1.125}).XOUT, 1.0);
  EXPECT_EQ(a_quarter({.XIN = 2.0}).XOUT, 1.875);
  EXPECT_EQ(a_quarter({.XIN = 0.0}).XOUT, 0.375);
}

TEST(Backlash, LoopNarrowerThanTheGapMovesNothingAndAWiderOneEnclosesItsArea) {
  const double width = 0.5;
  const int count = 4000;
  for (const double amplitude : {0.2, 1.0}) {
    Stepper<Backlash> play(1.0, {{.WIDTH = width, .SPREAD = 0.0}, 0.0});
    double area = 0.0;
    double x_before = 0.0;
    double y_before = play({.XIN = 0.0}).XOUT;
    for (int k = 1; k <= 2 * count; ++k) {
      const double x = amplitude * std::sin(2.0 * 3.141592653589793 * k / count);
      const double y = play({.XIN = x}).XOUT;
      if (k > count) {
        area += 0.5 * (y + y_before) * (x - x_before);
      }
      x_before = x;
      y_before = y;
    }
    // The loop of a play operator of half width r at amplitude A is a parallelogram of area 4·r·(A − r).
    const double half = width / 2.0;
    EXPECT_NEAR(std::abs(area), amplitude > half ? 4.0 * half * (amplitude - half) : 0.0, 1e-5);
  }
}

TEST(Backlash, PathDoesNotDependOnHowFineItIsSampled) {
  Stepper<Backlash> coarse(1.0, {{.WIDTH = 0.3, .SPREAD = 0.0}, 0.0});
  Stepper<Backlash> fine(1.0, {{.WIDTH = 0.3, .SPREAD = 0.0}, 0.0});
  coarse({.XIN = 0.0});
  fine({.XIN = 0.0});
  double before = 0.0;
  std::mt19937 random(3);
  std::uniform_int_distribution<int> level(-64, 64);
  for (int k = 0; k < 500; ++k) {
    const double x = level(random) / 64.0;
    const double direct = coarse({.XIN = x}).XOUT;
    double stepped = 0.0;
    for (int i = 1; i <= 16; ++i) {
      stepped = fine({.XIN = before + (x - before) * i / 16.0}).XOUT;
    }
    EXPECT_NEAR(direct, stepped, 1e-15);
    before = x;
  }
}

TEST(HysteresisSwitch, SwitchesBeyondTheBandOnly) {
  Stepper<HysteresisSwitch> alarm(1.0, {.EPS = 0.5});
  const std::array<double, 9> level{0.0, 10.5, 10.6, 10.0, 9.5, 9.4, 10.4, 10.51, 9.6};
  const std::array<bool, 9> expected{false, false, true, true, true, false, false, true, true};
  for (std::size_t k = 0; k < level.size(); ++k) {
    EXPECT_EQ(alarm({.XIN1 = level[k], .XIN2 = 10.0}).Q, expected[k]) << k;
  }
}

TEST(HysteresisSwitch, NoiseInsideTheBandDoesNotChatter) {
  Stepper<HysteresisSwitch> alarm(1.0, {.EPS = 0.1});
  std::mt19937 random(11);
  std::uniform_real_distribution<double> noise(-0.099, 0.099);
  int changes = 0;
  bool before = false;
  for (int k = 0; k < 100000; ++k) {
    const double slow = std::sin(2.0 * 3.141592653589793 * (k + 25000) / 50000.0);
    const bool q = alarm({.XIN1 = slow + noise(random), .XIN2 = 0.0}).Q;
    changes += q != before ? 1 : 0;
    before = q;
  }
  // The sine begins at 0 and falls (phase of half a period), and crosses zero upwards at k = 25 000 and 75 000 and
  // downwards at 50 000: three changes; the end at 100 000 lies on a downward crossing, still inside the band.
  EXPECT_EQ(changes, 3);
}

TEST(SampleAndHold, TracksThenHolds) {
  Stepper<SampleAndHold> hold(1.0, {.X0 = -7.0});
  EXPECT_EQ(hold({.XIN = 1.0, .TRACK = false}).XOUT, -7.0);
  EXPECT_EQ(hold({.XIN = 2.0, .TRACK = true}).XOUT, 2.0);
  EXPECT_EQ(hold({.XIN = 3.0, .TRACK = true}).XOUT, 3.0);
  EXPECT_EQ(hold({.XIN = 4.0, .TRACK = false}).XOUT, 3.0);
  EXPECT_EQ(hold({.XIN = 5.0, .TRACK = false}).XOUT, 3.0);
}

}  // namespace
}  // namespace hysteron::testing
