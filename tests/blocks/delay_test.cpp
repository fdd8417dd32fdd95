// The unit delay and the dead time.
#include "blocks/delay.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <vector>

#include "blocks/dead_time.hpp"
#include "blocks/delay_bool.hpp"
#include "blocks/delay_dint.hpp"
#include "blocks/delay_word.hpp"
#include "tests/blocks/random_io.hpp"
#include "tests/blocks/stepper.hpp"

namespace hysteron::testing {
namespace {

TEST(Delay, GivesTheInputOfTheStepBefore) {
  Stepper<Delay> block(1.0, {.X0 = 9.0});
  EXPECT_EQ(block({.XIN = 1.0, .R1 = false}).XOUT, 9.0);
  EXPECT_EQ(block({.XIN = 2.0, .R1 = false}).XOUT, 1.0);
  EXPECT_EQ(block({.XIN = 3.0, .R1 = true}).XOUT, 9.0);
  EXPECT_EQ(block({.XIN = 4.0, .R1 = false}).XOUT, 3.0);
}

TEST(Delay, OfAnyOtherTypeGivesTheValueOfTheStepBefore) {
  Stepper<DelayBool> truth(1.0, {.X0 = true});
  EXPECT_EQ(truth({.XIN = false, .R1 = false}).XOUT, true);
  EXPECT_EQ(truth({.XIN = true, .R1 = false}).XOUT, false);
  EXPECT_EQ(truth({.XIN = false, .R1 = false}).XOUT, true);
  EXPECT_EQ(truth({.XIN = false, .R1 = true}).XOUT, true) << "at a reset X0";
  Stepper<DelayInt> number(1.0, {.X0 = -9});
  EXPECT_EQ(number({.XIN = 2147483647, .R1 = false}).XOUT, -9);
  EXPECT_EQ(number({.XIN = 4, .R1 = false}).XOUT, 2147483647)
      << "every digit is kept, which an LREAL of 32 bits would not";
  EXPECT_EQ(number({.XIN = 5, .R1 = true}).XOUT, -9);
  EXPECT_EQ(number({.XIN = 6, .R1 = false}).XOUT, 5);
  Stepper<DelayWord> word(1.0, {.X0 = 0x8001});
  EXPECT_EQ(word({.XIN = 0xFFFF, .R1 = false}).XOUT, 0x8001);
  EXPECT_EQ(word({.XIN = 1, .R1 = false}).XOUT, 0xFFFF);
  EXPECT_EQ(word({.XIN = 2, .R1 = true}).XOUT, 0x8001);
}

TEST(DeadTime, IsAWalkBackInTheRecord) {
  // Against the whole record, with a line through the two samples around t − DEAD_TIME.
  for (const double samples : {0.0, 0.3, 1.0, 1.75, 7.0, 100.5, 1023.0, 1023.5, 1024.0}) {
    RandomIo random(1, 1.0);
    Stepper<DeadTime> block(1.0, {.DEAD_TIME = samples, .SETTLED = true, .X0 = 0.0});
    std::vector<double> record;
    const auto at_step = [&](int k) { return record[static_cast<std::size_t>(std::max(k, 0))]; };
    for (int k = 0; k < 3000; ++k) {
      record.push_back(random.unit());
      const auto whole = static_cast<int>(samples);
      const double expected = std::lerp(at_step(k - whole), at_step(k - whole - 1), samples - whole);
      const auto out = block({.XIN = record.back(), .R1 = false});
      ASSERT_NEAR(out.XOUT, expected, 1e-15) << samples << " samples, step " << k;
      ASSERT_FALSE(out.ERROR);
    }
  }
}

TEST(DeadTime, WholeDelaysAreExact) {
  const double ts = 1.0 / 1024.0;
  Stepper<DeadTime> block(ts, {.DEAD_TIME = 5.0 * ts, .SETTLED = false, .X0 = -1.0});
  for (int k = 0; k < 20; ++k) {
    EXPECT_EQ(block({.XIN = std::sqrt(k), .R1 = false}).XOUT, k < 5 ? -1.0 : std::sqrt(k - 5));
  }
}

TEST(DeadTime, DelayAndGainAreAsStated) {
  const int settled = 200;
  for (const double samples : {0.5, 3.0, 3.25, 12.5}) {
    for (const double w : {0.05, 0.5, 1.5}) {
      Stepper<DeadTime> cosine(1.0, {.DEAD_TIME = samples, .SETTLED = true, .X0 = 0.0});
      auto sine = cosine;
      std::complex<double> last;
      for (int k = 0; k <= settled; ++k) {
        last = {cosine({.XIN = std::cos(w * k), .R1 = false}).XOUT, sine({.XIN = std::sin(w * k), .R1 = false}).XOUT};
      }
      const auto response = last / std::polar(1.0, w * settled);
      const double f = samples - std::floor(samples);
      EXPECT_NEAR(std::abs(response), std::abs(1.0 - f + f * std::polar(1.0, -w)), 1e-12);
      if (f == 0.5) {
        EXPECT_NEAR(std::abs(response), std::cos(w / 2), 1e-12);
        EXPECT_NEAR(std::abs(response - std::polar(std::cos(w / 2), -w * samples)), 0.0, 1e-12) << "pure delay";
      }
    }
  }
}

TEST(DeadTime, IsContinuousInTheDeadTime) {
  RandomIo random(2, 1.0);
  Stepper<DeadTime> below(1.0, {.DEAD_TIME = 4.0 - 1e-12, .SETTLED = true, .X0 = 0.0});
  Stepper<DeadTime> above(1.0, {.DEAD_TIME = 4.0 + 1e-12, .SETTLED = true, .X0 = 0.0});
  for (int k = 0; k < 50; ++k) {
    const double x = random.unit();
    EXPECT_NEAR(below({.XIN = x, .R1 = false}).XOUT, above({.XIN = x, .R1 = false}).XOUT, 1e-11);
  }
}

TEST(DeadTime, AResetEmptiesIt) {
  Stepper<DeadTime> block(1.0, {.DEAD_TIME = 2.0, .SETTLED = true, .X0 = -7.0});
  for (int k = 0; k < 2000; ++k) {
    block({.XIN = 100.0, .R1 = false});
  }
  EXPECT_EQ(block({.XIN = 1.0, .R1 = true}).XOUT, -7.0);
  EXPECT_EQ(block({.XIN = 2.0, .R1 = false}).XOUT, -7.0);
  EXPECT_EQ(block({.XIN = 3.0, .R1 = false}).XOUT, 1.0);
  EXPECT_EQ(block({.XIN = 4.0, .R1 = false}).XOUT, 2.0);
}

TEST(DeadTime, SaysThatItIsTooLong) {
  for (const double dead_time : {1024.5, 1e300, infinity, not_a_number, -0.5}) {
    Stepper<DeadTime> block(1.0, {.DEAD_TIME = dead_time, .SETTLED = true, .X0 = 0.0});
    const auto out = block({.XIN = 1.0, .R1 = false});
    EXPECT_TRUE(out.ERROR) << dead_time;
    EXPECT_EQ(out.ERRORID, fault::dead_time_too_long);
    if (!(dead_time < 0.0)) {
      EXPECT_EQ(out.XOUT, 1.0) << "held at the longest";
    }
  }
}

}  // namespace
}  // namespace hysteron::testing
