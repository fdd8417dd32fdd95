// The improved diagram as the user gets it: a text that every command takes, and parameters that can be fitted.
#include "diagnosis/remedy/improved.hpp"

#include <gmock/gmock.h>

#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "tests/diagnosis/simulated_machine.hpp"

namespace hysteron::diagnosis {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::Not;

/// A heater whose loss depends on its temperature, with a comment to each statement; a servo in a block of its own.
constexpr std::string_view heater = R"(FUNCTION_BLOCK HEATER  (* @ts 1s *)
  VAR_INPUT
    P : LREAL;  (* @unit W *)
  END_VAR
  VAR_OUTPUT
    TEMP : LREAL;  (* @unit degC *)
  END_VAR
  VAR
    G : HY_GAIN := (K := 0.6);
    L : HY_LAG  := (T1 := 60.0);
  END_VAR

  (* what a watt is worth *)
  G(XIN := P);
  L(XIN := G.XOUT);      (* the mass *)
  TEMP := L.XOUT + 20.0;
END_FUNCTION_BLOCK
)";

constexpr std::string_view servo = R"(FUNCTION_BLOCK DRIVE
  VAR_INPUT
    FORCE : LREAL;
  END_VAR
  VAR_OUTPUT
    V : LREAL;
  END_VAR
  VAR
    MASS  : HY_GAIN := (K := 0.5);
    SPEED : HY_INTEGRAL;
  END_VAR

  MASS(XIN := 2.0 * FORCE - 0.1);
  SPEED(XIN := MASS.XOUT);
  V := SPEED.XOUT;
END_FUNCTION_BLOCK

FUNCTION_BLOCK SERVO  (* @ts 1ms *)
  VAR_INPUT
    U : LREAL;
  END_VAR
  VAR_OUTPUT
    Y : LREAL;
  END_VAR
  VAR
    D : DRIVE;
    X : HY_INTEGRAL;
  END_VAR

  D(FORCE := U);
  X(XIN := D.V);
  Y := X.XOUT;
END_FUNCTION_BLOCK
)";

std::vector<Candidate> all_candidates(const std::string& text, const std::string& top) {
  const Variant base{.text = text, .program = std::make_shared<const Program>(compile_text(text, {.top = top}))};
  return candidates_of(base, top, {});
}

/// The outputs with all strengths of the effect away from neutral.
std::vector<Signal> moved(Program program, const Applied& applied, const records::Record& record) {
  for (std::size_t k = 0; k < applied.paths.size(); ++k) {
    if (applied.parameters[k].strength) {
      set_parameter(program.graph, applied.paths[k], applied.parameters[k].field.neutral + 0.01);
    }
  }
  return simulate(std::move(program), record);
}

TEST(Improved, EveryInsertionThatClosesALoopStandsInAnOrder) {
  const struct {
    std::string text;
    std::string top;
    std::string input;
  } plants[] = {
      {std::string(heater), "HEATER", "P"}, {std::string(servo), "SERVO", "U"}, {test::axis(), "AXIS", "FORCE"}};
  std::set<std::string> rewritten;
  for (const auto& [text, top, input] : plants) {
    ASSERT_EQ(hidden_delays(text), 0U) << top;
    const double sample_time = compile_text(text, {.top = top}).graph.sample_time();
    const records::Record record = test::record_of(input, test::rich_force(200), sample_time);
    for (const Candidate& one : all_candidates(text, top)) {
      SCOPED_TRACE(top + ": " + one.own().effect + " at " + one.own().edge);
      const std::string improved = improved_text(one.variant, "improved.st");
      Program program;
      ASSERT_NO_THROW(program = compile_text(improved, {.top = top, .any_order = false})) << improved;
      Diagnostics none;
      ASSERT_EQ(format_text("improved.st", improved, none), improved);
      const std::string own = one.own().instance.substr(one.own().instance.rfind('.') + 1);
      if (improved.find(own + "(XIN := 0.0") == std::string::npos) {
        continue;
      }
      rewritten.insert(one.own().effect);
      const auto before = moved(*one.variant.program, one.own(), record);
      const auto after = moved(program, one.own(), record);
      ASSERT_EQ(before.size(), after.size());
      for (std::size_t i = 0; i < before.size(); ++i) {
        ASSERT_EQ(before[i], after[i]);
      }
    }
  }
  EXPECT_THAT(rewritten, Contains("cogging"));
}

TEST(Improved, TheUsersCommentsStayWithTheirStatements) {
  std::string pusher(heater);
  pusher.replace(pusher.find("degC"), 4, "mm");  // of wax, say: a position, over which there may be a ripple
  for (const Candidate& one : all_candidates(pusher, "HEATER")) {
    if (one.own().effect != "cogging" || one.own().edge != "P") {
      continue;
    }
    const std::string improved = improved_text(one.variant, "improved.st");
    EXPECT_THAT(improved, HasSubstr("  (* what a watt is worth *)\n  G(XIN := P + P_COGGING.XOUT);\n"));
    EXPECT_THAT(improved, HasSubstr("L(XIN := G.XOUT);  (* the mass *)\n"));
    EXPECT_THAT(improved, HasSubstr("P_COGGING(XIN := 0.0, POS := L.XOUT);\n"));
    return;
  }
  FAIL() << "no cogging at P";
}

TEST(Improved, WhatStandsInAnOrderIsNotRewritten) {
  // The speed comes from the memory alone: the friction is called before it, as a user would write it.
  std::string forward = test::axis();
  forward.replace(forward.find("HY_INTEGRAL;"), 12, "HY_INTEGRAL_FORWARD;");
  for (const Candidate& one : all_candidates(forward, "AXIS")) {
    EXPECT_THAT(improved_text(one.variant, "improved.st"), Not(HasSubstr("XIN := 0.0"))) << one.own().effect;
  }
}

TEST(Improved, AnEffectOfTheUsersOwnMayHaveNoOrder) {
  // Nothing says that its XOUT is a sum: it stays as it is, and the diagnosis remarks that --any-order is needed.
  const std::string drag =
      "FUNCTION_BLOCK DRAG (* @effect drag *) VAR_INPUT XIN : LREAL; V : LREAL; SIZE : LREAL := 0.0; (* @neutral 0 *) "
      "END_VAR VAR_OUTPUT XOUT : LREAL; END_VAR VAR Z : HY_DELAY; END_VAR XOUT := XIN - SIZE * Z.XOUT; Z(XIN := V); "
      "END_FUNCTION_BLOCK\n";
  std::size_t without_order = 0;
  for (const Candidate& one : all_candidates(drag + test::axis(), "AXIS")) {
    const std::string improved = improved_text(one.variant, "improved.st");
    if (one.own().effect == "drag" && hidden_delays(improved) > 0) {
      ++without_order;
      EXPECT_NO_THROW((void)compile_text(improved, {.top = "AXIS", .any_order = true}));
      EXPECT_THAT(improved, Not(HasSubstr("XIN := 0.0")));
    }
  }
  EXPECT_GT(without_order, 0U);
}

/// An effect of two parameters, of which the second moves nothing.
TEST(Improved, AParameterWithoutInfluenceIsNotFittedFurther) {
  Explanation one;
  one.variant.further = {{.path = "E.LEVEL", .typical = 1.0}, {.path = "E.SPREAD", .typical = 1.0}};
  one.fit.x = VectorXd::Constant(3, 0.5);
  one.fit.jacobian = MatrixXd::Zero(4, 3);
  one.fit.jacobian.col(0).setOnes();
  one.fit.jacobian.col(1).setConstant(-0.2);
  one.fit.jacobian(2, 2) = 1e-9;
  EXPECT_TRUE(has_influence(one.fit, 1, 1.0));
  EXPECT_FALSE(has_influence(one.fit, 2, 1.0));
  Task task;
  task.known = {{.path = "G.K"}};
  const auto file = improved_file(
      task, parameters::parse_parameter_file("p.toml", "[parameters.G]\nK = 1.0\n[fit.G]\nK = {}\n"), one);
  const std::string text = parameters::parameter_text(file, {}, "");
  EXPECT_THAT(text, HasSubstr("[fit.E]\nLEVEL = {}\n"));
  EXPECT_THAT(text, Not(HasSubstr("SPREAD = {}")));
  EXPECT_THAT(text, HasSubstr("SPREAD = 0.5")) << "its value stays";
}

}  // namespace
}  // namespace hysteron::diagnosis
