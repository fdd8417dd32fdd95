// What is left without a name: a residual that follows the inputs is an unknown effect, noise of any colour is none.
#include "diagnosis/noise/discrepancy.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/diagnosis/simulated_machine.hpp"

namespace hysteron::diagnosis {
namespace {

constexpr std::size_t count = 2000;

std::vector<Experiment> stack_run() {
  Experiment one;
  one.drive.steps = count;
  one.drive.sample_time = 0.005;
  one.drive.inputs = {test::rich_voltage(count)};
  one.measured = {simulate(test::program_of(test::stack()), test::record_of("U", one.drive.inputs[0]))[0]};
  return {one};
}

VectorXd vector_of(const std::vector<double>& values) {
  return Eigen::Map<const VectorXd>(values.data(), static_cast<Index>(values.size()));
}

/// Voss and Clarke's sum of held noises, each renewed half as often as the one before: power like 1/f.
std::vector<double> pink_noise(std::uint64_t seed) {
  test::Noise noise(seed);
  std::vector<double> held(11);
  std::vector<double> values;
  for (std::size_t k = 0; k < count; ++k) {
    double sum = 0.0;
    for (std::size_t octave = 0; octave < held.size(); ++octave) {
      if (k % (std::size_t{1} << octave) == 0) {
        held[octave] = noise();
      }
      sum += held[octave];
    }
    values.push_back(sum);
  }
  return values;
}

TEST(Discrepancy, AFunctionOfTheInputIsPredicted) {
  const auto run = stack_run();
  const std::vector<double>& u = run[0].drive.inputs[0];
  std::vector<double> square(u);
  std::ranges::transform(u, square.begin(), [](double v) { return 0.3 * (v - 1.0) * (v - 1.0); });
  const Discrepancy found = discrepancy(run, vector_of(square));
  EXPECT_GT(found.share, 0.98);
  EXPECT_GT(found.share_low, 0.25);  // its blocks differ in size, which widens the bound
  double mean_square = 0.0;
  for (const double v : square) {
    mean_square += v * v / static_cast<double>(count);
  }
  EXPECT_NEAR(found.rms, std::sqrt(mean_square), 0.02 * std::sqrt(mean_square));
}

TEST(Discrepancy, APlayOfTheInputIsPredicted) {
  const auto run = stack_run();
  const std::vector<double>& u = run[0].drive.inputs[0];
  std::vector<double> difference;
  double state = u.front();
  for (const double v : u) {
    state = std::clamp(state, v - 0.3, v + 0.3);
    difference.push_back(v - state);
  }
  EXPECT_GT(discrepancy(run, vector_of(difference)).share_low, 0.5);
}

TEST(Discrepancy, WhiteNoiseIsNot) {
  const auto run = stack_run();
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Discrepancy found = discrepancy(run, vector_of(test::Noise(seed).white(count, 1.0)));
    EXPECT_LT(found.share, 0.03) << seed;
    EXPECT_LT(found.share_low, 0.01) << seed;
  }
}

TEST(Discrepancy, SlowNoiseThatFollowsNothingIsNot) {
  const auto run = stack_run();
  int predicted = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    predicted += discrepancy(run, vector_of(pink_noise(seed))).share_low > 0.02 ? 1 : 0;
  }
  EXPECT_LE(predicted, 1);
}

TEST(Discrepancy, HalfOfWhatIsHalfNoise) {
  const auto run = stack_run();
  const std::vector<double>& u = run[0].drive.inputs[0];
  double mean = 0.0;
  double square = 0.0;
  for (const double v : u) {
    mean += v / static_cast<double>(count);
    square += v * v / static_cast<double>(count);
  }
  const double deviation = std::sqrt(square - mean * mean);
  auto mixture = test::Noise(9).white(count, 1.0);
  for (std::size_t k = 0; k < count; ++k) {
    mixture[k] += (u[k] - mean) / deviation;
  }
  EXPECT_NEAR(discrepancy(run, vector_of(mixture)).share, 0.5, 0.08);
}

TEST(Discrepancy, TooLittleIsNoEvidence) {
  Experiment one;
  one.drive.steps = 100;
  one.drive.inputs = {test::rich_voltage(100)};
  EXPECT_EQ(discrepancy({one}, vector_of(one.drive.inputs[0])).share, 0.0);
  const auto run = stack_run();
  EXPECT_EQ(discrepancy(run, VectorXd::Zero(count)).share, 0.0);
}

}  // namespace
}  // namespace hysteron::diagnosis
