// Glitches that a lag has taken up.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "tests/diagnosis/simulated_machine.hpp"

namespace hysteron::diagnosis {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr std::size_t read_samples = 2000;
constexpr double speed_noise = 0.002;
constexpr double sensor_step = 0.005;
constexpr double filter_time = 0.1;  // s, of the sensor

std::vector<double> speed_of_axis() {
  return simulate(test::program_of(test::axis()), test::record_of("FORCE", test::rich_force(read_samples))).front();
}

/// What a lag of first order makes of it, from its first value on.
std::vector<double> lagged(std::vector<double> values) {
  const double pole = std::exp(-sensor_step / filter_time);
  for (std::size_t k = 1; k < values.size(); ++k) {
    values[k] = pole * values[k - 1] + (1.0 - pole) * values[k];
  }
  return values;
}

/// Spikes at 16 read_samples, of either sign.
void add_spikes(std::vector<double>& values, double size) {
  test::Noise random(9);
  for (std::size_t k = 60; k < values.size(); k += 120) {
    const double sign = random.uniform() < 0.5 ? -1.0 : 1.0;
    values[k + static_cast<std::size_t>(50.0 * random.uniform())] += sign * size * (0.7 + 0.6 * random.uniform());
  }
}

records::Record sensed(std::vector<double> speed) {
  test::Noise random(5);
  std::ranges::for_each(speed, [&](double& value) { value += speed_noise * random(); });
  records::Record record = test::record_of("FORCE", test::rich_force(read_samples));
  record.add({.name = "V", .values = std::move(speed)});
  return record;
}

Diagnosis found_behind_lag(const records::Record& record, std::vector<std::string> effects) {
  return diagnose(test::input_of(test::axis(), test::axis_parameters, {record}), {.effects = std::move(effects)});
}

const auto taken_off = Contains(HasSubstr("a lag has taken them up"));

TEST(LaggedGlitches, AreNamedBesideTheLag) {
  std::vector<double> speed = speed_of_axis();
  add_spikes(speed, 1.0);
  const Diagnosis found =
      found_behind_lag(sensed(lagged(std::move(speed))), {"glitches", "lag", "delay", "relaxation", "load"});
  ASSERT_EQ(found.effects.size(), 2U) << found.summary;
  EXPECT_THAT(found.warnings, taken_off);
  EXPECT_THAT(found.verdict, testing::AnyOf(Verdict::Named, Verdict::Group));
  for (const EffectFinding& effect : found.effects) {
    if (effect.id == "glitches") {
      EXPECT_EQ(effect.edge, "SPEED.XOUT");  // V is its name outside
      EXPECT_THAT(effect.parameters.at(0).value, testing::AllOf(testing::Ge(16.0), testing::Le(24.0)));
      EXPECT_NEAR(effect.parameters.at(1).value, 1.3 * (1.0 - std::exp(-sensor_step / filter_time)), 0.01);
    } else {
      EXPECT_EQ(effect.id, "lag");
      EXPECT_NEAR(effect.parameters.at(0).value, filter_time, 0.003);
    }
  }
  EXPECT_LT(found.gap.improved, 1.15 * speed_noise);
  EXPECT_LT(found.gap.floor.value, 1.2 * speed_noise) << "found anew without them";
  EXPECT_GT(found.gap.nominal, found.gap.calibrated);
}

TEST(LaggedGlitches, AreNoneIfTheyAreNotAskedFor) {
  std::vector<double> speed = speed_of_axis();
  add_spikes(speed, 1.0);
  EXPECT_THAT(found_behind_lag(sensed(lagged(std::move(speed))), {"lag", "delay"}).warnings, Not(taken_off));
}

TEST(LaggedGlitches, AreNoSlowSignalNorOneThatGrowsAndVanishes) {
  const std::vector<double> speed = speed_of_axis();
  std::vector<double> spikes(read_samples, 0.0);
  add_spikes(spikes, 1.0);
  std::vector<double> growing = lagged(spikes);
  std::ranges::reverse(growing);
  std::vector<double> slow;
  for (std::size_t k = 0; k < read_samples; ++k) {
    const double t = sensor_step * static_cast<double>(k);
    slow.push_back(0.02 * std::sin(1.3 * t) * std::sin(2.9 * t) + 0.01 * std::sin(7.0 * t * t / 10.0));
  }
  for (const std::vector<double>& disturbance : {growing, slow}) {
    std::vector<double> disturbed = speed;
    std::ranges::transform(disturbed, disturbance, disturbed.begin(), std::plus<>());
    const Diagnosis found = found_behind_lag(sensed(lagged(std::move(disturbed))), {"glitches", "lag"});
    EXPECT_THAT(found.warnings, Not(taken_off));
    EXPECT_GT(found.gap.improved, 2.0 * speed_noise);
  }
}

TEST(LaggedGlitches, AreNoAnswerToAnInputThatLeaps) {
  const std::string stage =
      "FUNCTION_BLOCK STAGE  (* @ts 5ms *)\n  VAR_INPUT FORCE : LREAL; END_VAR\n  VAR_OUTPUT V : LREAL; END_VAR\n"
      "  VAR FLEXURE : HY_GAIN := (K := 0.1); END_VAR\n  FLEXURE(XIN := FORCE);\n  V := FLEXURE.XOUT;\n"
      "END_FUNCTION_BLOCK\n";
  std::vector<double> force;
  test::Noise random(3);
  for (std::size_t k = 0; k < read_samples; ++k) {
    force.push_back(k % 100 == 0 ? random() : force.back());
  }
  std::vector<double> position;
  std::ranges::transform(force, std::back_inserter(position), [](double value) { return 0.1 * value; });
  position = lagged(std::move(position));
  for (const double spikes : {0.0, 1.0}) {
    std::vector<double> with_spikes(read_samples, 0.0);
    add_spikes(with_spikes, spikes);
    with_spikes = lagged(std::move(with_spikes));
    std::ranges::transform(with_spikes, position, with_spikes.begin(), std::plus<>());
    records::Record record = test::record_of("FORCE", force);
    std::ranges::for_each(with_spikes, [&](double& value) { value += speed_noise * random(); });
    record.add({.name = "V", .values = with_spikes});
    // The lag that is there is not among the effects, so that its answer to each leap is left.
    const Diagnosis found = diagnose(test::input_of(stage, "[parameters.FLEXURE]\nK = 0.1\n", {record}),
                                     {.effects = spikes > 0.0 ? std::vector<std::string>{"glitches", "lag"}
                                                              : std::vector<std::string>{"glitches", "offset"}});
    EXPECT_THAT(found.warnings, spikes > 0.0 ? testing::Matcher<std::vector<std::string>>(taken_off) : Not(taken_off))
        << found.summary;
  }
}

/// A limit of its rate holds an input up for a few samples after each small step, which an axis with damping takes up
/// as it would a knock.
TEST(LaggedGlitches, AreNoAnswerToTheFastestParts) {
  const auto text = [](bool limited) {
    return fmt::format(
        "FUNCTION_BLOCK AXIS  (* @ts 5ms *)\n  VAR_INPUT FORCE : LREAL; END_VAR\n  VAR_OUTPUT V : LREAL; END_VAR\n"
        "  VAR MASS : HY_GAIN := (K := 10.0); DAMPING : HY_GAIN := (K := 10.0); SPEED : HY_INTEGRAL_FORWARD;\n"
        "    {} END_VAR\n  DAMPING(XIN := SPEED.XOUT);\n  {}  SPEED(XIN := MASS.XOUT - DAMPING.XOUT);\n"
        "  V := SPEED.XOUT;\nEND_FUNCTION_BLOCK\n",
        limited ? "SLOW : HY_RATE_LIMIT := (RISE := 12.0, FALL := 12.0);" : "",
        limited ? "SLOW(XIN := FORCE);\n  MASS(XIN := SLOW.XOUT);\n" : "MASS(XIN := FORCE);\n");
  };
  std::vector<double> force;
  test::Noise random(3);
  double step = 0.0;
  for (std::size_t k = 0; k < read_samples; ++k) {
    step = k % 60 == 30 ? 0.12 * random() : step;
    force.push_back(3.0 * std::sin(0.8 * sensor_step * static_cast<double>(k)) + step);
  }
  const records::Record record =
      test::measured(test::program_of(text(true)), test::record_of("FORCE", force), speed_noise);
  const Diagnosis found = diagnose(test::input_of(text(false), "[parameters.MASS]\nK = 10.0\n", {record}),
                                   {.effects = {"glitches", "load", "rate_limit"}});
  EXPECT_THAT(found.warnings, Not(taken_off));
  ASSERT_EQ(found.effects.size(), 1U) << found.summary;
  EXPECT_EQ(found.effects[0].id, "rate_limit");
}

}  // namespace
}  // namespace hysteron::diagnosis
