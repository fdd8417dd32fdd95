// What a set of effects closes on blocks that its fit did not see: known shares, and an interval that holds them.
#include "diagnosis/verdict/held_out.hpp"

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

/// With a floor that is known.
Closure share_closed(const HeldOut& before, const HeldOut& after, double floor, std::uint64_t seed) {
  const double squares = std::accumulate(after.squares.begin(), after.squares.end(), 0.0);
  const double count = std::accumulate(after.counts.begin(), after.counts.end(), 0.0);
  return closure(before, after, squares / count, {.low = floor, .likely = floor, .floor = floor, .high = floor}, seed);
}

TEST(Closure, OfKnownShares) {
  const HeldOut before = blocks_of(std::vector<double>(24, 9.0));
  EXPECT_DOUBLE_EQ(share_closed(before, blocks_of(std::vector<double>(24, 1.0)), 1.0, 1).closed, 1.0);
  EXPECT_DOUBLE_EQ(share_closed(before, blocks_of(std::vector<double>(24, 9.0)), 1.0, 1).closed, 0.0);
  EXPECT_DOUBLE_EQ(share_closed(before, blocks_of(std::vector<double>(24, 3.0)), 1.0, 1).closed, 0.75);
  EXPECT_DOUBLE_EQ(share_closed(before, blocks_of(std::vector<double>(24, 3.0)), 0.0, 1).closed, 1.0 - 3.0 / 9.0);
  EXPECT_LT(share_closed(before, blocks_of(std::vector<double>(24, 12.0)), 1.0, 1).closed, 0.0);  // worse than before
}

TEST(Closure, NothingWhereThereWasNoGap) {
  const HeldOut before = blocks_of(std::vector<double>(24, 0.9));
  EXPECT_EQ(share_closed(before, blocks_of(std::vector<double>(24, 0.5)), 1.0, 1).closed, 0.0);
}

TEST(Closure, EqualBlocksLeaveNoDoubt) {
  const Closure found =
      share_closed(blocks_of(std::vector<double>(24, 9.0)), blocks_of(std::vector<double>(24, 3.0)), 1.0, 1);
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
  const Closure one = share_closed(blocks_of(first), blocks_of(second), 1.0, 42);
  const Closure again = share_closed(blocks_of(first), blocks_of(second), 1.0, 42);
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
    const Closure found = share_closed(before, draw(2.0), 1.0, static_cast<std::uint64_t>(k));
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

TEST(GainScore, SeesWhatActsForAShortTimeOnly) {
  test::Noise noise(5);
  const auto values = noise.white(2400, 1.0);
  const VectorXd after = Eigen::Map<const VectorXd>(values.data(), 2400);
  VectorXd before = after;
  before.segment(300, 60).array() += 3.0;  // in one of 24 blocks, so that the mean of the blocks is no evidence
  EXPECT_GT(gain_score(before, after), 4.0);
  EXPECT_LT(gain_score(after, before), 0.0);
  std::vector<double> blocks_before;
  std::vector<double> blocks_after;
  for (Index k = 0; k < 24; ++k) {
    blocks_before.push_back(before.segment(100 * k, 100).squaredNorm() / 100.0);
    blocks_after.push_back(after.segment(100 * k, 100).squaredNorm() / 100.0);
  }
  EXPECT_LT(gain_bound(blocks_of(blocks_before), blocks_of(blocks_after)), 0.0);
}

TEST(GainScore, IsNoMoreThanChanceForAFitOfNoise) {
  test::Noise noise(6);
  int above = 0;
  for (int draw = 0; draw < 200; ++draw) {
    const auto first = noise.white(1000, 1.0);
    const auto second = noise.white(1000, 0.2);  // what fits to other noise move the output by
    const VectorXd before = Eigen::Map<const VectorXd>(first.data(), 1000);
    const VectorXd after = before + Eigen::Map<const VectorXd>(second.data(), 1000);
    above += gain_score(before, after) > 2.0 ? 1 : 0;
  }
  EXPECT_LE(above, 5) << "2.3 % of normal draws lie above 2, and a gain by chance is below 0 in the mean";
  EXPECT_EQ(gain_score(VectorXd::Ones(10), VectorXd::Ones(10)), 0.0);
}

TEST(Closure, ReachesFromTheLeastNoiseToTheMost) {
  const HeldOut before = blocks_of(std::vector<double>(24, 9.0));
  const HeldOut after = blocks_of(std::vector<double>(24, 1.44));
  const NoiseRange noise = noise_range(1.2);
  const Closure found = closure(before, after, 1.44, noise, 1);
  EXPECT_DOUBLE_EQ(found.closed, 1.0 - 0.44 / 8.0);
  // Equal blocks leave the doubt about the noise alone: 2.5 % of its draws lie below its range.
  EXPECT_NEAR(found.low, 1.0 - (1.44 - noise.low * noise.low) / (9.0 - noise.low * noise.low), 2e-3);
  EXPECT_GE(found.high, 1.0) << "all that is left may be slow noise";
  EXPECT_LE(found.high, 1.01);
  // The whole record's fit leaves no more than those of its halves.
  EXPECT_DOUBLE_EQ(closure(before, after, 1.0, {.low = 1.0, .likely = 1.0, .floor = 1.0, .high = 1.0}, 1).high, 1.0);
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
  const HeldOut left = by_blocks(task, held_out(task, explanation)).at(0);
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
