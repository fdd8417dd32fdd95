// Candidates: every effect that is known gets its turn, on every edge where it makes sense.
#include "diagnosis/effects/candidates.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <regex>
#include <set>
#include <string>

#include "codegen/trace/block_type.hpp"
#include "tests/diagnosis/simulated_machine.hpp"

namespace hysteron::diagnosis {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using testing::UnorderedElementsAre;

std::vector<Candidate> candidates(const std::string& text, const std::string& top, CandidateOptions options = {}) {
  const Variant base{.text = text, .program = std::make_shared<const Program>(compile_text(text, {.top = top}))};
  return candidates_of(base, top, options);
}

std::set<std::string> effects_in(const std::vector<Candidate>& list) {
  std::set<std::string> result;
  for (const Candidate& one : list) {
    result.insert(one.own().effect);
  }
  return result;
}

std::vector<std::string> edges_in(const std::vector<Candidate>& list) {
  std::vector<std::string> result;
  for (const Candidate& one : list) {
    result.push_back(one.own().edge);
  }
  return result;
}

/// A stack on an axis: a diagram that has a place for everything.
const std::string whole_machine = R"(FUNCTION_BLOCK MACHINE  (* @ts 5ms *)
  VAR_INPUT U : LREAL; W : LREAL; END_VAR
  VAR_OUTPUT Y : LREAL; END_VAR
  VAR AMP : HY_LAG := (T1 := 0.02); HYST : HY_HYSTERESIS_RO := (C2 := 1.0); SPEED : HY_INTEGRAL; END_VAR
  AMP(XIN := U);
  HYST(XIN := AMP.XOUT);
  SPEED(XIN := HYST.XOUT + W);
  Y := SPEED.XOUT;
END_FUNCTION_BLOCK
)";

TEST(Candidates, EveryEffectOfTheCatalogueIsTried) {
  std::set<std::string> catalogue;
  for (const BlockType& block : block_types()) {
    if (!block.about.effect.empty() && block.about.untried.empty()) {
      catalogue.emplace(block.about.effect);
    }
    for (const Field& field : block.params) {
      if (!field.effect.empty()) {
        catalogue.emplace(field.effect);
      }
    }
  }
  ASSERT_GE(catalogue.size(), 28U);
  EXPECT_EQ(effects_in(candidates(whole_machine, "MACHINE")), catalogue);
}

TEST(Candidates, AnEffectThatIsNotTriedByItselfIsTriedWhereItIsAskedFor) {
  const std::set<std::string> tried = effects_in(candidates(whole_machine, "MACHINE"));
  for (const BlockType& block : block_types()) {
    if (!block.about.untried.empty()) {
      const std::string effect(block.about.effect);
      EXPECT_THAT(tried, Not(Contains(effect)));
      EXPECT_THAT(effects_in(candidates(whole_machine, "MACHINE", {.effects = {effect}})), ElementsAre(effect));
    }
  }
}

TEST(Candidates, AnEffectIsTriedOnEachEdge) {
  const auto list = candidates(test::stack(), "STACK", {.effects = {"creep"}});
  EXPECT_THAT(edges_in(list), UnorderedElementsAre("U", "AMP.XOUT", "HYST.XOUT"));
  for (const Candidate& one : list) {
    EXPECT_EQ(one.own().block, "HY_CREEP");
    EXPECT_EQ(one.own().paths.size(), one.own().parameters.size());
    EXPECT_GE(find_parameter(one.variant.program->graph, one.own().instance + ".GAIN"), 0);
  }
}

TEST(Candidates, OnlyTheEffectsThatAreAskedFor) {
  EXPECT_THAT(effects_in(candidates(whole_machine, "MACHINE", {.effects = {"lag", "creep", "asymmetry"}})),
              UnorderedElementsAre("lag", "creep", "asymmetry"));
}

TEST(Candidates, ARicherBlockTakesTheInstancesPlace) {
  const auto list = candidates(test::stack(), "STACK", {.effects = {"asymmetry", "return_point_memory"}});
  EXPECT_EQ(effects_in(list).size(), 2U);
  for (const Candidate& one : list) {
    EXPECT_EQ(one.own().instance, "HYST");
    EXPECT_EQ(one.own().block, "HY_HYSTERESIS_GENERAL");
    const Graph& graph = one.variant.program->graph;
    const auto c2 = find_parameter(graph, "HYST.C2");
    ASSERT_GE(c2, 0);
    EXPECT_EQ(graph.parameters[static_cast<std::size_t>(c2)].value.front(), 4.0);  // what was set stays
  }
}

TEST(Candidates, ADeadBandThatTheDiagramHasIsSwitchedOn) {
  const auto list = candidates(test::stack(), "STACK", {.effects = {"branch_chatter"}});
  const auto freed = std::ranges::find(list, Change::Free, [](const Candidate& one) { return one.kind.change; });
  ASSERT_NE(freed, list.end());
  EXPECT_THAT(freed->own().paths, ElementsAre("HYST.EPS"));
  EXPECT_EQ(freed->variant.text, test::stack());
}

TEST(Candidates, AFrictionTakesTheVelocityAsItIsOrWhereThatIsALoopOneStepLate) {
  std::string forward = test::axis();
  forward.replace(forward.find("HY_INTEGRAL;"), 12, "HY_INTEGRAL_FORWARD;");
  const CandidateOptions frictions{.effects = {"coulomb_friction", "stribeck_friction", "viscous_friction"}};
  std::set<std::string> found;
  for (const Candidate& one : candidates(forward, "AXIS", frictions)) {
    found.insert(one.own().effect);
    EXPECT_THAT(one.variant.text, HasSubstr("V := SPEED.XOUT"));
    EXPECT_THAT(one.variant.text, Not(HasSubstr("HY_DELAY")));
  }
  for (const Candidate& one : candidates(test::axis(), "AXIS", frictions)) {
    found.erase(one.own().effect);
    const std::string delay = one.own().instance + "_V1";
    EXPECT_THAT(one.variant.text, HasSubstr(", V := " + delay + ".XOUT"));
    EXPECT_THAT(one.variant.text, HasSubstr(delay + "(XIN := SPEED.XOUT)"));
  }
  EXPECT_TRUE(found.empty()) << "the same frictions on either";
}

TEST(Candidates, FrictionTakesAVelocityFromABlockWithMemory) {
  const auto list = candidates(test::axis(), "AXIS", {.effects = {"coulomb_friction"}});
  ASSERT_FALSE(list.empty());
  for (const Candidate& one : list) {
    ASSERT_EQ(one.own().wires.size(), 1U);
    EXPECT_EQ(one.own().wires[0], std::pair(std::string("V"), std::string("SPEED.XOUT")));
  }
  EXPECT_THAT(edges_in(list), testing::Contains("FORCE"));
}

/// A load is no motion: any signal of the top block may be one, and a column becomes an input.
TEST(Candidates, AFrictionThatGrowsWithALoadIsWiredToIt) {
  for (const char* load : {"FORCE", "PRESSURE"}) {
    const auto list =
        candidates(test::axis(), "AXIS", {.effects = {"load_friction"}, .columns = {"PRESSURE"}, .loads = {load}});
    ASSERT_FALSE(list.empty());
    for (const Candidate& one : list) {
      EXPECT_THAT(one.own().wires, testing::ElementsAre(std::pair(std::string("V"), std::string("SPEED.XOUT")),
                                                        std::pair(std::string("W"), std::string(load))));
      EXPECT_EQ(one.auxiliary.size(), 2U);
      EXPECT_NE(find_port(one.variant.program->graph.inputs, load), nullptr);
    }
    EXPECT_THAT(edges_in(list), testing::Contains("FORCE"));
  }
  EXPECT_EQ(candidates(test::axis(), "AXIS", {.effects = {"load_friction"}}).front().auxiliary.size(), 1U);
}

/// A mass in a loop of position and speed.
const std::string servo = R"(FUNCTION_BLOCK SERVO  (* @ts 1ms *)
  VAR_INPUT
    REF : LREAL;  (* @unit mm *)
    KP : LREAL := 900.0; (* @param @unit N/mm *)
    KD : LREAL := 40.0; (* @param @unit N*s/mm *)
    M : LREAL := 0.5; (* @param @unit N*s^2/mm *)
  END_VAR
  VAR_OUTPUT X : LREAL;  (* @unit mm *) END_VAR
  VAR VEL : HY_INTEGRAL_FORWARD; POS : HY_INTEGRAL_FORWARD; SUM : HY_INTEGRAL_FORWARD; FORCE : LREAL; END_VAR
  FORCE := KP * (REF - POS.XOUT) - KD * VEL.XOUT;
  POS(XIN := VEL.XOUT);
  VEL(XIN := FORCE / M);
  SUM(XIN := FORCE);
  X := POS.XOUT;
END_FUNCTION_BLOCK
)";

std::string without_units(const std::string& text) {
  return std::regex_replace(text, std::regex("@unit [^ ]+ "), "");
}

std::set<std::string> velocities_at(const std::vector<Candidate>& list, std::string_view edge) {
  std::set<std::string> result;
  for (const Candidate& one : list) {
    if (one.own().edge == edge) {
      result.insert(one.own().wires.at(0).second);
    }
  }
  return result;
}

TEST(Candidates, APositionIsNoVelocityAndIsNotSlowed) {
  const CandidateOptions frictions{.effects = {"coulomb_friction", "viscous_friction"}};
  std::string text = servo;
  text.erase(text.find("  SUM(XIN"), 21);
  text.erase(text.find("SUM : HY"), 27);
  const auto with_units = candidates(text, "SERVO", frictions);
  const auto without = candidates(without_units(text), "SERVO", frictions);
  for (const auto* const list : {&with_units, &without}) {
    EXPECT_THAT(velocities_at(*list, "FORCE"), ElementsAre("VEL.XOUT"));
    EXPECT_THAT(velocities_at(*list, "POS.XOUT"), ElementsAre());
  }
  for (const Candidate& one : with_units) {
    EXPECT_EQ(one.own().wires.at(0).second, "VEL.XOUT") << one.own().effect << " at " << one.own().edge;
    EXPECT_THAT(one.own().edge, testing::Not(testing::AnyOf("POS.XIN", "VEL.XOUT")));
  }
}

TEST(Candidates, TheIntegralPartOfALoopIsNoVelocity) {
  std::string text = without_units(servo);
  text.replace(text.find("SUM(XIN := FORCE)"), 17, "SUM(XIN := REF - VEL.XOUT)");
  text.replace(text.find("KD * VEL.XOUT"), 13, "KD * VEL.XOUT + SUM.XOUT");
  EXPECT_THAT(velocities_at(candidates(text, "SERVO", {.effects = {"viscous_friction"}}), "FORCE"),
              ElementsAre("VEL.XOUT"));
}

TEST(Candidates, ALengthIsNoVelocityWhateverItComesFrom) {
  // Of a slide whose speed is commanded, the model has no velocity.
  const std::string slide =
      "FUNCTION_BLOCK SLIDE (* @ts 1ms *) VAR_INPUT V : LREAL; END_VAR VAR_OUTPUT X : LREAL; {} END_VAR VAR POS : "
      "HY_INTEGRAL_FORWARD; END_VAR POS(XIN := V); X := POS.XOUT; END_FUNCTION_BLOCK";
  const CandidateOptions friction{.effects = {"viscous_friction"}};
  EXPECT_TRUE(candidates(fmt::format(fmt::runtime(slide), "(* @unit mm *)"), "SLIDE", friction).empty());
  EXPECT_FALSE(candidates(fmt::format(fmt::runtime(slide), "(* @unit mm/s *)"), "SLIDE", friction).empty());
}

TEST(Candidates, OfAMassOnASpringTheRateIsTheVelocity) {
  const std::string stage =
      "FUNCTION_BLOCK STAGE (* @ts 1ms *) VAR_INPUT U : LREAL; (* @unit V *) END_VAR VAR_OUTPUT Y : LREAL; END_VAR VAR "
      "COIL : HY_LAG := (T1 := 0.002); FORCE : HY_GAIN := (K := 0.2); FLEX : HY_SECOND_ORDER := (T := 0.01, ZETA := "
      "0.1); END_VAR COIL(XIN := U); FORCE(XIN := COIL.XOUT); FLEX(XIN := FORCE.XOUT); Y := FLEX.XOUT; "
      "END_FUNCTION_BLOCK";
  const auto list = candidates(stage, "STAGE", {.effects = {"viscous_friction"}});
  // Not the position, nor what the spring lacks to its rest; the coil's current is a voltage by its unit.
  EXPECT_THAT(velocities_at(list, "FORCE.XOUT"), ElementsAre("FLEX.RATE"));
  EXPECT_THAT(velocities_at(list, "U"), ElementsAre());
}

TEST(Candidates, ALagIsAVelocityWhereItsUnitIsOne) {
  const std::string room =
      "FUNCTION_BLOCK ROOM (* @ts 30s *) VAR_INPUT P : LREAL; {} END_VAR VAR_OUTPUT T : LREAL; END_VAR VAR RADIATOR : "
      "HY_LAG := (T1 := 600.0); END_VAR RADIATOR(XIN := P); T := RADIATOR.XOUT; END_FUNCTION_BLOCK";
  const CandidateOptions friction{.effects = {"viscous_friction"}};
  EXPECT_TRUE(candidates(fmt::format(fmt::runtime(room), "(* @unit kW *)"), "ROOM", friction).empty());
  for (const Candidate& one : candidates(fmt::format(fmt::runtime(room), ""), "ROOM", friction)) {
    EXPECT_EQ(one.own().wires.at(0).second, "RADIATOR.XOUT") << "its rate is what drives it, less itself";
  }
  EXPECT_FALSE(candidates(fmt::format(fmt::runtime(room), "(* @unit m/s *)"), "ROOM", friction).empty());
}

TEST(Candidates, ARippleIsOverAPositionByItsUnit) {
  const CandidateOptions ripple{.effects = {"cogging"}};
  std::set<std::string> signals;  // what it is periodic in: POS, or the signal itself
  for (const Candidate& one : candidates(servo, "SERVO", ripple)) {
    signals.insert(one.own().wires.empty() ? one.own().edge : one.own().wires.at(0).second);
  }
  EXPECT_THAT(signals, UnorderedElementsAre("REF", "POS.XOUT", "X"));
  std::set<std::string> without;
  for (const Candidate& one : candidates(without_units(servo), "SERVO", ripple)) {
    without.insert(one.own().wires.empty() ? one.own().edge : one.own().wires.at(0).second);
  }
  EXPECT_THAT(without, testing::IsSupersetOf({"REF", "POS.XOUT", "VEL.XOUT", "FORCE"}));
}

TEST(Candidates, AClockIsTheRecords) {
  EXPECT_THAT(edges_in(candidates(whole_machine, "MACHINE", {.effects = {"clock"}})),
              UnorderedElementsAre("U", "W", "SPEED.XOUT"));
}

/// The edges on which an effect is where numbers come in or go out.
std::vector<std::string> places_in(std::vector<Candidate> list) {
  std::erase_if(list, [](const Candidate& one) { return one.own().is_displaced; });
  return edges_in(list);
}

TEST(Candidates, AConverterBetweenTwoPartsIsDisplaced) {
  EXPECT_THAT(places_in(candidates(whole_machine, "MACHINE", {.effects = {"quantization"}})),
              UnorderedElementsAre("U", "W", "SPEED.XOUT"));
  for (const Candidate& other : candidates(whole_machine, "MACHINE", {.effects = {"lag", "backlash"}})) {
    EXPECT_FALSE(other.own().is_displaced) << other.own().effect;
  }
}

// An encoder is where the controller reads it, too; and it is read through what a delay on the way has changed.
TEST(Candidates, AConverterIsWhereverTheSignalOfAPortIsRead) {
  const std::string loop = R"(FUNCTION_BLOCK AXIS  (* @ts 1ms *)
  VAR_INPUT F : LREAL; END_VAR
  VAR_OUTPUT X : LREAL; END_VAR
  VAR SPEED : HY_INTEGRAL; POSITION : HY_INTEGRAL; END_VAR
  SPEED(XIN := F);
  POSITION(XIN := SPEED.XOUT);
  X := POSITION.XOUT;
END_FUNCTION_BLOCK
FUNCTION_BLOCK LOOP  (* @ts 1ms *)
  VAR_INPUT REF : LREAL; END_VAR
  VAR_OUTPUT Y : LREAL; END_VAR
  VAR LATE : HY_DELAY; GAIN : HY_GAIN; BOUND : HY_LIMIT; PLANT : AXIS; END_VAR
  GAIN(XIN := REF - LATE.XOUT);
  BOUND(XIN := GAIN.XOUT);
  PLANT(F := BOUND.XOUT);
  LATE(XIN := PLANT.X);
  Y := PLANT.X;
END_FUNCTION_BLOCK
)";
  const CandidateOptions asked{.effects = {"quantization"}, .again = true};
  const auto alone = candidates(loop, "LOOP", asked);
  EXPECT_THAT(places_in(alone), UnorderedElementsAre("REF", "PLANT.X", "Y", "LATE.XIN", "PLANT.POSITION.XOUT"));
  const auto delayed = candidates(loop, "LOOP", {.effects = {"delay"}});
  const auto at_output = std::ranges::find(delayed, "Y", [](const Candidate& one) { return one.own().edge; });
  ASSERT_NE(at_output, delayed.end());
  EXPECT_THAT(places_in(candidates_of(at_output->variant, "LOOP", asked)),
              testing::IsSupersetOf({"REF", "PLANT.X", "LATE.XIN"}));
}

TEST(Candidates, AnotherInputOrColumnMayCouple) {
  const auto inputs = candidates(whole_machine, "MACHINE", {.effects = {"cross_coupling"}});
  std::set<std::string> drivers;
  for (const Candidate& one : inputs) {
    drivers.insert(one.own().wires.at(0).second);
    EXPECT_NE(one.own().wires.at(0).second, one.own().edge);
  }
  EXPECT_THAT(drivers, UnorderedElementsAre("U", "W"));

  const auto columns = candidates(test::stack(), "STACK", {.effects = {"cross_coupling"}, .columns = {"TEMP"}});
  EXPECT_THAT(edges_in(columns), testing::IsSupersetOf({"U", "AMP.XOUT", "HYST.XOUT"}));
  int with_column = 0;
  for (const Candidate& one : columns) {
    const auto& ports = one.variant.program->graph.inputs;
    with_column += std::ranges::any_of(ports, [](const Port& port) { return port.name == "TEMP"; }) ? 1 : 0;
  }
  EXPECT_EQ(with_column, 3);
}

TEST(Candidates, ACoupledColumnReachesTheOutput) {
  const auto columns = candidates(test::axis(), "AXIS", {.effects = {"cross_coupling"}, .columns = {"TEMP"}});
  const auto at_output = std::ranges::find_if(columns, [](const Candidate& one) {
    return one.own().edge == "SPEED.XOUT" && one.own().wires.at(0).second == "TEMP";
  });
  ASSERT_NE(at_output, columns.end());
  Program program = *at_output->variant.program;
  parameters::apply(
      parameters::parse_parameter_file("p.toml", "[parameters." + at_output->own().instance + "]\nGAIN = 3.0\n"),
      program.graph);
  records::Record record = test::record_of("FORCE", std::vector<double>(4, 0.0));
  record.add({.name = "temp", .values = {2.0, 2.0, 2.0, 2.0}});
  EXPECT_DOUBLE_EQ(simulate(program, record)[0].back(), 6.0);  // no force, so nothing but GAIN·TEMP
}

const std::string with_own_effect = R"(FUNCTION_BLOCK SAG  (* @effect sag *)
  VAR_INPUT
    XIN : LREAL;
    SIZE : LREAL := 0.0;   (* @neutral 0 *)
    HALF : LREAL := 1.0;   (* @param @min 0.1 *)
  END_VAR
  VAR_OUTPUT XOUT : LREAL; END_VAR
  XOUT := XIN - SIZE * XIN * XIN / (HALF + XIN * XIN);
END_FUNCTION_BLOCK
)";

TEST(Candidates, AnEffectOfTheUsersOwnJoins) {
  const auto list = candidates(with_own_effect + test::axis(), "AXIS", {.effects = {"sag"}});
  EXPECT_THAT(edges_in(list), UnorderedElementsAre("FORCE", "MASS.XOUT", "SPEED.XOUT"));
  ASSERT_EQ(list.front().kind.parameters.size(), 2U);
  for (const EffectParameter& one : list.front().kind.parameters) {
    EXPECT_EQ(one.strength, one.name == "SIZE");
  }
  EXPECT_EQ(list.front().own().block, "SAG");
}

/// A diagram with parameters of its own and an effect of its own, under other names.
std::string renamed(std::string text, const std::vector<std::pair<std::string, std::string>>& names) {
  for (const auto& [from, to] : names) {
    text = std::regex_replace(text, std::regex("\\b" + from + "\\b"), to);
  }
  return text;
}

TEST(Candidates, TheNamesOfParametersDecideNothing) {
  std::string axis = test::axis();
  axis.replace(axis.find("VAR_OUTPUT"), 10, "VAR_INPUT STIFF : LREAL := 3.0; (* @param *) END_VAR VAR_OUTPUT");
  axis.replace(axis.find("XIN := FORCE"), 12, "XIN := FORCE * STIFF");
  const auto shapes = [](const std::string& text) {
    std::vector<std::string> result;
    for (const Candidate& one : candidates(text, "AXIS")) {
      result.push_back(one.own().effect + " " + one.own().edge);
      for (const EffectParameter& parameter : one.own().parameters) {
        result.back() += fmt::format(" {}{}", static_cast<int>(parameter.role), parameter.strength ? "!" : "");
      }
    }
    return result;
  };
  const std::vector<std::string> expected = shapes(with_own_effect + axis);
  const int other = static_cast<int>(Role::Other);
  ASSERT_THAT(expected, Contains(fmt::format("sag FORCE {}! {}", other, other)));
  for (const char* name : {"X0", "T_ON", "PITCH", "QUANTUM", "SPREAD", "CENTRE", "A_REFERENCE", "DEAD_TIME", "MN"}) {
    EXPECT_EQ(shapes(renamed(with_own_effect + axis, {{"SIZE", name}})), expected) << name;
    EXPECT_EQ(shapes(renamed(with_own_effect + axis, {{"HALF", name}})), expected) << name;
    EXPECT_EQ(shapes(renamed(with_own_effect + axis, {{"STIFF", name}})), expected) << name;
  }
}

TEST(Candidates, ABlockWithoutANeutralSettingIsNoEffect) {
  std::string text = with_own_effect;
  text.replace(text.find("@neutral 0"), 10, "@param");
  EXPECT_TRUE(candidates(text + test::axis(), "AXIS", {.effects = {"sag"}}).empty());
}

TEST(Candidates, AnEffectThatIsThereIsNotTriedTwice) {
  const auto first = candidates(test::stack(), "STACK", {.effects = {"creep"}});
  const auto second = candidates_of(first.front().variant, "STACK", {.effects = {"creep", "lag"}});
  EXPECT_EQ(effects_in(second), std::set<std::string>{"lag"});
  for (const Candidate& one : second) {
    EXPECT_EQ(one.variant.effects.size(), 2U);
  }
}

TEST(Candidates, WhatABlockGotWithAnEffectIsNoParameterOfTheDiagram) {
  const auto chatter = candidates(test::stack(), "STACK", {.effects = {"branch_chatter"}});
  ASSERT_FALSE(chatter.empty());
  EXPECT_TRUE(chatter.front().own().is_own);
  const auto richer = candidates(test::stack(), "STACK", {.effects = {"asymmetry"}});
  ASSERT_FALSE(richer.empty());
  EXPECT_FALSE(richer.front().own().is_own);
  const auto second = candidates_of(richer.front().variant, "STACK", {.effects = {"curve_shape"}});
  ASSERT_FALSE(second.empty());
  EXPECT_FALSE(second.front().own().is_own);
}

TEST(Candidates, WiresThatServeAnEffectAreNoEdgesOfTheMachine) {
  const auto first = candidates(test::axis(), "AXIS", {.effects = {"coulomb_friction"}});
  ASSERT_FALSE(first.empty());
  const Applied& friction = first.front().own();
  ASSERT_EQ(friction.delay, friction.instance + "_V1");
  const auto second = candidates_of(first.front().variant, "AXIS", {.effects = {"offset"}});
  EXPECT_THAT(edges_in(second), Contains(HasSubstr(friction.instance + ".XOUT")));
  for (const char* end : {".V", "_V1.XIN", "_V1.XOUT"}) {
    EXPECT_THAT(edges_in(second), Not(Contains(friction.instance + end)));
  }
  EXPECT_GE(edges_of_text(first.front().variant.text, "AXIS").size(), edges_in(second).size());
}

}  // namespace
}  // namespace hysteron::diagnosis
