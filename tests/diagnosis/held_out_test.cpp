// What a set of effects closes on blocks that its fit did not see: known shares, and an interval that holds them.
#include "diagnosis/held_out.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <numeric>

#include "tests/diagnosis/simulated_machine.hpp"

namespace hysteron::diagnosis {
namespace {

HeldOut blocks_of(const std::vector<double>& mean_squares, double count = 100.0) {
  HeldOut result;
  for (const double one : mean_squares) {
    result.squares.push_back(one * count);
    result.counts.push_back(count);
  }
  return result;
}

TEST(Closure, OfKnownShares) {
  const HeldOut before = blocks_of(std::vector<double>(24, 9.0));
  EXPECT_DOUBLE_EQ(closure(before, blocks_of(std::vector<double>(24, 1.0)), 1.0, 1).closed, 1.0);
  EXPECT_DOUBLE_EQ(closure(before, blocks_of(std::vector<double>(24, 9.0)), 1.0, 1).closed, 0.0);
  EXPECT_DOUBLE_EQ(closure(before, blocks_of(std::vector<double>(24, 3.0)), 1.0, 1).closed, 0.75);
  EXPECT_DOUBLE_EQ(closure(before, blocks_of(std::vector<double>(24, 3.0)), 0.0, 1).closed, 1.0 - 3.0 / 9.0);
  EXPECT_LT(closure(before, blocks_of(std::vector<double>(24, 12.0)), 1.0, 1).closed, 0.0);  // worse than before
}

TEST(Closure, NothingWhereThereWasNoGap) {
  const HeldOut before = blocks_of(std::vector<double>(24, 0.9));
  EXPECT_EQ(closure(before, blocks_of(std::vector<double>(24, 0.5)), 1.0, 1).closed, 0.0);
}

TEST(Closure, EqualBlocksLeaveNoDoubt) {
  const Closure found =
      closure(blocks_of(std::vector<double>(24, 9.0)), blocks_of(std::vector<double>(24, 3.0)), 1.0, 1);
  EXPECT_DOUBLE_EQ(found.low, 0.75);
  EXPECT_DOUBLE_EQ(found.high, 0.75);
}

TEST(Closure, IsTheSameForASeedAndOrdered) {
  test::Noise noise(4);
  std::vector<double> first;
  std::vector<double> second;
  for (int k = 0; k < 24; ++k) {
    first.push_back(8.0 + 4.0 * noise.uniform());
    second.push_back(1.0 + 2.0 * noise.uniform());
  }
  const Closure one = closure(blocks_of(first), blocks_of(second), 1.0, 42);
  const Closure again = closure(blocks_of(first), blocks_of(second), 1.0, 42);
  EXPECT_EQ(one.low, again.low);
  EXPECT_EQ(one.high, again.high);
  EXPECT_LT(one.low, one.closed);
  EXPECT_GT(one.high, one.closed);
}

/// Blocks with mean squares 9 and 2 in expectation, each from 40 normal samples: the share is 1 − 1/8.
TEST(Closure, IntervalHoldsTheTruthInMostDraws) {
  test::Noise noise(17);
  const auto draw = [&](double mean_square) {
    std::vector<double> blocks;
    for (int block = 0; block < 24; ++block) {
      const auto values = noise.white(40, std::sqrt(mean_square));
      blocks.push_back(std::inner_product(values.begin(), values.end(), values.begin(), 0.0) / 40.0);
    }
    return blocks_of(blocks, 40.0);
  };
  int held = 0;
  constexpr int draws = 200;
  for (int k = 0; k < draws; ++k) {
    const HeldOut before = draw(9.0);
    const Closure found = closure(before, draw(2.0), 1.0, static_cast<std::uint64_t>(k));
    held += found.low <= 0.875 && 0.875 <= found.high ? 1 : 0;
  }
  EXPECT_GE(held, 176);  // 88 %: 95 % less what a bootstrap of 24 blocks falls short, and three standard errors
  EXPECT_LT(held, draws);
}

TEST(GainBound, IsAboveZeroOnlyWhereMostBlocksGain) {
  std::vector<double> before;
  std::vector<double> better;
  std::vector<double> mixed;
  for (int k = 0; k < 24; ++k) {
    before.push_back(9.0 + 0.1 * (k % 5));
    better.push_back(3.0 + 0.1 * (k % 3));
    mixed.push_back(k == 0 ? 0.0 : 9.0 + 0.1 * (k % 5));  // one block alone gains
  }
  EXPECT_NEAR(gain_bound(blocks_of(before), blocks_of(better)), 6.1 / 9.2, 0.02);
  EXPECT_LT(gain_bound(blocks_of(before), blocks_of(mixed)), 0.0);
  EXPECT_EQ(gain_bound(blocks_of({1.0, 1.0}), blocks_of({0.1, 0.1})), 0.0);  // two blocks are no evidence
}

struct Fitted {
  Task task{};
  Explanation explanation{};
};

/// A stack with its constants refitted, on a record of a machine of the same structure.
Fitted fitted(double deviation) {
  Fitted result;
  result.task.records = {
      test::measured(test::program_of(test::stack()), test::record_of("U", test::rich_voltage()), deviation)};
  result.task.outputs = {"Y"};
  result.task.scales = {deviation};
  for (const auto& [path, start] : {std::pair("HYST.C1", 5.5), {"HYST.C2", 3.6}}) {
    result.task.known.push_back({.path = path, .start = start, .lower = 0.1, .upper = 50.0});
  }
  result.explanation.variant.text = test::stack();
  result.explanation.variant.program = std::make_shared<const Program>(compile_text(test::stack()));
  Model model(result.task, *result.explanation.variant.program);
  result.explanation.fit = fit(model, model.start());
  return result;
}

TEST(HeldOut, TheTruthLeavesTheNoise) {
  const auto [task, explanation] = fitted(0.05);
  const HeldOut left = held_out(task, explanation).at(0);
  const double count = std::accumulate(left.counts.begin(), left.counts.end(), 0.0);
  EXPECT_EQ(count, 2000.0);
  EXPECT_NEAR(std::accumulate(left.squares.begin(), left.squares.end(), 0.0) / count, 1.0, 0.1);
  // What is judged was not fitted, so it cannot be better than the fit.
  EXPECT_GE(std::accumulate(left.squares.begin(), left.squares.end(), 0.0), explanation.fit.residuals.squaredNorm());
}

TEST(ByBlocks, AddUpToTheWhole) {
  const auto [task, explanation] = fitted(0.05);
  const HeldOut whole = by_blocks(task, explanation.fit.residuals).at(0);
  EXPECT_NEAR(std::accumulate(whole.squares.begin(), whole.squares.end(), 0.0), explanation.fit.residuals.squaredNorm(),
              1e-8);
  for (const double count : whole.counts) {
    EXPECT_NEAR(count, 2000.0 / static_cast<double>(whole.counts.size()), 1.0);
  }
}

}  // namespace
}  // namespace hysteron::diagnosis
