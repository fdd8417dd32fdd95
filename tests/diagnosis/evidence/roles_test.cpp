// What makes sense where: which effects a place can have.
#include "diagnosis/evidence/roles.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "blocks/families.hpp"
#include "codegen/compile.hpp"
#include "diagnosis/effects/motions.hpp"

namespace hysteron::diagnosis {
namespace {

EffectKind kind_of(const std::string& effect) {
  Diagnostics none;
  const auto source = std::make_shared<const language::SourceFile>(language::parse("text", "", none));
  const std::vector<EffectKind> kinds = effect_kinds(define(source, none));
  return *std::ranges::find(kinds, effect, &EffectKind::id);
}

TEST(Roles, ABalanceIsNoSignalThatAPartPassesOn) {
  Space::Place place{.unit = "rad/s^2", .is_balance = true};
  for (const std::string effect : {"backlash", "dead_zone", "saturation", "odd_nonlinearity", "rate_limit"}) {
    EXPECT_FALSE(may_act_on(kind_of(effect), place)) << effect;
  }
  for (const std::string effect : {"coulomb_friction", "load", "offset", "periodic_disturbance", "delay"}) {
    EXPECT_TRUE(may_act_on(kind_of(effect), place)) << effect;
  }
  place.is_balance = false;  // one force, as that of an actuator
  EXPECT_TRUE(may_act_on(kind_of("saturation"), place));
}

TEST(Roles, AFrictionIsAForce) {
  for (const std::string unit : {"m", "rad", "m/s", "degC", "%"}) {
    EXPECT_FALSE(may_act_on(kind_of("coulomb_friction"), {.unit = unit})) << unit;
  }
  EXPECT_TRUE(may_act_on(kind_of("coulomb_friction"), {.unit = "N"}));
}

/// As the diagram runs: where a reference moves nearly as the axis does, the two are one signal, and none of them is
/// exactly in proportion to what the edge carries.
TEST(Roles, AForceInProportionToASpeedCarriesAVelocity) {
  Space::Place place{.unit = "m/s^2"};
  EXPECT_FALSE(carries_velocity(place, {}));
  place.is_of_velocity = true;
  EXPECT_TRUE(carries_velocity(place, {}));
}

TEST(Roles, AMotionThatIsGivenIsWorkedOutOfTheRecord) {
  Space::Place place{.unit = "m/s^2", .is_given_motion = true};
  for (const std::string effect : {"delay", "lag", "resonance", "creep", "relaxation"}) {
    EXPECT_FALSE(may_act_on(kind_of(effect), place)) << effect;
  }
  EXPECT_TRUE(may_act_on(kind_of("coulomb_friction"), place));
  EXPECT_TRUE(may_act_on(kind_of("odd_nonlinearity"), place)) << "a spring";
  place.is_differentiated = true;
  EXPECT_FALSE(may_act_on(kind_of("odd_nonlinearity"), place));
  EXPECT_TRUE(may_act_on(kind_of("delay"), {.unit = "m", .is_port = true, .is_given_motion = true}))
      << "a sensor that is late";
}

TEST(Motions, WhichInputASignalIsTheMotionOf) {
  const Program program = compile_text(R"(FUNCTION_BLOCK P
VAR_INPUT X : LREAL; P : LREAL; END_VAR VAR_OUTPUT F : LREAL; G : LREAL; END_VAR
VAR V : HY_DERIVATIVE_FILTERED := (T1 := 0.01); A : HY_DERIVATIVE; M : HY_GAIN; I : HY_INTEGRAL; END_VAR
V(XIN := X); A(XIN := V.XOUT); M(XIN := A.XOUT); I(XIN := X + P); F := M.XOUT; G := I.XOUT;
END_FUNCTION_BLOCK)",
                                       {.any_order = true});
  const Graph& graph = program.graph;
  const Port* const input = followed_input(graph, find_port(graph.outputs, "F")->wire);
  ASSERT_NE(input, nullptr);
  EXPECT_EQ(input->name, "X");
  EXPECT_EQ(followed_input(graph, find_port(graph.outputs, "G")->wire), nullptr);
  EXPECT_TRUE(leads_to_rates(graph, "V"));
  EXPECT_FALSE(leads_to_rates(graph, "A"));
  EXPECT_FALSE(leads_to_rates(graph, "I")) << "nobody reads it";
}

TEST(Motions, WhatASignalIsAConstantTimesOf) {
  const Program program = compile_text(R"(FUNCTION_BLOCK P
VAR_INPUT U : LREAL; N : LREAL := 2.0; (* @param *) END_VAR VAR_OUTPUT Y : LREAL; Z : LREAL; W : LREAL; END_VAR
VAR A : HY_GAIN; B : HY_INTEGRAL_FORWARD; C : HY_GAIN; END_VAR
B(XIN := U); A(XIN := -(N * B.XOUT) / 3.0); C(XIN := B.XOUT * U); Y := A.XOUT; Z := C.XOUT; W := 2.0 * U;
END_FUNCTION_BLOCK)",
                                       {.any_order = true});
  const Graph& graph = program.graph;
  const Wire of_gains = without_gains(graph, find_port(graph.outputs, "Y")->wire);
  ASSERT_EQ(of_gains.from, Wire::From::Node);
  EXPECT_EQ(graph.nodes[of_gains.index].path, "B");
  const Wire of_product = without_gains(graph, find_port(graph.outputs, "Z")->wire);
  ASSERT_EQ(of_product.from, Wire::From::Node);
  EXPECT_NE(graph.nodes[of_product.index].path, "B") << "two signals";
  EXPECT_EQ(without_gains(graph, find_port(graph.outputs, "W")->wire).from, Wire::From::Input);
}

TEST(Balance, IsASumThatIsIntegrated) {
  const Program program = compile_text(R"(FUNCTION_BLOCK P
VAR_INPUT U : LREAL; END_VAR VAR_OUTPUT Y : LREAL; Z : LREAL; END_VAR
VAR A : HY_GAIN; B : HY_INTEGRAL_FORWARD; C : HY_GAIN; END_VAR
A(XIN := U - B.XOUT); B(XIN := A.XOUT + U); C(XIN := B.XOUT + U); Y := B.XOUT; Z := C.XOUT;
END_FUNCTION_BLOCK)",
                                       {.any_order = true});
  const Graph& graph = program.graph;
  const auto wire_of = [&](std::string_view path) {
    return graph.wire(*std::ranges::find(graph.nodes, path, &Node::path), 0);
  };
  // What a node passes on: here the sum itself is what the integral reads.
  const Wire sum = wire_of("B");
  ASSERT_EQ(sum.from, Wire::From::Node);
  EXPECT_TRUE(is_balance(graph, sum, graph.nodes[sum.index].path));
  const Wire other = wire_of("C");
  EXPECT_FALSE(is_balance(graph, other, graph.nodes[other.index].path)) << "a sum that a gain reads";
  EXPECT_FALSE(is_balance(graph, wire_of("A"), "A")) << "of a gain";
  EXPECT_FALSE(is_balance(graph, {.from = Wire::From::Input}, "B"));
}

}  // namespace
}  // namespace hysteron::diagnosis
