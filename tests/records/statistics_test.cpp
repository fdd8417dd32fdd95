// What the numbers of a record say: whether one column makes a loop over another.
#include "records/statistics.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "support/numbers.hpp"

namespace hysteron::records {
namespace {

std::vector<double> sine(double phase) {
  std::vector<double> values(2000);
  for (std::size_t k = 0; k < values.size(); ++k) {
    values[k] = std::sin(0.01 * static_cast<double>(k) - phase);
  }
  return values;
}

TEST(LoopWidth, OfAPlayIsItsWidth) {
  const auto u = sine(0.0);
  std::vector<double> y(u.size());
  double play = 0.0;
  for (std::size_t k = 0; k < u.size(); ++k) {
    play = std::min(std::max(play, u[k] - 0.1), u[k] + 0.1);
    y[k] = 5.0 * play;
  }
  // 2·0.1 apart, of a range of 2·0.9; less at the ends, where the branches meet.
  EXPECT_NEAR(loop_width(u, y), 0.2 / 1.8, 0.02);
}

TEST(LoopWidth, OfAFunctionIsNothing) {
  const auto u = sine(0.0);
  std::vector<double> y(u.size());
  std::ranges::transform(u, y.begin(), [](double value) { return value * value * value; });
  EXPECT_LT(loop_width(u, y), 0.01);
  EXPECT_GT(loop_width(u, sine(0.3)), 0.1) << "a lag opens a loop";
}

TEST(LoopWidth, OfWhatCannotShowOneIsNothing) {
  const std::vector<double> ramp{0.0, 1.0, 2.0, 3.0};
  EXPECT_EQ(loop_width({}, {}), 0.0);
  EXPECT_EQ(loop_width(ramp, ramp), 0.0);
  EXPECT_EQ(loop_width(std::vector<double>(50, 1.0), sine(0.0)), 0.0);
  auto broken = sine(0.3);
  broken[7] = not_a_number;
  EXPECT_TRUE(std::isfinite(loop_width(sine(0.0), broken)));
}

}  // namespace
}  // namespace hysteron::records
