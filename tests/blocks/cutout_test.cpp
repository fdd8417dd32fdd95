// An actuator that another signal switches off.
#include "blocks/cutout.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/blocks/random_io.hpp"
#include "tests/blocks/stepper.hpp"

namespace hysteron::testing {
namespace {

TEST(Cutout, IsOffOutsideItsLimitsOneStepLater) {
  Stepper<Cutout> block(1.0, {.MN = -1.0, .MX = 2.0, .BAND = 0.0});
  EXPECT_EQ(block({.XIN = 5.0, .Z = 3.0}).XOUT, 5.0) << "in the first step it is on";
  EXPECT_EQ(block({.XIN = 5.0, .Z = 3.0}).XOUT, 0.0);
  EXPECT_EQ(block({.XIN = 5.0, .Z = 1.0}).XOUT, 0.0);
  EXPECT_EQ(block({.XIN = 5.0, .Z = -3.0}).XOUT, 2.5) << "half of the way from 3 to 1 lay below 2";
  EXPECT_EQ(block({.XIN = 5.0, .Z = -3.0}).XOUT, 2.5) << "and half of that from 1 to −3 above −1";
  EXPECT_EQ(block({.XIN = 5.0, .Z = 0.0}).XOUT, 0.0);
}

/// Over a long run the mean is what a fine integration of the switch gives.
TEST(Cutout, CountsThePartOfASampleInWhichItWasOn) {
  const double ts = 0.05;
  Stepper<Cutout> block(ts, {.MN = -0.6, .MX = 0.7, .BAND = 0.3});
  const auto z = [](double t) { return std::sin(t) + 0.2 * std::sin(2.7 * t); };
  double sum = 0.0;
  double fine_sum = 0.0;
  bool off = false;
  constexpr int fine = 50;
  constexpr int steps = 20000;
  for (int k = 0; k < steps; ++k) {
    sum += block({.XIN = 1.0, .Z = z(k * ts)}).XOUT / steps;
    for (int i = 0; i < fine; ++i) {
      const double now = z((k + static_cast<double>(i) / fine) * ts);
      const double band = off ? 0.3 : 0.0;
      off = now < -0.6 + band || now > 0.7 - band;
      fine_sum += (off ? 0.0 : 1.0) / (fine * steps);
    }
  }
  EXPECT_NEAR(sum, fine_sum, 1e-3);
  EXPECT_GT(sum, 0.2);
  EXPECT_LT(sum, 0.6);
}

TEST(Cutout, StaysOffUntilTheSignalIsWithinByTheBand) {
  Stepper<Cutout> block(1.0, {.MN = -infinity, .MX = 10.0, .BAND = 4.0});
  block({.XIN = 1.0, .Z = 11.0});
  EXPECT_EQ(block({.XIN = 1.0, .Z = 7.0}).XOUT, 0.0);
  EXPECT_EQ(block({.XIN = 1.0, .Z = 9.0}).XOUT, 0.0);
  EXPECT_EQ(block({.XIN = 1.0, .Z = 6.0}).XOUT, 0.0);
  EXPECT_EQ(block({.XIN = 1.0, .Z = 9.5}).XOUT, 0.0) << "it was outside the band all the way to 6";
  EXPECT_EQ(block({.XIN = 1.0, .Z = 9.5}).XOUT, 1.0);
  EXPECT_EQ(block({.XIN = 1.0, .Z = 9.5}).XOUT, 1.0);
}

}  // namespace
}  // namespace hysteron::testing
