// Round numbers along an axis, for reaches of every size.
#include "plots/axis.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "support/numbers.hpp"

namespace hysteron::plots {
namespace {

TEST(Axis, TicksAreRoundRiseAndLieWithin) {
  for (const double size : {1e-300, 1e-9, 0.03, 1.0, 7.0, 123.4, 1e7, 1e300}) {
    for (const double offset : {-1.0, -0.5, 0.0, 3.7}) {
      const Reach reach{.low = size * offset, .high = size * (offset + 1.0)};
      const auto numbers = round_numbers(reach, 6);
      ASSERT_GE(numbers.size(), 2U) << size << " " << offset;
      EXPECT_LE(numbers.size(), 8U);
      const double step = numbers[1] - numbers[0];
      const double digit = step / std::pow(10.0, std::floor(std::log10(step * 1.0000001)));
      EXPECT_LT(std::min({std::abs(digit - 1.0), std::abs(digit - 2.0), std::abs(digit - 5.0)}), 1e-6) << step;
      std::set<std::string> labels;
      for (const double number : numbers) {
        EXPECT_GE(number, reach.low - 1e-6 * size);
        EXPECT_LE(number, reach.high + 1e-6 * size);
        labels.insert(tick_text(number, step));
      }
      EXPECT_EQ(labels.size(), numbers.size()) << "two ticks have the same text";
    }
  }
}

/// One number alone, as the 0 of -4.4 to 4.4 in steps of 5, shows no scale.
TEST(Axis, ThereAreTwoTicksAtLeast) {
  for (int most = 1; most < 7; ++most) {
    for (double end = 1.0; end < 10.0; end += 0.1) {
      EXPECT_GE(round_numbers({.low = -end, .high = end}, most).size(), 2U) << end << " " << most;
    }
  }
}

/// Seconds since 1970 with a span of a second: six digits would be the same at every tick.
TEST(Axis, TicksFarFromZeroAreTold) {
  const Reach reach{.low = 1717408800.0, .high = 1717408801.0};
  const auto numbers = round_numbers(reach, 5);
  ASSERT_GE(numbers.size(), 4U);
  EXPECT_EQ(tick_text(numbers[1], numbers[1] - numbers[0]), "1717408800.2");
}

TEST(Axis, OfOneValueOrNoneThereIsAReachToo) {
  EXPECT_EQ(Reach().with_room(0.05).low, 0.0);
  EXPECT_EQ(Reach().with_room(0.05).high, 1.0);
  for (const double value : {0.0, 5.0, -3e-20, 1e300}) {
    Reach reach;
    reach.take(value);
    reach.take(not_a_number);
    reach.take(infinity);
    const Reach wide = reach.with_room(0.05);
    EXPECT_LT(wide.low, value);
    EXPECT_GT(wide.high, value);
    EXPECT_FALSE(round_numbers(wide, 5).empty());
  }
}

TEST(Axis, AnEndlessReachHasNoTicks) {
  EXPECT_TRUE(round_numbers({.low = 0.0, .high = 0.0}, 5).empty());
  EXPECT_TRUE(round_numbers({.low = -infinity, .high = infinity}, 5).empty());
}

}  // namespace
}  // namespace hysteron::plots
