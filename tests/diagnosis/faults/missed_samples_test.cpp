// Missed samples: runs that repeat the last value are found, and what only looks alike is not.
#include "diagnosis/faults/missed_samples.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "tests/diagnosis/faults/logged.hpp"

namespace hysteron::diagnosis {
namespace {

using testing::IsEmpty;
using testing::IsSupersetOf;

constexpr std::size_t count = 4000;

/// Two sines: there is a slope nearly everywhere.
std::vector<double> two_sines() {
  std::vector<double> values(count);
  for (std::size_t k = 0; k < count; ++k) {
    const auto t = static_cast<double>(k);
    values[k] = 20.0 * std::sin(0.02 * t) + 8.0 * std::sin(0.057 * t);
  }
  return values;
}

/// Every 50th sample a run of 1 to 4; what was held.
std::vector<std::size_t> hold_some(std::vector<double>& values) {
  std::vector<std::size_t> held;
  for (std::size_t k = 25; k + 10 < values.size(); k += 50) {
    for (std::size_t i = 1; i <= 1 + k / 50 % 4; ++i) {
      values[k + i] = values[k];
      held.push_back(k + i);
    }
  }
  return held;
}

TEST(MissedSamples, AreFoundWhereTheSignalMovesStraight) {
  auto values = two_sines();
  const auto held = hold_some(values);
  const MissedSamples found = find_missed_samples(test::experiments_of(test::noisy(values, 0.01, 7)), 0);
  EXPECT_GT(found.rows.size(), 0.6 * static_cast<double>(held.size()));
  EXPECT_THAT(held, IsSupersetOf(found.rows));
  EXPECT_EQ(found.longest, 4U);
}

TEST(MissedSamples, ThoseInABendShowBesideTheModel) {
  const auto moved = two_sines();
  auto values = moved;
  const auto held = hold_some(values);
  const auto experiments = test::experiments_of(test::noisy(values, 0.01, 7));
  const MissedSamples clear = find_missed_samples(experiments, 0);
  std::vector<double> modelled = moved;
  for (double& value : modelled) {
    value *= 1.02;  // a gain that is off
  }
  const MissedSamples found = with_model(clear, experiments, 0, modelled);
  EXPECT_GT(found.rows.size(), clear.rows.size());
  // What is left is less than the noise beside what was missed.
  double left = 0.0;
  double all = 0.0;
  for (const std::size_t row : held) {
    const double error = std::pow(values[row] - moved[row], 2);
    all += error;
    left += std::ranges::binary_search(found.rows, row) ? 0.0 : error;
  }
  EXPECT_LT(left, 0.001 * all);
  EXPECT_NEAR(found.rms, std::sqrt(all / count), 0.05 * found.rms);
}

TEST(MissedSamples, OfAFewNothingIsSaid) {
  auto values = two_sines();
  for (const std::size_t k : {100U, 900U, 1700U}) {
    values[k + 1] = values[k + 2] = values[k];
  }
  EXPECT_THAT(find_missed_samples(test::experiments_of(test::noisy(values, 0.01, 7)), 0).rows, IsEmpty());
}

TEST(MissedSamples, AQuantizerMissesNone) {
  for (const double quantum : {0.05, 0.1, 0.2, 0.3, 0.5, 1.0, 2.0}) {
    auto values = two_sines();
    for (double& value : values) {
      value = quantum * std::round(value / quantum);
    }
    EXPECT_THAT(find_missed_samples(test::experiments_of(test::noisy(values, 0.01, 7)), 0).rows, IsEmpty()) << quantum;
  }
}

TEST(MissedSamples, NoiseStepsAndStandstillAreNone) {
  EXPECT_THAT(find_missed_samples(test::experiments_of(test::Noise(3).white(count, 1.0)), 0).rows, IsEmpty());
  std::vector<double> steps(count);
  std::vector<double> stick_slip(count);  // stands until the spring has gathered, then jumps and goes on
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t tread = k / 40;
    steps[k] = 10.0 * static_cast<double>(tread) * (1.0 - std::exp(-0.3 * static_cast<double>(k % 40)));
    stick_slip[k] = 3.0 * static_cast<double>(tread);
  }
  EXPECT_THAT(find_missed_samples(test::experiments_of(test::noisy(steps, 0.01, 7)), 0).rows, IsEmpty());
  EXPECT_THAT(find_missed_samples(test::experiments_of(test::noisy(stick_slip, 0.01, 7)), 0).rows, IsEmpty());
}

TEST(MissedSamples, AFewBehindARoundingShowBesideTheModel) {
  const auto moved = two_sines();
  auto values = moved;
  std::vector<std::size_t> held;
  for (std::size_t k = 50; k + 5 < count && held.size() < 40; ++k) {
    if (std::abs(moved[k + 5] - moved[k]) > 3.0) {  // steep: ten of them, fewer than would show by themselves
      for (std::size_t i = 1; i <= 4; ++i) {
        values[k + i] = values[k];
        held.push_back(k + i);
      }
      k += 150;
    }
  }
  const auto experiments = test::experiments_of(test::rounded(values, 0.3));
  EXPECT_THAT(find_missed_samples(experiments, 0).rows, IsEmpty());
  const MissedSamples found = find_missed_samples(experiments, 0, moved, 0.1);
  EXPECT_GE(found.rows.size(), held.size() / 2);
  // The rounding may hide that the first of a run has moved, and nothing more.
  EXPECT_LE(
      std::ranges::count_if(found.rows, [&](std::size_t row) { return std::ranges::find(held, row) == held.end(); }),
      static_cast<std::ptrdiff_t>(held.size() / 4));
}

TEST(MissedSamples, BesideAModelRoundingAndALateSensorAreNone) {
  const auto moved = two_sines();
  for (const double quantum : {0.05, 0.1, 0.2, 0.3, 0.5, 1.0, 2.0}) {
    EXPECT_THAT(
        find_missed_samples(test::experiments_of(test::noisy(test::rounded(moved, quantum), 0.01, 7)), 0, moved, 0.01)
            .rows,
        IsEmpty())
        << quantum;
  }
  std::vector<double> steps(count);
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t tread = k / 40;
    steps[k] = 10.0 * static_cast<double>(tread * 7 % 5);
  }
  std::vector<double> late(count, 0.0);
  std::copy(steps.begin(), steps.end() - 3, late.begin() + 3);
  EXPECT_THAT(find_missed_samples(test::experiments_of(test::noisy(late, 0.01, 7)), 0, steps, 0.01).rows, IsEmpty());
}

/// To levels that lie unevenly, as a converter's do.
std::vector<double> rounded_unevenly(std::vector<double> values, double quantum) {
  for (double& value : values) {
    const double level = std::floor(value / quantum);
    value = quantum * (level + 0.5 + 0.4 * std::sin(2.4 * level * level));
  }
  return values;
}

TEST(MissedSamples, StairsOfUnevenWidthsAreNone) {
  const auto moved = two_sines();
  const auto measured = [&](double quantum) {
    return test::experiments_of(test::noisy(rounded_unevenly(moved, quantum), 0.01, 7));
  };
  for (const double quantum : {0.5, 1.0, 2.0, 4.0}) {
    EXPECT_THAT(find_missed_samples(measured(quantum), 0).rows, IsEmpty()) << quantum;
  }
  // Where the signal takes a level in one sample or two, as at 1.0, a tread beside a model looks like a missed sample.
  for (const double quantum : {2.0, 4.0}) {
    EXPECT_THAT(find_missed_samples(measured(quantum), 0, moved, 0.01).rows, IsEmpty()) << quantum;
  }
}

}  // namespace
}  // namespace hysteron::diagnosis
