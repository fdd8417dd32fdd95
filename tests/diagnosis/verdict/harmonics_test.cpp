// A disturbance with harmonics, and lines that are none.
#include "diagnosis/verdict/harmonics.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "diagnosis/model/task.hpp"
#include "tests/diagnosis/simulated_machine.hpp"

namespace hysteron::diagnosis {
namespace {

constexpr double noise_of_speed = 0.002;
constexpr double first_line = 4.0;  // Hz

/// A record of the axis whose speed has lines at these frequencies, of these sizes.
DiagnosisInput humming(const std::vector<std::pair<double, double>>& lines) {
  const records::Record driven =
      test::measured(test::program_of(test::axis()), test::record_of("FORCE", test::rich_force()), noise_of_speed);
  records::Record record = test::record_of("FORCE", test::rich_force());
  records::Column speed = driven.column("V");
  for (std::size_t k = 0; k < speed.values.size(); ++k) {
    for (const auto& [frequency, size] : lines) {
      speed.values[k] += size * std::sin(test::two_pi * frequency * record.time()[k] + frequency);
    }
  }
  record.add(speed);
  return test::input_of(test::axis(), test::axis_parameters, {record});
}

/// A parameter of each effect that was named, all of which are this one.
std::vector<double> values_of(const Diagnosis& found, std::string_view id, std::string_view name) {
  std::vector<double> result;
  for (const EffectFinding& effect : found.effects) {
    EXPECT_EQ(effect.id, id);
    for (const ParameterFinding& parameter : effect.parameters) {
      if (parameter.name == name) {
        result.push_back(parameter.value);
      }
    }
  }
  return result;
}
std::vector<double> frequencies_of(const Diagnosis& found) {
  return values_of(found, "periodic_disturbance", "FREQUENCY");
}

const DiagnosisOptions lines_alone{.effects = {"periodic_disturbance"}};

TEST(Harmonics, AreLinesOfTheSameDisturbance) {
  const Diagnosis found =
      diagnose(humming({{first_line, 0.08}, {2.0 * first_line, 0.02}, {3.0 * first_line, 0.01}}), lines_alone);
  EXPECT_THAT(frequencies_of(found),
              testing::ElementsAre(testing::DoubleNear(first_line, 0.01), testing::DoubleNear(2.0 * first_line, 0.02),
                                   testing::DoubleNear(3.0 * first_line, 0.03)));
  EXPECT_THAT(found.summary, testing::HasSubstr("(3 lines)"));
  EXPECT_NEAR(found.gap.improved, noise_of_speed, 0.1 * noise_of_speed);
  // By the squares of their sizes.
  EXPECT_NEAR(found.effects[1].share / found.effects[0].share, 1.0 / 16.0, 0.01);
  EXPECT_NEAR(found.effects[2].share / found.effects[0].share, 1.0 / 64.0, 0.005);
}

TEST(Harmonics, APureLineHasNone) {
  EXPECT_THAT(frequencies_of(diagnose(humming({{first_line, 0.08}}), lines_alone)), testing::SizeIs(1));
}

TEST(Harmonics, OtherLinesAreNone) {
  const Diagnosis found = diagnose(humming({{first_line, 0.08}, {1.37 * first_line, 0.02}}), lines_alone);
  EXPECT_THAT(frequencies_of(found), testing::SizeIs(1));
  EXPECT_GT(found.gap.improved, 3.0 * noise_of_speed);
}

/// An axis whose position is measured, with what cogs.
std::string turning(const std::string& declared, const std::string& called, const std::string& force) {
  return "FUNCTION_BLOCK AXIS (* @ts 5ms *) VAR_INPUT FORCE : LREAL; END_VAR VAR_OUTPUT X : LREAL; END_VAR VAR SPEED : "
         "HY_INTEGRAL_FORWARD; POS : HY_INTEGRAL_FORWARD; DRAG : HY_GAIN := (K := 1.0); " +
         declared + " END_VAR DRAG(XIN := SPEED.XOUT); " + called + " SPEED(XIN := " + force +
         " - DRAG.XOUT); POS(XIN := SPEED.XOUT); X := POS.XOUT; END_FUNCTION_BLOCK";
}

TEST(Harmonics, OfACoggingAreOverItsPosition) {
  constexpr double noise = 0.0005;
  const std::string machine = turning(
      "FIRST : HY_COGGING := (SINE := 0.3, PITCH := 0.2); SECOND : HY_COGGING := (COSINE := 0.1, PITCH := 0.1);",
      "FIRST(XIN := FORCE, POS := POS.XOUT); SECOND(XIN := FIRST.XOUT, POS := POS.XOUT);", "SECOND.XOUT");
  const records::Record record =
      test::measured(test::program_of(machine), test::record_of("FORCE", test::rich_force()), noise);
  const DiagnosisOptions cogging{.effects = {"cogging"}};
  const Diagnosis found =
      diagnose(test::input_of(turning("", "", "FORCE"), "[parameters.DRAG]\nK = 1.0\n", {record}), cogging);
  EXPECT_THAT(values_of(found, "cogging", "PITCH"),
              testing::ElementsAre(testing::DoubleNear(0.2, 0.002), testing::DoubleNear(0.1, 0.001)));
  EXPECT_NEAR(found.gap.improved, noise, 0.1 * noise);
}

TEST(Harmonics, NotOfASetWithoutALine) {
  const DiagnosisInput input = humming({{first_line, 0.08}});
  Task task = task_of(input);
  task.scales = {noise_of_speed};
  const Explanation bare{.variant = {.text = input.text, .program = std::make_shared<const Program>(input.program)}};
  EXPECT_FALSE(with_harmonics(task, "AXIS", bare, 1000.0));
}

}  // namespace
}  // namespace hysteron::diagnosis
