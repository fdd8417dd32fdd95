// Lines over time and over a position, against signals whose lines are known.
#include "diagnosis/noise/spectrum.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/diagnosis/simulated_machine.hpp"

namespace hysteron::diagnosis {
namespace {

constexpr Eigen::Index spectrum_samples = 2000;
constexpr double spectrum_sample_time = 0.005;
constexpr double bin = 1.0 / (spectrum_samples * spectrum_sample_time);

Eigen::VectorXd sine(double frequency, double amplitude, double phase = 0.4) {
  Eigen::VectorXd values(spectrum_samples);
  for (Eigen::Index k = 0; k < spectrum_samples; ++k) {
    values[k] = amplitude * std::sin(test::two_pi * frequency * spectrum_sample_time * static_cast<double>(k) + phase);
  }
  return values;
}

Eigen::VectorXd white_noise(double deviation) {
  const auto values = test::Noise(3).white(spectrum_samples, deviation);
  return Eigen::Map<const Eigen::VectorXd>(values.data(), spectrum_samples);
}

TEST(StrongestLines, ALineBetweenBinsWithinATenthOfOne) {
  for (const double frequency : {3.0 * bin + 5.0, 17.33, 50.07, 80.0 + 0.5 * bin}) {
    const auto lines = Periodogram(sine(frequency, 1.0) + white_noise(0.3), spectrum_sample_time).strongest_lines(1);
    ASSERT_EQ(lines.size(), 1U);
    EXPECT_NEAR(lines[0], frequency, 0.1 * bin);
  }
}

TEST(StrongestLines, ComeStrongestFirst) {
  const Eigen::VectorXd both = sine(31.0, 0.5) + sine(12.7, 1.0) + white_noise(0.02);
  const auto lines = Periodogram(both, spectrum_sample_time).strongest_lines(2);
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_NEAR(lines[0], 12.7, 0.1 * bin);
  EXPECT_NEAR(lines[1], 31.0, 0.1 * bin);
}

TEST(StrongestLines, AnOffsetIsNone) {
  const auto lines =
      Periodogram(Eigen::VectorXd::Constant(spectrum_samples, 100.0) + sine(20.0, 0.1), spectrum_sample_time)
          .strongest_lines(1);
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_NEAR(lines[0], 20.0, 0.1 * bin);
}

TEST(StrongestLines, TooFewSamplesHaveNone) {
  EXPECT_TRUE(Periodogram(Eigen::VectorXd::Ones(20), spectrum_sample_time).strongest_lines(3).empty());
}

TEST(OutstandingLines, AreSeenBelowWhatIsSlowAndAThousandTimesAsStrong) {
  Eigen::VectorXd slow(spectrum_samples);
  const Eigen::VectorXd steps = white_noise(1.0);
  double sum = 0.0;
  for (Eigen::Index k = 0; k < spectrum_samples; ++k) {
    slow[k] = sum += 0.01 * steps[k];
  }
  const Eigen::VectorXd values = 300.0 * slow + sine(31.0, 0.05 * 300.0 * 0.1);
  const auto lines = Periodogram(values, spectrum_sample_time).outstanding_lines(3);
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_NEAR(lines[0], 31.0, 0.2 * bin);
  EXPECT_GT(std::abs(Periodogram(values, spectrum_sample_time).strongest_lines(1).front() - 31.0), 10.0);
}

TEST(OutstandingLines, NoiseHasNone) {
  EXPECT_TRUE(Periodogram(white_noise(1.0), spectrum_sample_time).outstanding_lines(3).empty());
  EXPECT_TRUE(Periodogram(Eigen::VectorXd::Ones(20), spectrum_sample_time).outstanding_lines(3).empty());
}

TEST(StrongestPeriods, ARippleOverThePositionNotOverTime) {
  // The position goes to and fro at a changing rate, so that the ripple has no line in time.
  std::vector<double> position;
  Eigen::VectorXd ripple(spectrum_samples);
  constexpr double period = 1.7;
  for (Eigen::Index k = 0; k < spectrum_samples; ++k) {
    const double t = spectrum_sample_time * static_cast<double>(k);
    position.push_back(10.0 * std::sin(0.7 * t + 0.05 * t * t) + 3.0 * std::sin(2.1 * t));
    ripple[k] = 0.2 * std::sin(test::two_pi * position.back() / period + 1.0);
  }
  const auto periods = strongest_periods(ripple + white_noise(0.05), {position}, 1);
  ASSERT_EQ(periods.size(), 1U);
  const auto [low, high] = std::ranges::minmax(position);
  // Much nearer than the grid, a quarter of a turn over the whole range: a quantum needs it.
  EXPECT_NEAR((high - low) / periods[0], (high - low) / period, 0.03);
}

/// A motion over some 370 steps of `step`, with noise behind the rounding; at rest in between, where its values are
/// many.
std::vector<double> rounded_motion(double step, double deviation) {
  std::vector<double> values = test::Noise(5).white(5000, deviation);
  for (std::size_t k = 0; k < values.size(); ++k) {
    const double t = 0.001 * static_cast<double>(k);
    const double x = k % 1000 < 300 ? 0.71 : 1.9 * std::sin(3.1 * t) + 0.3 * std::sin(17.0 * t);
    values[k] += step > 0.0 ? step * std::round(x / step) : x;
  }
  return values;
}

TEST(CommonStep, IsThatOfValuesWithLittleNoise) {
  EXPECT_NEAR(common_step(rounded_motion(0.0117, 0.001)), 0.0117, 1e-3 * 0.0117);
  EXPECT_EQ(common_step(rounded_motion(0.0117, 0.0117 / 3.5)), 0.0) << "too faint to be sure of";
  EXPECT_EQ(common_step(rounded_motion(0.0, 0.001)), 0.0);
}

/// A voltage that drives an axis to and fro: it rests near a few levels, those of friction and of acceleration, and
/// goes from one to the next in one sample or in many.
std::vector<double> few_levels(std::size_t ramp) {
  const std::vector<double> levels{1.1, 3.4, 1.1, -1.2, -3.4, -1.2};
  std::vector<double> values;
  test::Noise white(2);
  for (std::size_t k = 0; k < 12500; ++k) {
    const std::size_t part = k / 300;
    const auto within = static_cast<double>(k % 300);
    const double share = ramp == 0 ? 1.0 : std::min(1.0, within / static_cast<double>(ramp));
    const double bend = 0.3 * std::sin(0.02 * within) + 0.15 * std::sin(1.7 * static_cast<double>(part));
    values.push_back(std::lerp(levels[(part + 5) % 6], levels[part % 6], share) + bend + 0.003 * white());
  }
  return values;
}

TEST(CommonStep, AFewLevelsAtWhichAVoltageRestsAreNone) {
  for (const std::size_t ramp : {0U, 5U, 40U}) {
    EXPECT_EQ(common_step(few_levels(ramp)), 0.0) << ramp;
    EXPECT_TRUE(likely_steps(few_levels(ramp)).empty()) << ramp;
  }
}

TEST(CommonStep, AFewLevelsOfASensorThatRoundsAreSome) {
  for (const double noise : {0.0, 0.02, 0.1}) {
    std::vector<double> values;
    test::Noise white(5);
    for (int k = 0; k < 4000; ++k) {
      values.push_back(std::round(2.2 * std::sin(0.003 * k)) + noise * white());
    }
    EXPECT_NEAR(common_step(values), 1.0, 0.05) << noise;
  }
}

TEST(ClearSteps, AreThoseOfBothRoundings) {
  constexpr double coarse = 1.4;
  constexpr double fine = 0.057;
  test::Noise white(1);
  std::vector<double> values;
  for (int k = 0; k < 4000; ++k) {
    const double smooth = 9.0 * std::sin(0.01 * k) + 4.0 * std::sin(0.0237 * k);
    values.push_back(fine * std::round((coarse * std::round(smooth / coarse) + 0.03 * white()) / fine));
  }
  EXPECT_NEAR(common_step(values), fine, 1e-3 * fine);
  const std::vector<double> steps = clear_steps(values);
  ASSERT_EQ(steps.size(), 2U);
  EXPECT_EQ(steps[0], common_step(values));
  EXPECT_NEAR(steps[1], coarse, 1e-2 * coarse);
  std::ranges::generate(values, [&] { return white(); });
  EXPECT_TRUE(clear_steps(values).empty());
}

TEST(LikelySteps, IsSeenBehindNoiseOfItsOwnSize) {
  const std::vector<double> steps = likely_steps(rounded_motion(0.0117, 0.0117 / 3.5));
  ASSERT_EQ(steps.size(), 1U);
  EXPECT_NEAR(steps.front(), 0.0117, 1e-3 * 0.0117);
  EXPECT_TRUE(likely_steps(rounded_motion(0.0, 0.0117 / 3.5)).empty());
  EXPECT_TRUE(likely_steps(std::vector<double>(40, 1.0)).empty());
  EXPECT_TRUE(likely_steps(std::vector<double>(4000, 1.0)).empty());
}

TEST(StepFromZero, IsTheOneWhoseMultiplesTheValuesAre) {
  constexpr double step = 0.0117;
  std::vector<double> far = rounded_motion(step, step / 10.0);
  std::ranges::for_each(far, [](double& value) { value += 700.0 * step; });
  EXPECT_NEAR(step_from_zero(far, step * (1.0 + 3e-4)), step, 1e-6) << "a fifth of a step off where the values are";
  std::ranges::for_each(far, [](double& value) { value -= 700.0 * step; });
  EXPECT_NEAR(step_from_zero(far, step), step, 1e-6);
  std::ranges::for_each(far, [](double& value) { value += 0.4 * step; });
  EXPECT_EQ(step_from_zero(far, step), step) << "about 0 none gives these values";
}

TEST(StrongestPeriods, OfEqualSignalsAreFoundOnce) {
  const Eigen::VectorXd residual = white_noise(1.0);
  const auto saw = [](double period) {
    std::vector<double> values;
    for (int k = 0; k < spectrum_samples; ++k) {
      values.push_back(std::fmod(k, period));
    }
    return StrongestPeriods::Signals{values};
  };
  const StrongestPeriods::Signals one = saw(70.0);
  const StrongestPeriods::Signals same = saw(70.0);
  const StrongestPeriods::Signals other = saw(110.0);
  StrongestPeriods strongest(residual, 4);
  const std::vector<double>& found = strongest.over(one);
  EXPECT_EQ(found, strongest_periods(residual, one, 4));
  EXPECT_EQ(&strongest.over(same), &found);
  EXPECT_EQ(strongest.over(other), strongest_periods(residual, other, 4));
  EXPECT_NE(strongest.over(other), found);
}

TEST(StrongestPeriods, ASignalThatStandsHasNone) {
  EXPECT_TRUE(strongest_periods(white_noise(1.0), {std::vector<double>(spectrum_samples, 2.0)}, 3).empty());
}

}  // namespace
}  // namespace hysteron::diagnosis
