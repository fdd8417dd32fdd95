// Example 2: which of the four fits find the map, and which leaves it.
#include "examples/02_procedure_1/procedure_1.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace hysteron::examples {
namespace {

void expect_map(const NamedFit& got, const StaticMap& wanted, double relative) {
  SCOPED_TRACE(got.name);
  EXPECT_TRUE(got.fit.converged()) << got.fit.message;
  EXPECT_NEAR(got.fit.map.C1, wanted.C1, relative * wanted.C1);
  EXPECT_NEAR(got.fit.map.C2, wanted.C2, relative * wanted.C2);
  EXPECT_NEAR(got.fit.map.C3, wanted.C3, relative * wanted.C3);
}

TEST(Procedure1, PointsOfTheLoopLieOnTheMap) {
  const MapPoints points = points_from_loop(0.0);
  ASSERT_GT(points.p.size(), 1000U);
  for (std::size_t i = 0; i < points.p.size(); ++i) {
    EXPECT_NEAR(points.M[i], loop_map()(points.p[i]), 1e-11 * 1.05e-8);
  }
}

TEST(Procedure1, OnTheExactLoopAllButThePrintedFormFindTheMap) {
  const auto fits = four_fits(points_from_loop(0.0), loop_map());
  for (std::size_t i = 1; i < fits.size(); ++i) {
    expect_map(fits[i], loop_map(), 1e-7);
  }
  EXPECT_FALSE(fits[0].fit.converged());
  EXPECT_GT(std::fabs(fits[0].fit.map.C3 - 1.0), 0.3);
}

TEST(Procedure1, OnTheNoisyLoopTheLogarithmIsBiased) {
  const auto fits = four_fits(points_from_loop(1e-9), loop_map());
  expect_map(fits[2], loop_map(), 0.03);
  expect_map(fits[3], loop_map(), 0.03);
  // noise above M - C1 counts more in the logarithm than noise below it: the weighted form converges, but elsewhere
  EXPECT_TRUE(fits[1].fit.converged());
  EXPECT_LT(fits[1].fit.map.C3, 0.9);
  EXPECT_GT(fits[1].fit.rms, 1.1 * fits[2].fit.rms);
  // variable projection and Ipopt solve the same least-squares problem
  EXPECT_NEAR(fits[2].fit.map.C3, fits[3].fit.map.C3, 1e-6);
  EXPECT_NEAR(fits[2].fit.rms, fits[3].fit.rms, 1e-9 * fits[2].fit.rms);
  // and no other map of the family lies nearer to the points
  EXPECT_LE(fits[2].fit.rms, fits[0].fit.rms);
}

TEST(Procedure1, AsPrintedLeavesTheTruthOnExactPoints) {
  const auto fits = four_fits(counterexample(), counterexample_map);
  ASSERT_EQ(fits[0].fit.history.size(), 20U);
  EXPECT_NEAR(fits[0].fit.map.C3, 0.033, 0.0005);
  for (std::size_t i = 1; i < fits.size(); ++i) {
    expect_map(fits[i], counterexample_map, 1e-7);
  }
  const auto& weighted = fits[1].fit.history;
  const auto near = std::ranges::find_if(
      weighted, [](const StaticMapRound& round) { return std::fabs(round.map.C3 - counterexample_map.C3) < 1e-9; });
  EXPECT_LT(near - weighted.begin(), 500);
}

}  // namespace
}  // namespace hysteron::examples
