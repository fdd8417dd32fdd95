#include "diagnosis/evidence/explained.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "diagnosis/model/task.hpp"
#include "diagnosis/search/expansion.hpp"
#include "tests/diagnosis/simulated_machine.hpp"

namespace hysteron::diagnosis {
namespace {

using testing::ContainsRegex;
using testing::Not;

constexpr double noise = 0.002;

struct Given {
  Task task{};
  Explanation calibrated{};
};

Given given(const std::string& text, const std::string& fit, records::Record record, std::vector<double> scales) {
  const DiagnosisInput input = test::input_of(text, fit, {std::move(record)});
  Given result{.task = task_of(input)};
  result.task.scales = std::move(scales);
  result.calibrated =
      footing_of(result.task, {.text = text, .program = std::make_shared<Program>(input.program)}).calibrated;
  return result;
}

Explained explained_by(const Given& given, const std::string& top, const SetFinding& set, bool is_open_loop = false) {
  Rules rules;
  return explained(given.task, top, set, given.calibrated, {.is_open_loop = is_open_loop, .floor_cost = 1e3}, rules);
}

double value_of(const Given& given, const Explanation& one, const std::string& parameter) {
  const auto is_wanted = [&](const Unknown& unknown) { return unknown.path.ends_with(parameter); };
  const auto known = std::ranges::find_if(given.task.known, is_wanted);
  if (known != given.task.known.end()) {
    return one.fit.x[known - given.task.known.begin()];
  }
  const auto further = std::ranges::find_if(one.variant.further, is_wanted);
  return one.fit.x[std::ssize(given.task.known) + (further - one.variant.further.begin())];
}

/// The force that a motion takes; `term` is added to it.
std::string inverse_dynamics(const std::string& term = {}, const std::string& blocks = {}) {
  return "FUNCTION_BLOCK PUSH  (* @ts 5ms *)\n"
         "  VAR_INPUT Y : LREAL;  (* @unit m *) END_VAR\n"
         "  VAR_OUTPUT U : LREAL;  (* @unit V *) END_VAR\n"
         "  VAR\n    SPEED : HY_DERIVATIVE_FILTERED := (T1 := 0.02);\n"
         "    ACC : HY_DERIVATIVE_FILTERED := (T1 := 0.02);\n"
         "    MASS : HY_GAIN := (K := 2.0);\n    DAMP : HY_GAIN := (K := 5.0);\n" +
         (blocks.empty() ? blocks : "    F : HY_COULOMB_FRICTION := (LEVEL := 0.6, PRESLIDE := 0.001);\n") +
         "  END_VAR\n  SPEED(XIN := Y);\n  ACC(XIN := SPEED.XOUT);\n  MASS(XIN := ACC.XOUT);\n"
         "  DAMP(XIN := SPEED.XOUT);\n" +
         blocks + "  U := MASS.XOUT + DAMP.XOUT" + term + ";\nEND_FUNCTION_BLOCK\n";
}

TEST(Explained, InInverseDynamicsAFrictionIsAddedAndItsVelocityCountsBackwards) {
  std::vector<double> motion;
  for (int k = 0; k < 2000; ++k) {
    motion.push_back(0.1 * std::sin(0.005 * k * 2.9) + 0.03 * std::sin(0.005 * k * 7.3));
  }
  const std::string machine = inverse_dynamics(" - F.XOUT", "  F(XIN := 0.0, V := SPEED.XOUT);\n");
  const Given found = given(inverse_dynamics(), "[fit.MASS]\nK = {min = 0.0}\n[fit.DAMP]\nK = {min = 0.0}\n",
                            test::measured(test::program_of(machine), test::record_of("Y", motion), noise), {noise});
  // As the evidence tells it: at that edge, by the slope of the measured position, which no wire of the diagram is.
  const SetFinding set{.space = "outputs",
                       .laws = {{.effect = "coulomb_friction",
                                 .family = "dry_friction",
                                 .edge = "ACC.XOUT",
                                 .drivers = {"Y'"},
                                 .values = {{.name = "LEVEL", .value = -0.27, .error = 0.01, .unit = "'x"},
                                            {.name = "PRESLIDE", .value = 0.002}},
                                 .closed = 0.9}},
                       .closed = 0.9,
                       .known = {2.1, 4.6}};
  const Explained result = explained_by(found, "PUSH", set);
  ASSERT_FALSE(result.runs.empty());
  const Explanation& one = result.runs.back().fitted;
  EXPECT_THAT(one.variant.text, ContainsRegex("V := -ACC_COULOMB_FRICTION_RATE.XOUT"));
  EXPECT_THAT(one.variant.text, ContainsRegex("ACC_COULOMB_FRICTION_RATE\\(XIN := Y\\)"));
  EXPECT_EQ(one.variant.effects.front().wires.front().second, "-Y'");
  EXPECT_LT(one.fit.cost, 0.05 * found.calibrated.fit.cost);
  EXPECT_NEAR(value_of(found, one, "LEVEL") * value_of(found, one, "MASS.K"), 0.6, 0.05);
  EXPECT_NEAR(value_of(found, one, "DAMP.K"), 5.0, 0.3);
}

/// The machine's filters are ten times as fast as those of the diagram: a relaxation that settles within a sample would
/// make up for them, with a gain that only a mass fifty times as large can take.
TEST(Explained, ATimeStaysWithinWhatARecordShowsAsInASearch) {
  std::vector<double> motion;
  for (int k = 0; k < 2000; ++k) {
    motion.push_back(0.1 * std::sin(0.005 * k * 2.9) + 0.03 * std::sin(0.005 * k * 37.3));
  }
  std::string machine = inverse_dynamics();
  for (std::size_t at = 0; (at = machine.find("T1 := 0.02", at)) != std::string::npos;) {
    machine.replace(at, 10, "T1 := 0.002");
  }
  const Given found = given(inverse_dynamics(), "[fit.MASS]\nK = {min = 0.0}\n[fit.DAMP]\nK = {min = 0.0}\n",
                            test::measured(test::program_of(machine), test::record_of("Y", motion), noise), {noise});
  const SetFinding set{
      .space = "outputs",
      .laws = {{.effect = "relaxation",
                .family = "linear_dynamics",
                .edge = "ACC.XOUT",
                .values = {{.name = "GAIN", .value = -0.8, .error = 0.01, .unit = "1"}, {.name = "T1", .value = 0.03}},
                .closed = 0.5}},
      .closed = 0.5,
      .known = {8.0, 5.0}};
  const Explained result = explained_by(found, "PUSH", set);
  ASSERT_FALSE(result.runs.empty());
  EXPECT_GE(value_of(found, result.runs.back().fitted, "RELAXATION.T1"), 4.0 * 0.005);
  EXPECT_LT(value_of(found, result.runs.back().fitted, "MASS.K"), 20.0);
}

TEST(Explained, WhatResistsWhereItsBlockDoesIsDrivenAsItIs) {
  const std::string machine =
      test::axis({"HY_COULOMB_FRICTION := (LEVEL := 0.4, PRESLIDE := 0.001)", "MASS.XOUT", ", V := LATE.XOUT"});
  const Given found =
      given(test::axis(), "[fit.MASS]\nK = {min = 0.0}\n",
            test::measured(test::program_of(machine), test::record_of("FORCE", test::rich_force()), noise), {noise});
  const SetFinding set{.space = "MASS.XOUT",
                       .laws = {{.effect = "coulomb_friction",
                                 .family = "dry_friction",
                                 .edge = "MASS.XOUT",
                                 .drivers = {"V"},
                                 .values = {{.name = "LEVEL", .value = 0.35, .error = 0.01, .unit = "'x"},
                                            {.name = "PRESLIDE", .value = 0.002}},
                                 .closed = 0.9}},
                       .closed = 0.9,
                       .known = {0.5}};
  const Explained result = explained_by(found, "AXIS", set);
  ASSERT_FALSE(result.runs.empty());
  EXPECT_THAT(result.runs.back().fitted.variant.text, Not(ContainsRegex("V := -")));
  EXPECT_THAT(result.runs.back().fitted.variant.text, Not(ContainsRegex("HY_DERIVATIVE")));
  EXPECT_NEAR(value_of(found, result.runs.back().fitted, "LEVEL"), 0.4, 0.02);
}

/// A position controller over a speed controller around an axis with friction; its reference is late by so many
/// samples.
std::string loop(double friction, int late) {
  const std::string reference = late > 0 ? "LATE.XOUT" : "REF";
  return fmt::format(
      "FUNCTION_BLOCK LOOP  (* @ts 2ms *)\n"
      "  VAR_INPUT REF : LREAL; END_VAR\n"
      "  VAR_OUTPUT Y : LREAL; U : LREAL; END_VAR\n"
      "  VAR\n    MEASURED : HY_DELAY;\n    RATE : HY_DERIVATIVE;\n    DRIVE : HY_GAIN := (K := 0.4);\n"
      "    DAMP : HY_GAIN := (K := 2.0);\n    SPEED : HY_INTEGRAL_FORWARD;\n    POSITION : HY_INTEGRAL;\n{}{}  "
      "END_VAR\n"
      "{}  RATE(XIN := MEASURED.XOUT);\n  U := 120.0 * (60.0 * ({} - MEASURED.XOUT) - RATE.XOUT);\n"
      "  DRIVE(XIN := U);\n  DAMP(XIN := SPEED.XOUT);\n  POSITION(XIN := SPEED.XOUT);\n"
      "  MEASURED(XIN := POSITION.XOUT);\n{}  SPEED(XIN := {});\n  Y := POSITION.XOUT;\nEND_FUNCTION_BLOCK\n",
      friction > 0.0 ? fmt::format("    F : HY_COULOMB_FRICTION := (LEVEL := {}, PRESLIDE := 0.0001);\n", friction)
                     : "",
      late > 0 ? "    LATE : HY_DELAY;\n" : "", late > 0 ? "  LATE(XIN := REF);\n" : "", reference,
      friction > 0.0 ? "  F(XIN := DRIVE.XOUT - DAMP.XOUT, V := SPEED.XOUT);\n" : "",
      friction > 0.0 ? "F.XOUT" : "DRIVE.XOUT - DAMP.XOUT");
}

std::vector<double> strokes() {
  std::vector<double> values;
  for (int k = 0; k < 3000; ++k) {
    values.push_back(0.05 * std::sin(0.002 * k * 3.1) + 0.02 * std::sin(0.002 * k * 8.7));
  }
  return values;
}

SetFinding friction_of_the_plant() {
  return {.space = "SPEED.XIN",
          .laws = {{.effect = "coulomb_friction",
                    .family = "dry_friction",
                    .edge = "SPEED.XIN",
                    .drivers = {"Y'"},
                    .values = {{.name = "LEVEL", .value = 0.22, .error = 0.01, .unit = "'x"},
                               {.name = "PRESLIDE", .value = 0.0001}},
                    .closed = 0.9}},
          .closed = 0.9,
          .known = {0.41, 1.9}};
}

constexpr std::string_view fit_of_loop = "[fit.DRIVE]\nK = {min = 0.01}\n[fit.DAMP]\nK = {min = 0.0}\n";

double rms_of_output(const Given& given, const VectorXd& residuals, Index output) {
  const Index rows = residuals.size() / std::ssize(given.task.outputs);
  return std::sqrt(residuals.segment(output * rows, rows).squaredNorm() / static_cast<double>(rows));
}

/// A position is measured so finely that its part of the cost outweighs the effort by far.
Given in_its_loop(int late) {
  records::Record record = test::record_of("REF", strokes(), 0.002);
  return given(loop(0.0, 0), std::string(fit_of_loop), test::measured(test::program_of(loop(0.25, late)), record, 0.0),
               {1e-7, 1e-2});
}

TEST(Explained, AroundAPlantWithFrictionALateReferenceIsFoundAndNoOutputPaysForIt) {
  const Given found = in_its_loop(1);
  const Explained result = explained_by(found, "LOOP", friction_of_the_plant(), true);
  ASSERT_FALSE(result.runs.empty());
  const Explanation& one = result.runs.back().fitted;
  EXPECT_EQ(one.variant.effects.size(), 2);
  EXPECT_LT(one.fit.cost, 0.05 * found.calibrated.fit.cost);
  for (const Index output : {0, 1}) {
    EXPECT_LT(rms_of_output(found, one.fit.residuals, output),
              rms_of_output(found, found.calibrated.fit.residuals, output))
        << output;
  }
  EXPECT_NEAR(value_of(found, one, "LEVEL"), 0.25, 0.03);
  EXPECT_NEAR(value_of(found, one, "DAMP.K"), 2.0, 0.5);
}

TEST(Explained, AroundAPlantThatIsAllNothingIsAdded) {
  const Given found = in_its_loop(0);
  const Explained result = explained_by(found, "LOOP", friction_of_the_plant(), true);
  ASSERT_FALSE(result.runs.empty());
  EXPECT_EQ(result.runs.back().fitted.variant.effects.size(), 1);
  EXPECT_NEAR(value_of(found, result.runs.back().fitted, "LEVEL"), 0.25, 0.01);
}

/// A pendulum whose drive works against a friction of nearly its own size: the calibrated drive is a tenth of the
/// machine's.
std::string pendulum(const std::string& friction = {}) {
  const std::string force = friction.empty() ? "ACC" : "F.XOUT";
  return "FUNCTION_BLOCK PENDULUM  (* @ts 5ms *)\n"
         "  VAR_INPUT U : LREAL;  (* @unit V *) END_VAR\n"
         "  VAR_OUTPUT Y : LREAL;  (* @unit rad *) END_VAR\n"
         "  VAR\n    DRIVE : HY_GAIN := (K := 40.0);\n    DAMP : HY_GAIN := (K := 3.0);\n"
         "    SPEED : HY_INTEGRAL_FORWARD;\n    ANGLE : HY_INTEGRAL_FORWARD;\n    ACC : LREAL;\n" +
         friction +
         "  END_VAR\n  DRIVE(XIN := U);\n  DAMP(XIN := SPEED.XOUT);\n"
         "  Y := ANGLE.XOUT;\n  ACC := DRIVE.XOUT - DAMP.XOUT - 40.0 * SIN(Y);\n  ANGLE(XIN := SPEED.XOUT);\n" +
         (friction.empty() ? "" : "  F(XIN := ACC, V := SPEED.XOUT);\n") + "  SPEED(XIN := " + force +
         ");\nEND_FUNCTION_BLOCK\n";
}

TEST(Explained, ALawThatMakesAMessOfARunEntersBehindTheOneThatClosesMost) {
  std::vector<double> voltage;
  for (int k = 0; k < 1500; ++k) {
    voltage.push_back(0.6 * std::sin(0.005 * k * 2.1) + 0.5 * std::sin(0.005 * k * 5.7));
  }
  const std::string machine = pendulum("    F : HY_COULOMB_FRICTION := (LEVEL := 12.0, PRESLIDE := 0.002);\n");
  const Given found = given(pendulum(), "[fit.DRIVE]\nK = {min = 1.0}\n[fit.DAMP]\nK = {min = 0.1}\n",
                            test::measured(test::program_of(machine), test::record_of("U", voltage), noise), {noise});
  const LawFinding friction{
      .effect = "coulomb_friction",
      .family = "dry_friction",
      .edge = "ACC",
      .drivers = {"SPEED.XOUT"},
      .values = {{.name = "LEVEL", .value = 8.0, .error = 0.1, .unit = "'x"}, {.name = "PRESLIDE", .value = 0.002}},
      .closed = 0.7};
  const LawFinding resonance{.effect = "resonance",
                             .family = "linear_dynamics",
                             .edge = "ACC",
                             .values = {{.name = "T", .value = 0.05}, {.name = "ZETA", .value = 0.1}},
                             .closed = 0.1};
  const Explained result = explained_by(
      found, "PENDULUM", {.space = "ACC", .laws = {resonance, friction}, .closed = 0.8, .known = {30.0, 3.0}});
  ASSERT_FALSE(result.runs.empty());
  const FittedSet& alone = result.runs.front();
  ASSERT_EQ(alone.fitted.variant.effects.size(), 1);
  EXPECT_EQ(alone.fitted.variant.effects.front().effect, "coulomb_friction");
  EXPECT_EQ(alone.set.laws.size(), 1);
  EXPECT_DOUBLE_EQ(alone.set.closed, 0.7);
  EXPECT_LT(alone.fitted.fit.cost, 0.05 * found.calibrated.fit.cost);
  for (std::size_t i = 1; i < result.runs.size(); ++i) {
    EXPECT_LT(result.runs[i].fitted.fit.cost, result.runs[i - 1].fitted.fit.cost);
  }
}

TEST(Explained, ALawWithoutAPlaceInTheTextIsNoPartOfARun) {
  const std::string machine =
      test::axis({"HY_COULOMB_FRICTION := (LEVEL := 0.4, PRESLIDE := 0.001)", "MASS.XOUT", ", V := LATE.XOUT"});
  const Given found =
      given(test::axis(), "[fit.MASS]\nK = {min = 0.0}\n",
            test::measured(test::program_of(machine), test::record_of("FORCE", test::rich_force()), noise), {noise});
  const LawFinding nowhere{.effect = "creep", .family = "slow_memory", .edge = "NOWHERE.XOUT", .closed = 0.5};
  const LawFinding friction{
      .effect = "coulomb_friction",
      .family = "dry_friction",
      .edge = "MASS.XOUT",
      .drivers = {"V"},
      .values = {{.name = "LEVEL", .value = 0.35, .error = 0.01, .unit = "'x"}, {.name = "PRESLIDE", .value = 0.002}},
      .closed = 0.4};
  const SetFinding alone{.space = "MASS.XOUT", .laws = {nowhere}, .closed = 0.5, .known = {0.5}};
  const Explained none = explained_by(found, "AXIS", alone);
  EXPECT_TRUE(none.runs.empty());
  EXPECT_FALSE(none.refuted);
  for (const std::vector<LawFinding>& laws : {std::vector{nowhere, friction}, std::vector{friction, nowhere}}) {
    const Explained result =
        explained_by(found, "AXIS", {.space = "MASS.XOUT", .laws = laws, .closed = 0.9, .known = {0.5}});
    ASSERT_EQ(result.runs.size(), 1);
    EXPECT_EQ(result.runs.front().fitted.variant.effects.size(), 1);
    EXPECT_EQ(result.runs.front().set.laws.size(), 1);
  }
}

}  // namespace
}  // namespace hysteron::diagnosis
