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

/// x follows u with a time constant, behind a dead time; in samples.
std::vector<double> lagged(const std::vector<double>& u, double time_constant, std::size_t dead_time) {
  std::vector<double> x;
  double state = 0.0;
  for (std::size_t k = 0; k < u.size(); ++k) {
    state += (1.0 - std::exp(-1.0 / time_constant)) * ((k < dead_time ? 0.0 : u[k - dead_time]) - state);
    x.push_back(state);
  }
  return x;
}

/// A heater that is switched every so often, to and fro at random, and rests before it answers. The model without the
/// dead time has taken a longer lag for it.
TEST(MissedSamples, BesideAModelWithoutItsDeadTimeAreNone) {
  for (const std::size_t every : {8U, 12U}) {
    for (const std::size_t dead_time : {2U, 3U}) {
      test::Noise random(5);
      std::vector<double> u;
      while (u.size() < count) {
        u.insert(u.end(), every, random.uniform() < 0.5 ? -1.0 : 1.0);
      }
      const auto measured = test::noisy(lagged(u, 4.0, dead_time), 0.005, 7);
      EXPECT_THAT(find_missed_samples(test::experiments_of(measured), 0, lagged(u, 10.0, 0), 0.005).rows, IsEmpty())
          << every << " " << dead_time;
    }
  }
}

/// The force of a damper that yields at once, and whose model is in proportion to the speed: it stands where the model
/// moves on, and leaps where the speed turns round.
TEST(MissedSamples, BesideAModelThatDoesNotYieldAreNone) {
  for (const double rate : {0.11, 0.2, 0.35}) {
    std::vector<double> speed;
    std::vector<double> force;
    double spring = 0.0;
    for (std::size_t k = 0; k < count; ++k) {
      const auto t = static_cast<double>(k);
      speed.push_back(3.0 * std::sin(rate * t) + 2.0 * std::sin(2.6 * rate * t + 1.0));
      spring = std::clamp(spring + 0.9 * speed.back(), -1.0, 1.0);
      force.push_back(3.0 * spring + 0.3 * speed.back());
    }
    for (double& value : speed) {
      value *= 1.3;  // the proportion that fits the force best
    }
    EXPECT_THAT(find_missed_samples(test::experiments_of(test::noisy(force, 0.1, 7)), 0, speed, 0.1).rows, IsEmpty())
        << rate;
  }
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
