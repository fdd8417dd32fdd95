#include "diagnosis/evidence/shapley.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <bit>
#include <numeric>
#include <random>

namespace hysteron::diagnosis {
namespace {

using testing::DoubleNear;
using testing::Each;
using testing::ElementsAre;
using testing::Ge;

TEST(Shapley, WhatAddsUpIsSharedAsItIs) {
  const auto closed = [](std::size_t chosen) {
    return ((chosen & 1U) != 0 ? 0.5 : 0.0) + ((chosen & 2U) != 0 ? 0.3 : 0.0);
  };
  EXPECT_THAT(shapley_shares(2, closed), ElementsAre(DoubleNear(0.5, 1e-12), DoubleNear(0.3, 1e-12)));
}

TEST(Shapley, TwoThatCloseTheSameHaveHalfOfItEach) {
  EXPECT_THAT(shapley_shares(2, [](std::size_t) { return 0.8; }), Each(DoubleNear(0.4, 1e-12)));
}

// One alone predicts unseen stretches five times worse than nothing does; beside the other it closes a part.
TEST(Shapley, WhatHarmsByItselfClosesNothingByItself) {
  const auto closed = [](std::size_t chosen) { return chosen == 1 ? 0.3 : chosen == 2 ? -4.8 : 0.5; };
  EXPECT_THAT(shapley_shares(2, closed), ElementsAre(DoubleNear(0.4, 1e-12), DoubleNear(0.1, 1e-12)));
}

TEST(Shapley, WhatHarmsAllHasNoShare) {
  const auto closed = [](std::size_t chosen) { return (chosen & 2U) != 0 ? -1.0 : 0.6; };
  EXPECT_THAT(shapley_shares(2, closed), ElementsAre(DoubleNear(0.6, 1e-12), 0.0));
}

TEST(Shapley, SharesAreNeverNegativeAndSumToWhatTheBestClose) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> any(-3.0, 1.0);
  for (int round = 0; round < 200; ++round) {
    const std::size_t count = 1 + static_cast<std::size_t>(round) % 4;
    std::vector<double> closed(std::size_t{1} << count, 0.0);
    std::generate(closed.begin() + 1, closed.end(), [&] { return any(random); });
    const std::vector<double> shares = shapley_shares(count, [&](std::size_t chosen) { return closed[chosen]; });
    EXPECT_THAT(shares, Each(Ge(-1e-12)));
    EXPECT_NEAR(std::accumulate(shares.begin(), shares.end(), 0.0), std::ranges::max(closed), 1e-12);
  }
}

TEST(Shapley, NobodyHasNothing) {
  EXPECT_TRUE(shapley_shares(0, [](std::size_t) { return 1.0; }).empty());
}

}  // namespace
}  // namespace hysteron::diagnosis
