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
