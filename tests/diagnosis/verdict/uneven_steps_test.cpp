// Uneven steps: thresholds that lie off the middle are found, and what is off for another reason is not.
#include "diagnosis/verdict/uneven_steps.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>
#include <vector>

#include "tests/diagnosis/simulated_machine.hpp"

namespace hysteron::diagnosis {
namespace {

constexpr std::size_t length = 4000;
constexpr double step = 0.25;

/// Over some forty steps, each crossed ten times.
std::vector<double> to_and_fro() {
  std::vector<double> values(length);
  for (std::size_t k = 0; k < length; ++k) {
    const auto t = static_cast<double>(k);
    values[k] = 3.0 * std::sin(0.01 * t) + 2.0 * std::sin(0.0137 * t + 1.0);
  }
  return values;
}

/// The signal in steps, each threshold off its middle by what stands in the list.
std::vector<double> stepped(const std::vector<double>& values, const std::vector<double>& off, double noise) {
  std::vector<double> result = test::Noise(3).white(values.size(), noise * step);
  for (std::size_t k = 0; k < values.size(); ++k) {
    const double lower = std::floor(values[k] / step);
    const double threshold = lower + 0.5 + off.at(static_cast<std::size_t>(lower + 100.0));
    result[k] += step * (values[k] / step > threshold ? lower + 1.0 : lower);
  }
  return result;
}

double rms_between(const std::vector<double>& one, const std::vector<double>& other) {
  double squares = 0.0;
  for (std::size_t k = 0; k < one.size(); ++k) {
    squares += std::pow(one[k] - other[k], 2);
  }
  return std::sqrt(squares / static_cast<double>(one.size()));
}

TEST(UnevenSteps, ThresholdsAreFoundToASmallPartOfAStep) {
  const std::vector<double> even = stepped(to_and_fro(), std::vector<double>(200, 0.0), 0.0);
  const std::vector<double> measured = stepped(to_and_fro(), test::Noise(5).white(200, 0.1), 0.03);
  const auto found = moved_steps(to_and_fro(), measured, step);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->deviation, 0.1, 0.03);
  EXPECT_GT(rms_between(even, measured), 0.2 * step);
  EXPECT_LT(rms_between(found->values, measured), 0.06 * step);
}

TEST(UnevenSteps, EvenOnesAreNone) {
  EXPECT_FALSE(moved_steps(to_and_fro(), stepped(to_and_fro(), std::vector<double>(200, 0.0), 0.03), step));
}

TEST(UnevenSteps, WhatDependsOnTheTimeMovesNoThreshold) {
  std::vector<double> drifting = to_and_fro();
  for (std::size_t k = 0; k < length; ++k) {
    drifting[k] += 0.2 * step * std::sin(0.0061 * static_cast<double>(k));
  }
  EXPECT_FALSE(moved_steps(to_and_fro(), stepped(drifting, std::vector<double>(200, 0.0), 0.03), step));
}

TEST(UnevenSteps, WhatDependsOnTheDirectionMovesNoThreshold) {
  const std::vector<double> late = [] {
    std::vector<double> values = to_and_fro();
    for (std::size_t k = length - 1; k > 0; --k) {
      values[k] += values[k] > values[k - 1] ? -0.15 * step : 0.15 * step;
    }
    return values;
  }();
  EXPECT_FALSE(moved_steps(to_and_fro(), stepped(late, std::vector<double>(200, 0.0), 0.03), step));
}

TEST(UnevenSteps, ValuesOnNoStepsOrFarFromTheSignalHaveNone) {
  const std::vector<double> uneven = stepped(to_and_fro(), test::Noise(5).white(200, 0.1), 0.03);
  EXPECT_FALSE(moved_steps(to_and_fro(), to_and_fro(), step));
  EXPECT_FALSE(moved_steps(to_and_fro(), uneven, 0.77 * step));
  EXPECT_FALSE(moved_steps(to_and_fro(), uneven, 0.0));
  EXPECT_FALSE(moved_steps({}, {}, step));
  std::vector<double> elsewhere = to_and_fro();
  std::ranges::for_each(elsewhere, [](double& value) { value += 3.0 * step; });
  EXPECT_FALSE(moved_steps(elsewhere, uneven, step));
}

/// An even quantiser of the same step closes little of the gap there, since it leaves a whole step wherever a
/// threshold lies elsewhere; but the values lie on its steps.
TEST(UnevenSteps, OfASensorAreNamedAsTheValuesShow) {
  const std::vector<double> force = test::rich_force(length);
  const std::vector<double> speed = simulate(test::program_of(test::axis()), test::record_of("FORCE", force)).front();
  const auto [low, high] = std::ranges::minmax(speed);
  const double size = (high - low) / (30.0 * step);  // of the step: thirty over the range
  std::vector<double> scaled;
  std::ranges::transform(speed, std::back_inserter(scaled), [&](double value) { return value / size; });
  std::vector<double> measured = stepped(scaled, test::Noise(8).white(200, 0.16), 0.03);
  std::ranges::for_each(measured, [&](double& value) { value *= size; });
  records::Record record = test::record_of("FORCE", force);
  record.add({.name = "V", .values = std::move(measured)});
  const Diagnosis found = diagnose(test::input_of(test::axis(), test::axis_parameters, {std::move(record)}),
                                   {.effects = {"quantization", "load", "offset"}});
  ASSERT_EQ(found.effects.size(), 1U) << found.summary;
  EXPECT_EQ(found.effects[0].id, "quantization");
  EXPECT_EQ(found.verdict, Verdict::Named);
}

}  // namespace
}  // namespace hysteron::diagnosis
