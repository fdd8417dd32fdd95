// What a verdict leaves, in units of what may be noise.
#include "diagnosis/noise/remainder.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "diagnosis/policy.hpp"
#include "tests/diagnosis/simulated_machine.hpp"

namespace hysteron::diagnosis {
namespace {

constexpr std::size_t samples = 6000;

/// White noise of so many floors.
VectorXd white(double floors) {
  const std::vector<double> values = test::Noise(11).white(samples, floors);
  return Eigen::Map<const VectorXd>(values.data(), std::ssize(values));
}

TEST(PossibleNoise, AsMuchAsTheFloorCanHaveMissed) {
  const auto of = [](const char* evidence, double floors) {
    return possible_noise({.value = 1.0, .evidence = evidence}, white(floors), {samples});
  };
  EXPECT_NEAR(of("differences", 2.5), 2.5, 0.1);  // all of it has been there from sample to sample
  EXPECT_EQ(of("differences", 8.0), 3.0);
  EXPECT_NEAR(of("dwells", 1.3), 1.3, 0.05);
  EXPECT_EQ(of("dwells", 8.0), policy::hidden_noise.value);
  EXPECT_EQ(of("repeats", 8.0), 1.0);
  EXPECT_NEAR(of("dwells", 0.7), 0.7, 0.03);  // the rest goes on in dwells, and is slower than noise
  EXPECT_EQ(of("dwells", 0.3), 0.5);
  EXPECT_EQ(of("repeats", 0.1), 0.5);
}

TEST(PossibleNoise, OfAShortRecord) {
  const VectorXd few = white(1.0).head(100);
  EXPECT_GT(possible_noise({.value = 1.0, .evidence = "differences"}, few, {100}), 1.5);
  EXPECT_EQ(possible_noise({.value = 1.0, .evidence = "dwells"}, few, {100}), 1.0);
}

TEST(Excess, IsTheEnergyBeyondWhatIsSuspicious) {
  EXPECT_EQ(excess_of(0.0), 0.0);
  EXPECT_EQ(excess_of(policy::suspicious.value), 0.0);
  EXPECT_NEAR(excess_of(2.0 * policy::suspicious.value), 0.75, 1e-12);
}

TEST(UnknownScore, IsHigherWhereSeveralSetsLeaveTooMuchAlike) {
  const Remainder much{.size = 3.0, .open = 0.01, .excess = 0.8};
  const double named = unknown_score(much, 1.0);
  EXPECT_NEAR(named, 0.8 * std::pow(0.01, 0.25), 1e-12);
  const double one_of_two = unknown_score(much, 0.5);
  EXPECT_NEAR(1.0 - one_of_two, (1.0 - named) * (1.0 - 0.5 * 0.8), 1e-12);
  EXPECT_GT(unknown_score(much, 0.1), one_of_two);
  EXPECT_LE(unknown_score({.size = 1e6, .open = 1.0, .excess = 1.0}, 0.0), 1.0);
}

TEST(UnknownScore, OfNoiseIsNoneHoweverManySetsExplainTheRest) {
  EXPECT_EQ(unknown_score({.size = 1.0, .open = 0.5, .excess = 0.0}, 0.1), 0.0);
}

}  // namespace
}  // namespace hysteron::diagnosis
