// Values that a slower task holds.
#include "blocks/held.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/blocks/stepper.hpp"

namespace hysteron::testing {
namespace {

/// The time of the last run of a task up to t, 0 before the first.
double last_run(double t, double period, double phase) {
  return std::max(0.0, (std::floor(t / period + phase + 1e-6) - phase) * period);
}

TEST(Held, ARampIsTheTimeOfTheLastRun) {
  const double ts = 1e-3;
  for (const double period : {0.0005, 0.001, 0.0025, 0.007, 0.0123}) {
    for (const double phase : {0.0, 0.25, 0.9}) {
      Stepper<Held> block(ts, {.PERIOD = period, .PHASE = phase});
      for (int k = 0; k < 500; ++k) {
        const double t = k * ts;
        EXPECT_NEAR(block({.XIN = 3.0 * t}).XOUT, 3.0 * last_run(t, period, phase), 1e-8)
            << period << ", " << phase << ", step " << k;
      }
    }
  }
}

TEST(Held, OfAWholeNumberOfSamplesGivesEachNthAsItIs) {
  Stepper<Held> block(0.1, {.PERIOD = 0.3, .PHASE = 0.0});
  double expected = 0.0;
  for (int k = 0; k < 3000; ++k) {
    const double x = std::sin(0.37 * k);
    expected = k % 3 == 0 ? x : expected;
    EXPECT_NEAR(block({.XIN = x}).XOUT, expected, 2e-6) << k;  // a run counts with a millionth of a period
  }
}

TEST(Held, IsLateByHalfAPeriodInTheMean) {
  Stepper<Held> block(1e-3, {.PERIOD = 0.02, .PHASE = 0.0});
  double sum = 0.0;
  for (int k = 0; k < 2000; ++k) {
    sum += k * 1e-3 - block({.XIN = k * 1e-3}).XOUT;
  }
  EXPECT_NEAR(sum / 2000.0, 0.5 * (0.02 - 1e-3), 1e-5);
}

TEST(Held, AShorterAndShorterPeriodPassesMoreAndMore) {
  Stepper<Held> block(1e-3, {.PERIOD = 1e-9, .PHASE = 0.5});
  for (int k = 0; k < 200; ++k) {
    const double x = std::cos(0.1 * k);
    EXPECT_NEAR(block({.XIN = x}).XOUT, x, 1e-5);
  }
}

}  // namespace
}  // namespace hysteron::testing
