#include "diagnosis/findings/next_record.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace hysteron::diagnosis {
namespace {

HeldOut blocks_of(const std::vector<double>& rms) {
  HeldOut result;
  for (const double one : rms) {
    result.squares.push_back(one * one * 100.0);
    result.counts.push_back(100.0);
  }
  return result;
}

TEST(NextRecord, EqualBlocksLeaveNoDoubt) {
  const auto next = next_record(blocks_of({0.5, 0.5, 0.5, 0.5}), 0.0, 2.0);
  ASSERT_TRUE(next);
  EXPECT_NEAR(next->rms, 1.0, 1e-12);
  EXPECT_NEAR(next->low, 1.0, 1e-12);
  EXPECT_NEAR(next->high, 1.0, 1e-12);
}

TEST(NextRecord, ScalesWithItsUnit) {
  const HeldOut blocks = blocks_of({0.5, 0.7, 0.4, 1.1});
  const auto one = next_record(blocks, 0.0, 1.0);
  const auto thousand = next_record(blocks, 0.0, 1000.0);
  EXPECT_NEAR(thousand->low, 1000.0 * one->low, 1e-9);
  EXPECT_NEAR(thousand->high, 1000.0 * one->high, 1e-9);
  EXPECT_LT(one->low, one->rms);
  EXPECT_GT(one->high, one->rms);
}

TEST(NextRecord, TooFewBlocksSayNothing) {
  EXPECT_FALSE(next_record(blocks_of({0.5, 0.7}), 0.0, 1.0));
  EXPECT_FALSE(next_record(blocks_of({0.0, 0.0, 0.0, 0.0}), 0.0, 1.0));
}

TEST(NextRecord, ABlockAtRestCountsWithItsNoise) {
  const auto moving = next_record(blocks_of({0.9, 1.3, 0.7, 1.1}), 0.1, 1.0);
  const auto rested = next_record(blocks_of({0.9, 1.3, 0.7, 1.1, 1e-9}), 0.1, 1.0);
  const auto noise = next_record(blocks_of({0.9, 1.3, 0.7, 1.1, 0.1}), 0.1, 1.0);
  EXPECT_DOUBLE_EQ(rested->low, noise->low);
  EXPECT_DOUBLE_EQ(rested->high, noise->high);
  EXPECT_LT(rested->low, moving->low);
  EXPECT_DOUBLE_EQ(next_record(blocks_of({0.9, 1.3, 0.7, 1.1}), 0.0, 1.0)->high, moving->high);
}

/// A noise that was taken for three times as large had put the RMS below its own interval.
TEST(NextRecord, LiesInItsOwnInterval) {
  const std::vector<double> rms{0.9, 1.3, 0.7, 1.1, 0.8};
  const auto next = next_record(blocks_of(rms), 3.0, 1.0);
  const auto without = next_record(blocks_of(rms), 0.0, 1.0);
  EXPECT_DOUBLE_EQ(next->low, without->low);
  EXPECT_DOUBLE_EQ(next->high, without->high);
  for (const double noise : {0.0, 0.5, 1.0, 10.0}) {
    for (const double large : {0.01, 1.0, 1e6}) {
      const auto one = next_record(blocks_of({1.0, 1.0, 1.1, large}), noise, 2.0);
      EXPECT_LE(one->low, one->rms) << noise << ' ' << large;
      EXPECT_GE(one->high, one->rms) << noise << ' ' << large;
    }
  }
}

/// Of log-normal blocks, 95 of 100 further ones lie in the interval.
TEST(NextRecord, HoldsWhatItPromises) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal(0.0, 0.4);
  int inside = 0;
  constexpr int trials = 4000;
  for (int k = 0; k < trials; ++k) {
    std::vector<double> rms(12);
    for (double& one : rms) {
      one = std::exp(normal(random));
    }
    const auto next = next_record(blocks_of(rms), 0.0, 1.0);
    const double further = std::exp(normal(random));
    inside += next->low <= further && further <= next->high ? 1 : 0;
  }
  EXPECT_NEAR(static_cast<double>(inside) / trials, 0.95, 0.015);
}

}  // namespace
}  // namespace hysteron::diagnosis
