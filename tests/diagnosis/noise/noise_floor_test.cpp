// The noise floor: from the measurement alone, by whatever evidence the record holds.
#include "diagnosis/noise/noise_floor.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "tests/diagnosis/simulated_machine.hpp"

namespace hysteron::diagnosis {
namespace {

constexpr double step = 0.005;

template <class Function>
std::vector<double> over_time(std::size_t count, const Function& function) {
  std::vector<double> values;
  for (std::size_t k = 0; k < count; ++k) {
    values.push_back(function(static_cast<double>(k) * step));
  }
  return values;
}

std::vector<double> sum(std::vector<double> a, const std::vector<double>& b) {
  for (std::size_t k = 0; k < a.size(); ++k) {
    a[k] += b[k];
  }
  return a;
}

std::vector<Experiment> experiment(std::vector<double> input, std::vector<double> output) {
  Experiment one;
  one.drive.steps = output.size();
  one.drive.sample_time = step;
  one.drive.inputs = {std::move(input)};
  one.measured = {std::move(output)};
  return {one};
}

double slow_sine(double t) {
  return 20.0 * std::sin(test::two_pi * 0.5 * t);
}

/// A command that never comes back to where it was, and never rests.
double chirp(double t) {
  return std::sin(0.3 * t + 0.08 * t * t);
}

TEST(NoiseByDifferences, WhiteNoiseOnASlowSine) {
  for (const double deviation : {0.001, 0.05, 1.0}) {
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      const auto y = sum(over_time(4000, slow_sine), test::Noise(seed).white(4000, deviation));
      EXPECT_NEAR(noise_by_differences(y), deviation, 0.1 * deviation) << "seed " << seed;
    }
  }
}

TEST(NoiseFloor, AStepThatResamplingHidIsNoiseAllTheSame) {
  auto one = experiment(over_time(4000, chirp), over_time(4000, slow_sine));
  const double smooth = noise_floor(one, 0).value;
  one.front().steps = {0.3};
  EXPECT_LT(smooth, 0.01);
  EXPECT_NEAR(noise_floor(one, 0).value, 0.3 / std::sqrt(12.0), 1e-9);
}

TEST(NoiseByDifferences, GlitchesDoNotCount) {
  auto y = sum(over_time(4000, slow_sine), test::Noise(3).white(4000, 0.05));
  for (std::size_t k = 100; k < y.size(); k += 400) {
    y[k] += 50.0;
  }
  EXPECT_NEAR(noise_by_differences(y), 0.05, 0.005);
}

TEST(NoiseFloor, ByDifferencesWhereNothingElseSpeaks) {
  const auto floor = noise_floor(
      experiment(over_time(4000, chirp), sum(over_time(4000, slow_sine), test::Noise(1).white(4000, 0.05))), 0);
  EXPECT_EQ(floor.evidence, "differences");
  EXPECT_NEAR(floor.value, 0.05, 0.005);
  EXPECT_EQ(floor.repeats, 0.0);
  EXPECT_EQ(floor.dwells, 0.0);
}

TEST(InputPeriod, OfASineAndOfNothing) {
  const auto sine = [](double t) { return std::sin(test::two_pi * 2.0 * t); };
  EXPECT_EQ(input_period(experiment(over_time(1000, sine), over_time(1000, sine))[0]), 100U);
  EXPECT_EQ(input_period(experiment(over_time(1000, chirp), over_time(1000, sine))[0]), 0U);
  EXPECT_EQ(input_period(experiment(std::vector<double>(1000, 1.0), over_time(1000, sine))[0]), 0U);
}

/// Slow noise: white noise behind a lag of 10 samples, which the differences hardly see.
std::vector<double> slow_noise(std::size_t count, double deviation) {
  auto values = test::Noise(11).white(count, 1.0);
  double state = 0.0;
  const double decay = std::exp(-0.1);
  for (double& value : values) {
    state = decay * state + std::sqrt(1.0 - decay * decay) * value;
    value = deviation * state;
  }
  return values;
}

TEST(NoiseFloor, RepeatsSeeSlowNoise) {
  const auto sine = [](double t) { return std::sin(test::two_pi * 0.5 * t); };
  const auto floor =
      noise_floor(experiment(over_time(8000, sine), sum(over_time(8000, slow_sine), slow_noise(8000, 0.2))), 0);
  EXPECT_EQ(floor.evidence, "repeats");
  EXPECT_NEAR(floor.value, 0.2, 0.03);
  EXPECT_LT(floor.differences, 0.15);
}

TEST(NoiseFloor, ADriftBetweenCyclesIsNoNoise) {
  const auto sine = [](double t) { return std::sin(test::two_pi * 0.5 * t); };
  auto y = sum(over_time(8000, slow_sine), test::Noise(2).white(8000, 0.05));
  y = sum(y, over_time(8000, [](double t) { return 0.3 * t; }));
  EXPECT_NEAR(noise_floor(experiment(over_time(8000, sine), y), 0).value, 0.05, 0.005);
}

TEST(NoiseFloor, DwellsSeeSlowNoise) {
  // Steps of 2 s to levels that never come back.
  const auto steps = [](double t) { return std::sqrt(2.0 + std::floor(t / 2.0)); };
  const auto settling = [](double t) { return 10.0 * std::sqrt(2.0 + std::floor(t / 2.0)); };
  const auto floor =
      noise_floor(experiment(over_time(8000, steps), sum(over_time(8000, settling), slow_noise(8000, 0.2))), 0);
  EXPECT_EQ(floor.evidence, "dwells");
  EXPECT_NEAR(floor.value, 0.2, 0.04);
}

/// Steps of 1 s to levels that never come back, and the output behind them.
double treads(double t) {
  return std::sqrt(2.0 + std::floor(t));
}

TEST(NoiseFloor, ALineThroughAllDwellsIsADisturbance) {
  auto y = sum(over_time(8000, treads), test::Noise(5).white(8000, 0.05));
  y = sum(y, over_time(8000, [](double t) { return 0.5 * std::sin(test::two_pi * 2.3 * t + 0.4); }));
  EXPECT_NEAR(noise_floor(experiment(over_time(8000, treads), y), 0).value, 0.05, 0.01);
}

TEST(NoiseFloor, ALineAsStrongAsTheNoiseIsADisturbanceToo) {
  auto y = sum(over_time(8000, treads), test::Noise(5).white(8000, 0.05));
  y = sum(y, over_time(8000, [](double t) { return 0.07 * std::sin(test::two_pi * 2.3 * t + 0.4); }));
  EXPECT_NEAR(noise_floor(experiment(over_time(8000, treads), y), 0).value, 0.05, 0.005);
}

TEST(NoiseFloor, SlowNoiseHasNoLines) {
  // Of dwells as long as these, a cubic takes little; a line would take a fifth at least.
  const auto levels = [](double t) { return std::sqrt(2.0 + std::floor(t / 4.0)); };
  const auto y = sum(over_time(16000, levels), slow_noise(16000, 0.2));
  EXPECT_NEAR(noise_floor(experiment(over_time(16000, levels), y), 0).value, 0.2, 0.02);
}

TEST(NoiseFloor, NoiseThatAControllerDifferentiatedCountsOnce) {
  auto noise = test::Noise(8).white(8001, 0.05);
  for (std::size_t k = 0; k + 1 < noise.size(); ++k) {
    noise[k] = noise[k + 1] - noise[k];
  }
  noise.pop_back();
  const auto floor = noise_floor(experiment(over_time(8000, treads), sum(over_time(8000, treads), noise)), 0);
  EXPECT_EQ(floor.evidence, "dwells");
  EXPECT_GT(floor.differences, 0.08);
  EXPECT_NEAR(floor.value, 0.05 * std::sqrt(2.0), 0.007);
}

TEST(NoiseFloor, WhatRingsInMostDwellsIsNoNoise) {
  auto y = sum(over_time(8000, treads), test::Noise(6).white(8000, 0.05));
  const auto ringing = [](double t) {
    const double since = t - std::floor(t);
    return static_cast<int>(t) % 2 == 0 ? 0.0 : std::exp(-since) * std::sin(test::two_pi * (3.0 + 0.1 * t) * since);
  };
  EXPECT_NEAR(noise_floor(experiment(over_time(8000, treads), sum(y, over_time(8000, ringing))), 0).value, 0.05, 0.01);
}

TEST(NoiseFloor, AMachineThatSwingsFreeWhileItsCommandsRestDoesNotDwell) {
  // The larger the swing the slower: friction makes it a line of no one frequency.
  std::vector<double> swing{1.2};
  double speed = 0.0;
  for (std::size_t k = 1; k < 4000; ++k) {
    speed += step * (-40.0 * std::sin(swing.back()) - 0.05 * std::tanh(20.0 * speed));
    swing.push_back(swing.back() + step * speed);
  }
  const auto y = sum(swing, test::Noise(9).white(4000, 0.001));
  const auto floor = noise_floor(experiment(std::vector<double>(4000, 1.0), y), 0);
  EXPECT_LT(floor.value, 0.003) << floor.evidence;
}

TEST(NoiseFloor, ACommandThatWasMeasuredTooDwellsInSpiteOfItsNoise) {
  const auto y = sum(over_time(8000, treads), slow_noise(8000, 0.05));
  const auto exact = noise_floor(experiment(over_time(8000, treads), y), 0);
  ASSERT_EQ(exact.evidence, "dwells");
  const auto noisy = sum(over_time(8000, treads), test::Noise(4).white(8000, 0.003));
  const auto flickering = [](double t) { return treads(t) + (std::fmod(t, 0.31) < 0.02 ? 0.004 : 0.0); };
  for (const auto& command : {noisy, over_time(8000, flickering)}) {
    const auto floor = noise_floor(experiment(command, y), 0);
    EXPECT_EQ(floor.evidence, "dwells");
    EXPECT_NEAR(floor.value, exact.value, 0.1 * exact.value);
  }
  // Noise that is no small part of a command moves the machine.
  const auto shaken = sum(over_time(8000, treads), test::Noise(4).white(8000, 0.5));
  EXPECT_EQ(noise_floor(experiment(shaken, y), 0).dwells, 0.0);
}

TEST(NoiseFloor, WhatElseWasLoggedHasToRestToo) {
  // Another axis moves in the first half of the record, and the output follows it.
  const auto other = over_time(8000, [](double t) { return t < 20.0 ? std::sin(7.0 * t * (1.0 + 0.03 * t)) : 0.0; });
  const auto y = sum(sum(over_time(8000, treads), test::Noise(7).white(8000, 0.05)), other);
  const auto experiments = experiment(over_time(8000, treads), y);
  EXPECT_NEAR(noise_floor(experiments, 0, {{other}}).value, 0.05, 0.01);
}

TEST(NoiseFloor, OfAQuantisedSensorIsAtLeastItsRounding) {
  constexpr double quantum = 0.5;
  auto y = over_time(4000, slow_sine);
  for (double& value : y) {
    value = quantum * std::round(value / quantum);
  }
  const double rounding = quantum / std::sqrt(12.0);
  const double drifting = noise_floor(experiment(over_time(4000, chirp), y), 0).value;
  EXPECT_GE(drifting, 0.999 * rounding);
  EXPECT_LT(drifting, 1.5 * rounding);
  const auto sine = [](double t) { return std::sin(test::two_pi * 0.5 * t); };  // cycles repeat to the bit
  const double repeating = noise_floor(experiment(over_time(4000, sine), y), 0).value;
  EXPECT_GE(repeating, 0.999 * rounding);
  EXPECT_LT(repeating, 1.5 * rounding);
}

TEST(NoiseFloor, AQuantumOfATenthOfTheRangeIsNoNoise) {
  // Samples of a fast signal hop from step to step: their differences are as large as the rounding.
  auto y =
      over_time(4000, [](double t) { return std::sin(test::two_pi * 31.0 * t) + std::sin(test::two_pi * 7.3 * t); });
  const double range = 4.0;
  const double quantum = 0.1 * range;
  for (double& value : y) {
    value = quantum * std::round(value / quantum);
  }
  const NoiseFloor floor = noise_floor(experiment(over_time(4000, chirp), y), 0);
  EXPECT_GT(floor.differences, 0.021 * range);
  EXPECT_LE(floor.value, 0.02 * range);
}

TEST(NoiseFloor, BehindARoundingIsWhatLiesOffItsSteps) {
  constexpr double quantum = 0.5;
  const std::vector<double> noise = test::Noise(7).white(4000, 0.06);
  auto y = over_time(4000, slow_sine);
  for (std::size_t k = 0; k < y.size(); ++k) {
    y[k] = quantum * std::round((y[k] + 0.9 * noise[y.size() - 1 - k]) / quantum) + 0.17 + noise[k];
  }
  EXPECT_NEAR(noise_off_steps(y), 0.06, 0.004) << "wherever the steps begin";
  const NoiseFloor floor = noise_floor(experiment(over_time(4000, chirp), y), 0);
  EXPECT_EQ(floor.evidence, "steps");
  EXPECT_NEAR(floor.value, 0.06, 0.004);
  EXPECT_EQ(noise_off_steps(over_time(4000, slow_sine)), 0.0);
}

TEST(NoiseFloor, DecaysTakenOffRoundedValuesAreNoNoiseBehindTheRounding) {
  constexpr double quantum = 0.03;
  const std::vector<double> noise = test::Noise(8).white(4000, 0.02);
  auto y = over_time(4000, slow_sine);
  for (std::size_t k = 0; k < y.size(); ++k) {
    y[k] = quantum * std::round((y[k] + noise[k]) / quantum);
  }
  for (std::size_t first = 400; first < y.size(); first += 200) {
    for (std::size_t k = first; k < y.size(); ++k) {
      y[k] -= 0.8 * std::exp(-static_cast<double>(k - first) / 2.5);
    }
  }
  EXPECT_EQ(noise_off_steps(y), 0.0);
  EXPECT_GT(noise_floor(experiment(over_time(4000, chirp), y), 0).value, 0.015);
}

TEST(NoiseFloor, WithoutNoiseIsSmallButAboveZero) {
  const auto sine = [](double t) { return std::sin(test::two_pi * 0.5 * t); };
  for (const auto& input : {over_time(4000, sine), over_time(4000, chirp)}) {
    const double floor = noise_floor(experiment(input, over_time(4000, slow_sine)), 0).value;
    EXPECT_GE(floor, 1e-9 * 40.0);
    EXPECT_LT(floor, 1e-3 * 40.0);
  }
}

TEST(NoiseFloor, OfSeveralRecordsTakesAll) {
  auto both = experiment(over_time(4000, chirp), sum(over_time(4000, slow_sine), test::Noise(1).white(4000, 0.03)));
  both.push_back(
      experiment(over_time(4000, chirp), sum(over_time(4000, slow_sine), test::Noise(2).white(4000, 0.04)))[0]);
  EXPECT_NEAR(noise_floor(both, 0).value, std::sqrt(0.5 * (0.03 * 0.03 + 0.04 * 0.04)), 0.003);
}

TEST(NoiseRange, HoldsTheFloorAndWhatSlowNoiseMayHide) {
  for (const double left : {0.2, 0.99, 1.0, 1.2, 7.0}) {
    const NoiseRange range = noise_range(left);
    EXPECT_LT(range.low, 1.0) << left;
    EXPECT_LE(range.low, left);
    EXPECT_GT(range.high, 1.0) << left;
    EXPECT_LT(range.high, 1.6) << "a large remainder is no noise";
  }
  EXPECT_GT(noise_range(1.2).high, 1.2);
}

/// What no fit sees is in no floor: of repeats, of dwells, of differences, of what lies off a sensor's steps.
TEST(NoiseFloor, ASpikeOfAnySizeIsInNone) {
  const auto sine = [](double t) { return std::sin(test::two_pi * 0.5 * t); };
  const auto settling = [](double t) { return 10.0 * treads(t / 2.0); };
  const auto white = test::Noise(11).white(8000, 0.2);
  auto rounded = sum(over_time(8000, slow_sine), test::Noise(3).white(8000, 0.3));
  for (double& value : rounded) {
    value = std::round(value);
  }
  const std::vector<std::pair<std::string, std::vector<Experiment>>> records{
      {"repeats", experiment(over_time(8000, sine), sum(over_time(8000, slow_sine), white))},
      {"dwells", experiment(over_time(8000, [](double t) { return treads(t / 2.0); }),
                            sum(over_time(8000, settling), slow_noise(8000, 0.2)))},
      {"differences", experiment(over_time(8000, chirp), sum(over_time(8000, slow_sine), white))},
      {"differences", experiment(over_time(8000, chirp), rounded)}};
  for (const auto& [evidence, clean] : records) {
    const NoiseFloor before = noise_floor(clean, 0);
    EXPECT_EQ(before.evidence, evidence);
    for (const double size : {30.0, 1e4, -1e9}) {
      auto struck = clean;
      struck.front().measured.front()[4321] += size;
      struck.front().measured.front()[4322] += size;
      struck.front().measured.front()[7000] -= size;
      const NoiseFloor floor = noise_floor(struck, 0);
      EXPECT_EQ(floor.evidence, evidence) << size;
      EXPECT_NEAR(floor.value, before.value, 0.02 * before.value) << evidence << ", " << size;
    }
  }
}

}  // namespace
}  // namespace hysteron::diagnosis
