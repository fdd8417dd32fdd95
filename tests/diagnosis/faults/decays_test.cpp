// Sums of decays in a signal.
#include "diagnosis/faults/decays.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "tests/diagnosis/simulated_machine.hpp"

namespace hysteron::diagnosis {
namespace {

using ::testing::ElementsAre;

Signal decaying(std::size_t count, double time_constant, const std::vector<std::pair<std::size_t, double>>& leaps) {
  Signal result(count, 0.0);
  for (const auto& [at, size] : leaps) {
    for (std::size_t k = at; k < count; ++k) {
      result[k] += size * std::exp(-static_cast<double>(k - at) / time_constant);
    }
  }
  return result;
}

TEST(Decays, AreFoundWithTheirSizesAndLeaveTheNoise) {
  Signal values = decaying(400, 12.0, {{30, 2.0}, {35, -1.5}, {200, 3.0}, {398, -4.0}});
  const Signal truth = values;
  test::Noise noise(4);
  for (double& value : values) {
    value += 0.05 * noise();
  }
  const std::vector<Signal> signals{values};
  const Train train = train_of(signals, 12.0, 6.0 * 0.05, 40);
  EXPECT_EQ(train.leaps, 4U);
  EXPECT_THAT(train.signals.at(0).leaps(), ElementsAre(30, 35, 200, 398));
  const Signal sum = train.signals.at(0).sum();
  for (std::size_t k = 0; k < sum.size(); ++k) {
    EXPECT_NEAR(sum[k], truth[k], 0.2) << k;
  }
  EXPECT_NEAR(train.left, 400.0 * 0.05 * 0.05, 0.2);
  EXPECT_DOUBLE_EQ(train.penalised, train.left + 4.0 * 0.3 * 0.3);
}

TEST(Decays, AreTheLeastSquaresOfAllLeapsTogether) {
  constexpr double pole = 0.8;
  test::Noise noise(7);
  Signal values(60);
  for (double& value : values) {
    value = noise();
  }
  Decays decays(values, pole);
  const std::vector<std::size_t> leaps{17, 3, 40, 18, 59};  // in no order, two of them neighbours, one at the end
  for (const std::size_t leap : leaps) {
    decays.add(leap);
  }
  // What least squares leaves is at right angles to each decay that it could have taken more of.
  const Signal sum = decays.sum();
  for (const std::size_t leap : leaps) {
    double product = 0.0;
    for (std::size_t k = leap; k < values.size(); ++k) {
      product += (values[k] - sum[k]) * std::pow(pole, static_cast<double>(k - leap));
    }
    EXPECT_NEAR(product, 0.0, 1e-12) << leap;
  }
  // And the sum is one of such decays: it leaps nowhere else.
  for (std::size_t k = 0; k < values.size(); ++k) {
    const double before = k == 0 ? 0.0 : pole * sum[k - 1];
    EXPECT_TRUE(std::abs(sum[k] - before) < 1e-12 || std::ranges::count(leaps, k) == 1) << k;
  }
}

TEST(Decays, OfSeveralSignalsShareTheirNumber) {
  const std::vector<Signal> signals{decaying(100, 5.0, {{10, 1.0}}), decaying(100, 5.0, {{20, 3.0}, {60, 2.0}})};
  const Train train = train_of(signals, 5.0, 1e-6, 2);
  EXPECT_EQ(train.leaps, 2U);
  EXPECT_THAT(train.signals[0].leaps(), ElementsAre());
  EXPECT_THAT(train.signals[1].leaps(), ElementsAre(20, 60));
  EXPECT_NEAR(train.left, 1.0 / (1.0 - std::exp(-2.0 / 5.0)), 1e-12) << "of the third";
}

TEST(Decays, OfNothingAreNone) {
  const std::vector<Signal> silence{Signal(50, 0.0)};
  const Train train = train_of(silence, 5.0, 1.0, 10);
  EXPECT_EQ(train.leaps, 0U);
  EXPECT_EQ(train.left, 0.0);
}

}  // namespace
}  // namespace hysteron::diagnosis
