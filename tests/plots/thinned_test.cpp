// Of very many rows few are drawn, and none that a reader would miss.
#include "plots/thinned.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "support/numbers.hpp"

namespace hysteron::plots {
namespace {

std::vector<double> noise(std::size_t count, std::uint64_t seed) {
  std::vector<double> values(count);
  for (double& value : values) {
    seed = seed * 6364136223846793005U + 1442695040888963407U;
    value = static_cast<double>(seed >> 40U) / 16777216.0;
  }
  return values;
}

/// Property: in each group the kept rows have the extremes of all rows, in x and in y.
TEST(Thinned, ExtremesOfEachGroupAreKept) {
  constexpr std::size_t count = 100003;
  constexpr std::size_t groups = 97;
  const auto x = noise(count, 1);
  const auto y = noise(count, 2);
  const auto rows = thinned(x, y, groups);
  EXPECT_LE(rows.size(), 6 * groups);
  EXPECT_TRUE(std::ranges::is_sorted(rows));
  EXPECT_EQ(std::ranges::adjacent_find(rows), rows.end());
  for (const auto& values : {x, y}) {
    for (std::size_t group = 0; group < groups; ++group) {
      const std::size_t begin = count * group / groups;
      const std::size_t end = count * (group + 1) / groups;
      double low = infinity;
      double high = -infinity;
      for (const std::size_t k : rows) {
        if (k >= begin && k < end) {
          low = std::min(low, values[k]);
          high = std::max(high, values[k]);
        }
      }
      const auto [least, largest] = std::minmax_element(values.begin() + static_cast<std::ptrdiff_t>(begin),
                                                        values.begin() + static_cast<std::ptrdiff_t>(end));
      EXPECT_EQ(low, *least);
      EXPECT_EQ(high, *largest);
    }
  }
  EXPECT_EQ(rows.front(), 0U);
  EXPECT_EQ(rows.back(), count - 1);
}

TEST(Thinned, AGapStaysAGap) {
  std::vector<double> x(10000);
  for (std::size_t k = 0; k < x.size(); ++k) {
    x[k] = static_cast<double>(k);
  }
  std::vector<double> y(x.size(), 1.0);
  y[5432] = not_a_number;
  const auto rows = thinned(x, y, 50);
  EXPECT_NE(std::ranges::find(rows, 5432U), rows.end());
}

TEST(Thinned, FewRowsStayAsTheyAre) {
  EXPECT_TRUE(thinned({}, {}, 10).empty());
  const std::vector<double> three{1.0, 2.0, not_a_number};
  EXPECT_EQ(thinned(three, three, 0).size(), 3U);
  EXPECT_EQ(thinned(three, std::vector<double>{1.0}, 5).size(), 1U);
}

TEST(Thinned, SignalsOfStepsAreFound) {
  std::vector<double> command(1000, 0.0);
  std::fill(command.begin() + 500, command.end(), 20.0);
  EXPECT_TRUE(is_of_steps(command));
  command[10] = 0.5;
  EXPECT_FALSE(is_of_steps(command)) << "a number with a fraction may be anything between";
  EXPECT_TRUE(is_of_steps(std::vector{0.0, 1.0, 0.0, 1.0, not_a_number})) << "a truth value that changes each time";
  EXPECT_FALSE(is_of_steps(std::vector{0.0, 1.0, 2.0, 3.0})) << "a counter is a ramp";
}

}  // namespace
}  // namespace hysteron::plots
