// Changes that add up, against residuals that were made from them.
#include "diagnosis/search/superposition.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "diagnosis/search/pairing.hpp"
#include "tests/diagnosis/simulated_machine.hpp"

namespace hysteron::diagnosis {
namespace {

constexpr Index rows = 400;
constexpr Index instants = 20;

/// What a step at a row does to a high pass: it is forgotten within some ten rows.
VectorXd step_response(Index at) {
  VectorXd values = VectorXd::Zero(rows);
  for (Index k = at; k < rows; ++k) {
    values[k] = std::exp(-0.2 * static_cast<double>(k - at));
  }
  return values;
}

MatrixXd steps() {
  MatrixXd matrix(rows, instants);
  for (Index k = 0; k < instants; ++k) {
    matrix.col(k) = step_response(19 * k + 3);
  }
  return matrix;
}

VectorXd wave(double turns, double phase) {
  return VectorXd::NullaryExpr(rows, [&](Index k) {
    return std::sin(test::two_pi * turns * static_cast<double>(k) / static_cast<double>(rows) + phase);
  });
}

TEST(Superposition, FindsWhereAnIntervalBeginsAndEnds) {
  const MatrixXd changes = steps();
  const Background background(-0.7 * (changes.col(5) - changes.col(12)), Projection(wave(1.0, 0.0)));
  const auto found = Superposition(changes, background).intervals(3);
  ASSERT_EQ(found.size(), 3U);
  EXPECT_EQ(found[0].begin, 5);
  EXPECT_EQ(found[0].end, 12);
  EXPECT_NEAR(found[0].size, 0.7, 1e-12);
  EXPECT_NEAR(found[0].gain, background.unexplained(), 1e-12);
  EXPECT_LT(found[1].gain, 0.9 * found[0].gain);
}

TEST(Superposition, AnIntervalNeedNotEnd) {
  const MatrixXd changes = steps();
  const Background background(0.2 * changes.col(9), Projection(wave(1.0, 0.0)));
  const auto found = Superposition(changes, background).intervals(1);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].begin, 9);
  EXPECT_EQ(found[0].end, instants);
  EXPECT_NEAR(found[0].size, -0.2, 1e-12);
}

TEST(Superposition, StepsThatDoNothingMakeNoInterval) {
  const Background background(wave(3.0, 0.0), Projection(wave(1.0, 0.0)));
  EXPECT_TRUE(Superposition(MatrixXd::Zero(rows, instants), background).intervals(3).empty());
}

TEST(Superposition, APairOfWhichNeitherIsBestByItselfComesFirst) {
  MatrixXd changes(rows, 4);
  changes.col(0) = wave(5.0, 0.0);
  changes.col(1) = wave(8.0, 1.0);
  changes.col(2) = wave(5.0, 0.3) + wave(8.0, 1.4);  // like the sum of both, and by itself the best of all
  changes.col(3) = wave(13.0, 0.0);
  // A part of it is what the known parameters do, and nobody's gain.
  const VectorXd known = wave(1.0, 0.2);
  const Background background(-(0.8 * changes.col(0) + 1.3 * changes.col(1)) + 4.0 * known, Projection(known));
  const auto found = Superposition(changes, background).pairs(5.0);
  ASSERT_EQ(found.size(), 6U);
  EXPECT_EQ(found[0].first, 0);
  EXPECT_EQ(found[0].second, 1);
  EXPECT_NEAR(found[0].gain, background.unexplained(), 1e-6 * background.unexplained());
  EXPECT_LT(found[1].gain, 0.99 * found[0].gain);
}

TEST(Superposition, APairTakesNoChangeFarFromItsSize) {
  MatrixXd changes(rows, 2);
  changes << wave(5.0, 0.0), wave(8.0, 0.0);
  const Background background(100.0 * changes.col(0) - changes.col(1), Projection(wave(1.0, 0.0)));
  const auto found = Superposition(changes, background).pairs(5.0);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_LT(found[0].gain, 0.0);  // the first would have to turn round
}

TEST(Superposition, OneChangeTwiceIsNoPair) {
  MatrixXd changes(rows, 2);
  changes << wave(5.0, 0.0), 2.0 * wave(5.0, 0.0);
  const Background background(wave(5.0, 0.0), Projection(wave(1.0, 0.0)));
  EXPECT_TRUE(Superposition(changes, background).pairs(5.0).empty());
}

TEST(Pairs, AreNotAllWithTheOneThatIsBestByItself) {
  const std::vector<std::string> effects{"backlash", "lag", "load", "creep", "delay", "load"};
  std::vector<Superposition::Pair> ranked;
  for (Index other = 1; other < 6; ++other) {
    ranked.push_back({.first = 0, .second = other, .gain = 20.0 - static_cast<double>(other)});
  }
  ranked.push_back({.first = 2, .second = 5, .gain = 3.0});  // a load and a load
  ranked.push_back({.first = 1, .second = 2, .gain = 2.0});
  ranked.push_back({.first = 1, .second = 5, .gain = 1.0});  // a lag and a load again
  std::vector<std::pair<Index, Index>> places;
  for (const Superposition::Pair& one : different_pairs(ranked, effects, 10)) {
    places.emplace_back(one.first, one.second);
  }
  EXPECT_EQ(places, (std::vector<std::pair<Index, Index>>{{0, 1}, {0, 2}, {0, 3}, {1, 2}}));
  EXPECT_EQ(different_pairs(ranked, effects, 2).size(), 2U);
}

}  // namespace
}  // namespace hysteron::diagnosis
