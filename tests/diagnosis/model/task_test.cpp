// What the user gives, as the task of a diagnosis.
#include "diagnosis/model/task.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <string>
#include <vector>

#include "diagnosis/model/least_squares.hpp"
#include "tests/diagnosis/simulated_machine.hpp"

namespace hysteron::diagnosis {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::UnorderedElementsAre;

records::Record plain() {
  return test::measured(test::program_of(test::axis()), test::record_of("FORCE", test::rich_force(400)), 0.001);
}

std::vector<std::string> remarks_for(const std::string& fit) {
  return remarks_on_bounds(
      task_of(test::input_of(test::axis(), "[parameters.MASS]\nK = 0.5\n[fit.MASS]\nK = " + fit + "\n", {plain()})));
}

TEST(Task, AValueOnABoundOfItsFitIsRemarkedOn) {
  EXPECT_THAT(remarks_for("{min = 0.1, max = 2.0}"), IsEmpty());
  EXPECT_THAT(remarks_for("{}"), IsEmpty());
  EXPECT_THAT(remarks_for("{max = 0.5}"),
              ElementsAre(AllOf(HasSubstr("MASS.K = 0.5"), HasSubstr("upper bound"), HasSubstr("Widen"))));
  EXPECT_THAT(remarks_for("{min = 0.4999, max = 0.9}"), ElementsAre(HasSubstr("lower bound"))) << "nearly is enough";
}

/// A block knows its units as 'y/'x; a reader wants those of his wires.
TEST(Task, UnitsAreThoseOfTheWires) {
  constexpr std::string_view plant = R"(FUNCTION_BLOCK PLANT  (* @ts 5ms *)
  VAR_INPUT U : LREAL; (* @unit V *) END_VAR
  VAR_OUTPUT Y : LREAL; (* @unit um *) END_VAR
  VAR AMP : HY_GAIN := (K := 2.0); END_VAR
  AMP(XIN := U);
  Y := AMP.XOUT;
END_FUNCTION_BLOCK
)";
  const auto log =
      test::measured(test::program_of(std::string(plant)), test::record_of("U", test::rich_force(400)), 0.001);
  for (const std::string fit : {"", "[fit.AMP]\nK = {}\n"}) {
    const Task task = task_of(test::input_of(std::string(plant), fit, {log}));
    ASSERT_EQ(task.known.size(), 1U);
    EXPECT_EQ(task.known.front().unit, "um/V") << fit;
  }
}

/// Each record of an axis with a force of its own that nobody has logged.
constexpr std::string_view biased = R"(FUNCTION_BLOCK AXIS  (* @ts 5ms *)
  VAR_INPUT
    FORCE : LREAL;
    BIAS  : LREAL := 0.0;  (* @param *)
  END_VAR
  VAR_OUTPUT V : LREAL; END_VAR
  VAR SPEED : HY_LAG := (T1 := 0.4, SETTLED := TRUE); END_VAR
  SPEED(XIN := FORCE + BIAS);
  V := SPEED.XOUT;
END_FUNCTION_BLOCK
)";

TEST(Task, ARecordsOwnParametersAreKnownOnceForEach) {
  std::vector<records::Record> days;
  for (const std::string bias : {"0.4", "-0.9"}) {
    days.push_back(test::measured(test::program_of(std::string(biased), "[parameters]\nBIAS = " + bias + "\n"),
                                  test::record_of("FORCE", test::rich_force(400)), 0.001));
  }
  Task task =
      task_of(test::input_of(std::string(biased), "[fit.SPEED]\nT1 = {}\n[fit.record]\nBIAS = {min = -3.0}\n", days));
  ASSERT_EQ(task.known.size(), 3U);
  EXPECT_FALSE(task.known[0].record);
  EXPECT_EQ(task.known[1].record, 0U);
  EXPECT_EQ(task.known[2].record, 1U);
  task.scales = {0.001};
  Model model(task, test::program_of(std::string(biased)));
  const Fit calibrated = fit(model, model.start());
  EXPECT_NEAR(calibrated.x[1], 0.4, 0.01);
  EXPECT_NEAR(calibrated.x[2], -0.9, 0.01);
}

TEST(Task, NoKnownParameterIsAModelAllTheSame) {
  const std::string text =
      "FUNCTION_BLOCK TWICE (* @ts 5ms *)\n  VAR_INPUT U : LREAL; END_VAR\n  VAR_OUTPUT Y : LREAL; END_VAR\n"
      "  Y := 2.0*U;\nEND_FUNCTION_BLOCK\n";
  const auto record = test::measured(test::program_of(text), test::record_of("U", test::rich_voltage(400)), 0.001);
  Task task = task_of(test::input_of(text, "", {record}));
  EXPECT_THAT(task.known, IsEmpty());
  task.scales = {0.001};
  Model model(task, test::program_of(text));
  VectorXd plain_residuals;
  VectorXd residuals;
  MatrixXd jacobian;
  ASSERT_TRUE(model.residuals(model.start(), plain_residuals));
  ASSERT_TRUE(model.residuals(model.start(), residuals, &jacobian));
  EXPECT_EQ(residuals, plain_residuals) << "also where derivatives by nothing are asked for";
  EXPECT_EQ(jacobian.cols(), 0);
  EXPECT_NEAR(fit(model, model.start()).cost, 200.0, 30.0) << "half a square of noise a sample";
}

std::vector<std::string> known(const std::string& gain, const std::string& annotation) {
  const std::string text =
      "FUNCTION_BLOCK PLANT (* @ts 1ms *) VAR_INPUT U : LREAL; " + gain + " : LREAL := 0.0; (* @param " + annotation +
      " *) END_VAR VAR_OUTPUT Y : LREAL; END_VAR VAR L : HY_LAG := (T1 := 0.1); D : HY_DELAY := (X0 := 2.0); END_VAR "
      "L(XIN := " +
      gain + " * U); D(XIN := L.XOUT); Y := D.XOUT; END_FUNCTION_BLOCK";
  records::Record record = test::record_of("U", std::vector<double>(20, 1.0));
  record.add({.name = "Y", .values = std::vector<double>(20, 1.0)});
  const DiagnosisInput input{.program = compile_text(text, {.top = "PLANT"}),
                             .file = parameters::parse_parameter_file("p.toml", "[parameters]\n" + gain + " = 2.0\n"),
                             .records = {record}};
  std::vector<std::string> names;
  for (const Unknown& one : task_of(input).known) {
    names.push_back(one.path);
  }
  return names;
}

TEST(Task, AParameterIsANumberOfTheMachineWhateverItsName) {
  EXPECT_THAT(known("GA", ""), UnorderedElementsAre("GA", "L.T1"));
  EXPECT_THAT(known("G0", ""), UnorderedElementsAre("G0", "L.T1"));
}

TEST(Task, WhatARecordBeginsWithIsNone) {
  // D.X0 by the description of HY_DELAY, GA by its own word.
  EXPECT_THAT(known("GA", "@role start"), UnorderedElementsAre("L.T1"));
}

}  // namespace
}  // namespace hysteron::diagnosis
