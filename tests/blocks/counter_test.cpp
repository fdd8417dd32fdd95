// Counters: against whole-number models, and at the ends of DINT.
#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <random>

#include "blocks/down_counter.hpp"
#include "blocks/up_counter.hpp"
#include "blocks/up_down_counter.hpp"
#include "tests/blocks/stepper.hpp"

namespace hysteron::testing {
namespace {

constexpr std::int32_t highest = std::numeric_limits<std::int32_t>::max();

TEST(UpCounter, CountsRisesNotSteps) {
  Stepper<UpCounter> counter(1.0);
  for (int k = 0; k < 40; ++k) {
    const auto out = counter({.CU = k % 4 < 2, .R = false, .PV = 5});
    EXPECT_EQ(out.CV, k / 4 + 1) << "the first step counts as a rise";
    EXPECT_EQ(out.Q, out.CV >= 5);
  }
  EXPECT_EQ(counter({.CU = true, .R = true, .PV = 5}).CV, 0) << "reset dominates";
  EXPECT_EQ(counter({.CU = true, .R = false, .PV = 5}).CV, 0) << "the rise under reset is gone";
}

TEST(UpCounter, StaysAtTheEndOfDint) {
  Stepper<UpCounter> counter(1.0);
  counter.state.COUNT = highest - 1;
  for (int k = 0; k < 10; ++k) {
    const auto out = counter({.CU = k % 2 == 0, .R = false, .PV = highest});
    EXPECT_EQ(out.CV, highest);
    EXPECT_TRUE(out.Q);
  }
}

TEST(DownCounter, CountsDownFromWhatWasLoaded) {
  Stepper<DownCounter> counter(1.0);
  EXPECT_TRUE(counter({.CD = false, .LD = false, .PV = 3}).Q) << "0 before the first load";
  EXPECT_EQ(counter({.CD = false, .LD = true, .PV = 3}).CV, 3);
  for (int k = 0; k < 5; ++k) {
    const auto out = counter({.CD = true, .LD = false, .PV = 3});
    EXPECT_EQ(out.CV, 2 - k);
    EXPECT_EQ(out.Q, 2 - k <= 0);
    counter({.CD = false, .LD = false, .PV = 3});
  }
}

TEST(DownCounter, StaysAtTheEndOfDint) {
  Stepper<DownCounter> counter(1.0);
  counter.state.COUNT = -highest + 1;
  for (int k = 0; k < 10; ++k) {
    EXPECT_EQ(counter({.CD = k % 2 == 0, .LD = false, .PV = 0}).CV, -highest);
  }
}

TEST(UpDownCounter, AgreesWithAModelOnAnyInput) {
  Stepper<UpDownCounter> counter(1.0);
  std::mt19937 random(29);
  std::int64_t model = 0;
  bool up_before = false;
  bool down_before = false;
  for (int k = 0; k < 100000; ++k) {
    const bool up = (random() & 1U) != 0;
    const bool down = (random() & 1U) != 0;
    const bool reset = random() % 50 == 0;
    const bool load = random() % 50 == 0;
    const auto preset = static_cast<std::int32_t>(random() % 20);
    const bool rise = up && !up_before;
    const bool fall = down && !down_before;
    if (reset) {
      model = 0;
    } else if (load) {
      model = preset;
    } else if (rise != fall) {
      model += rise ? 1 : -1;
    }
    up_before = up;
    down_before = down;
    const auto out = counter({.CU = up, .CD = down, .R = reset, .LD = load, .PV = preset});
    ASSERT_EQ(out.CV, model) << k;
    ASSERT_EQ(out.QU, model >= preset);
    ASSERT_EQ(out.QD, model <= 0);
  }
}

TEST(UpDownCounter, StaysAtBothEndsOfDint) {
  Stepper<UpDownCounter> counter(1.0);
  counter.state.COUNT = highest;
  EXPECT_EQ(counter({.CU = true, .CD = false, .R = false, .LD = false, .PV = 0}).CV, highest);
  counter.state.COUNT = -highest;
  EXPECT_EQ(counter({.CU = false, .CD = true, .R = false, .LD = false, .PV = 0}).CV, -highest);
}

}  // namespace
}  // namespace hysteron::testing
