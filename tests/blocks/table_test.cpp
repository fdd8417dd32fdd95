// The table: exact at its points, straight between them, the same as a search from the left.
#include "blocks/table.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/blocks/stepper.hpp"

namespace hysteron::testing {
namespace {

using TableParams = Table::Params<double>;

/// count points with X at uneven distances and Y = shape(X).
template <class Shape>
TableParams curve(int count, Shape shape) {
  TableParams params{};
  double x = -1.0;
  for (int i = 0; i < count; ++i) {
    const auto index = static_cast<std::size_t>(i);
    params.X[index] = x;
    params.Y[index] = shape(x);
    x += 0.05 + 0.1 * (i % 3);
  }
  params.COUNT = count;
  return params;
}

double search_from_the_left(const TableParams& params, double x) {
  std::size_t i = 0;
  while (i + 2 < static_cast<std::size_t>(params.COUNT) && x >= params.X[i + 1]) {
    ++i;
  }
  const double share = (x - params.X[i]) / (params.X[i + 1] - params.X[i]);
  return (1.0 - share) * params.Y[i] + share * params.Y[i + 1];
}

TEST(Table, ReproducesAStraightLineAndEveryPointOfACurve) {
  for (int count = 2; count <= 32; ++count) {
    Stepper<Table> line(1.0, curve(count, [](double x) { return 3.0 * x - 1.0; }));
    Stepper<Table> cubic(1.0, curve(count, [](double x) { return x * x * x; }));
    const auto& params = cubic.params;
    const double last = params.X[static_cast<std::size_t>(count - 1)];
    for (double x = -1.0; x <= last; x += 0.01) {
      EXPECT_NEAR(line({.XIN = x}).XOUT, 3.0 * x - 1.0, 1e-13);
    }
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
      EXPECT_EQ(cubic({.XIN = params.X[i]}).XOUT, params.Y[i]);
    }
  }
}

TEST(Table, BisectionFindsWhatASearchFromTheLeftFinds) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> anywhere(-2.0, 6.0);
  for (int count = 2; count <= 32; ++count) {
    TableParams params = curve(count, [](double x) { return std::sin(3.0 * x); });
    params.EXTRAPOLATE = true;
    Stepper<Table> table(1.0, params);
    for (int k = 0; k < 300; ++k) {
      const double x = anywhere(random);
      EXPECT_NEAR(table({.XIN = x}).XOUT, search_from_the_left(params, x), 1e-12) << count << " points at " << x;
    }
  }
}

TEST(Table, EndsHoldUnlessExtrapolated) {
  TableParams params = curve(4, [](double x) { return 2.0 * x; });
  Stepper<Table> held(1.0, params);
  EXPECT_EQ(held({.XIN = -100.0}).XOUT, params.Y[0]);
  EXPECT_EQ(held({.XIN = 100.0}).XOUT, params.Y[3]);
  params.EXTRAPOLATE = true;
  Stepper<Table> extrapolated(1.0, params);
  EXPECT_NEAR(extrapolated({.XIN = -100.0}).XOUT, -200.0, 1e-11);
  EXPECT_NEAR(extrapolated({.XIN = 100.0}).XOUT, 200.0, 1e-11);
}

TEST(Table, RefusesPointsThatDoNotRise) {
  TableParams params = curve(8, [](double x) { return x; });
  params.X[5] = params.X[4];
  Stepper<Table> flat(1.0, params);
  const auto out = flat({.XIN = 0.0});
  EXPECT_TRUE(out.ERROR);
  EXPECT_EQ(out.ERRORID, fault::points_not_rising);
  EXPECT_EQ(out.XOUT, 0.0);

  params.COUNT = 5;  // the bad point is no longer counted
  Stepper<Table> shorter(1.0, params);
  EXPECT_FALSE(shorter({.XIN = 0.0}).ERROR);

  for (const int count : {-3, 0, 1, 33}) {
    params.COUNT = count;
    Stepper<Table> wrong_count(1.0, params);
    EXPECT_TRUE(wrong_count({.XIN = 0.0}).ERROR) << count;
  }
  params.COUNT = 5;
  params.X[2] = not_a_number;
  Stepper<Table> no_number(1.0, params);
  EXPECT_TRUE(no_number({.XIN = 0.0}).ERROR);
}

TEST(Table, NoticesWhilstRunningThatThePairInUseDoesNotRise) {
  Stepper<Table> table(1.0, curve(4, [](double x) { return x; }));
  const double between = 0.5 * (table.params.X[1] + table.params.X[2]);
  EXPECT_FALSE(table({.XIN = between}).ERROR);
  table.params.X[2] = table.params.X[3];
  table.params.X[3] = table.params.X[1];
  EXPECT_TRUE(table({.XIN = table.params.X[2]}).ERROR);
}

}  // namespace
}  // namespace hysteron::testing
