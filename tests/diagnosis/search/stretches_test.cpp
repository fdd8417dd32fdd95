// Multiple shooting: records in stretches, and sets that only these show.
#include "diagnosis/search/stretches.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <memory>
#include <string>

#include "diagnosis/model/task.hpp"
#include "diagnosis/search/search.hpp"
#include "tests/diagnosis/simulated_machine.hpp"

namespace hysteron::diagnosis {
namespace {

using testing::Contains;
using testing::Each;
using testing::ElementsAre;
using testing::SizeIs;
using testing::UnorderedElementsAre;

/// A motor, its damping and its position, which is measured; the speed half a step ago goes by a delay. `pull` is what
/// acts beside the motor.
std::string motor(std::string_view declarations = {}, std::string_view calls = {}, std::string_view pull = "M.XOUT") {
  return fmt::format(
      "FUNCTION_BLOCK MOTOR (* @ts 2ms *) VAR_INPUT U : LREAL; (* @unit A *) END_VAR "
      "VAR_OUTPUT Y : LREAL; (* @unit rad *) END_VAR "
      "VAR M : HY_GAIN := (K := 60.0); VEL : HY_INTEGRAL_FORWARD; D : HY_GAIN := (K := 4.0); BEFORE : HY_DELAY; "
      "POS : HY_INTEGRAL; {} END_VAR "
      "D(XIN := VEL.XOUT); POS(XIN := 0.5 * (VEL.XOUT + BEFORE.XOUT)); BEFORE(XIN := VEL.XOUT); Y := POS.XOUT; "
      "M(XIN := U); {} VEL(XIN := {} - D.XOUT); END_FUNCTION_BLOCK",
      declarations, calls, pull);
}

constexpr std::string_view motor_parameters =
    "[parameters.M]\nK = 61.0\n[parameters.D]\nK = 4.05\n[fit.M]\nK = {}\n[fit.D]\nK = {}\n";

/// Currents to and fro, now and then none.
std::vector<double> currents(std::size_t count = 2000) {
  std::vector<double> values;
  for (std::size_t k = 0; k < count; ++k) {
    const double t = 0.002 * static_cast<double>(k);
    const double sines = 0.9 * std::sin(test::two_pi * 0.6 * t) + 0.5 * std::sin(test::two_pi * 1.7 * t + 1.0);
    values.push_back(t < 0.2 || (t > 2.0 && t < 2.3) ? 0.0 : sines);
  }
  return values;
}

Task task_with(const std::string& machine, std::size_t rows = 2000) {
  Task task = task_of(
      test::input_of(motor(), motor_parameters,
                     {test::measured(test::program_of(machine), test::record_of("U", currents(rows), 0.002), 0.002)}));
  task.scales = {0.002};
  return task;
}

Explanation bare_of(const Task& task, const std::string& text) {
  Explanation bare{.variant = {.text = text, .program = std::make_shared<const Program>(compile_text(text))}};
  Model model(task, *bare.variant.program);
  bare.fit.x = model.start();
  return bare;
}

TEST(Stretches, FreeThePositionAndTheSpeedButNotWhatADelayHandsOn) {
  const Task task = task_with(motor());
  const std::optional<Task> cut = in_stretches(task, bare_of(task, motor()));
  ASSERT_TRUE(cut);
  EXPECT_THAT(cut->initial_states, UnorderedElementsAre("POS.SUM", "VEL.SUM"));
  ASSERT_THAT(cut->shooting->restarts, SizeIs(1));
  EXPECT_THAT(cut->shooting->restarts.front(), SizeIs(15));
  EXPECT_EQ(cut->shooting->restarts.front().front(), 125);
  EXPECT_THAT(cut->shooting->states, SizeIs(2 * 16));
}

TEST(Stretches, BeginWhereTheModelIs) {
  const Task task = task_with(motor());
  const Explanation bare = bare_of(task, motor());
  const std::optional<Task> cut = in_stretches(task, bare);
  ASSERT_TRUE(cut);
  Model whole(task, *bare.variant.program);
  Model model(*cut, *bare.variant.program);
  VectorXd residuals;
  VectorXd in_stretches;
  ASSERT_TRUE(whole.residuals(whole.start(), residuals));
  ASSERT_TRUE(model.residuals(model.start(), in_stretches));
  EXPECT_LT((residuals - in_stretches).cwiseAbs().maxCoeff(), 1e-6);
}

TEST(Stretches, AreNotForAPlantThatForgetsItsStart) {
  const DiagnosisInput input = test::input_of(
      test::stack(), test::stack_parameters,
      {test::measured(test::program_of(test::stack()), test::record_of("U", test::rich_voltage()), 0.02)});
  Task task = task_of(input);
  task.scales = {0.02};
  EXPECT_FALSE(in_stretches(task, bare_of(task, test::stack())));
}

TEST(Stretches, AreNotForAShortRecord) {
  const Task task = task_with(motor(), 190);
  EXPECT_FALSE(in_stretches(task, bare_of(task, motor())));
}

/// Over the whole record the model is soon at another tooth than the machine: without stretches the search ends 1.8
/// times above the floor.
TEST(Stretches, ShowACoulombFrictionBesideACogging) {
  const std::string machine = motor(
      "F : HY_COULOMB_FRICTION := (LEVEL := 30.0, PRESLIDE := 0.0001); C : HY_COGGING := (SINE := 8.0, PITCH := 1.0);",
      "C(XIN := M.XOUT, POS := POS.XOUT); F(XIN := C.XOUT, V := VEL.XOUT);", "F.XOUT");
  const Task task = task_with(machine);
  SearchOptions options{
      .candidates = {.effects = {"coulomb_friction", "stribeck_friction", "cogging", "load", "offset", "relaxation"}},
      .most_effects = 2};
  const Variant bare{.text = motor(), .program = std::make_shared<const Program>(compile_text(motor()))};
  const Search found = search(task, bare, "MOTOR", 0.5 * 2000.0, options);
  const Explanation& best = found.explanations.front();
  EXPECT_LT(best.fit.cost, 1.3 * 0.5 * 2000.0);
  EXPECT_THAT(best.names(), Contains("cogging"));
  // A Stribeck friction holds it, and fits no worse.
  EXPECT_TRUE(std::ranges::any_of(found.explanations, [&](const Explanation& one) {
    return one.names() == std::vector<std::string>{"cogging", "coulomb_friction"} && one.fit.cost < 1.1 * best.fit.cost;
  }));
}

}  // namespace
}  // namespace hysteron::diagnosis
