// What the search knows of an effect and of its parameters: from descriptions, never from names.
#include "diagnosis/effects/effects.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>
#include <string>

#include "tests/diagnosis/simulated_machine.hpp"

namespace hysteron::diagnosis {
namespace {

/// An effect of the user's own; what its shape is stands in a comment.
std::string own(const std::string& shape, const std::string& size = "@neutral 0") {
  return fmt::format(R"(FUNCTION_BLOCK SAG  (* @effect sag *)
  VAR_INPUT
    XIN : LREAL;
    SIZE : LREAL := 0.0;   (* {} *)
    HALF : LREAL := 1.0;   (* @min 0.1 {} *)
  END_VAR
  VAR_OUTPUT XOUT : LREAL; END_VAR
  XOUT := XIN - SIZE * XIN * XIN / (HALF + XIN * XIN);
END_FUNCTION_BLOCK
)",
                     size, shape);
}

EffectKind sag(const std::string& text) {
  const auto read = test::read_text(text, "SAG");
  const std::vector<EffectKind> kinds = effect_kinds(read.definitions);
  const auto found = std::ranges::find(kinds, "sag", &EffectKind::id);
  if (found == kinds.end()) {
    throw std::runtime_error("no effect");
  }
  return *found;
}

TEST(EffectKinds, AreSortedAndHaveAStrength) {
  const auto read = test::read_text(own("@param"), "SAG");
  const std::vector<EffectKind> kinds = effect_kinds(read.definitions);
  EXPECT_TRUE(std::ranges::is_sorted(kinds, {}, &EffectKind::id));
  for (const EffectKind& kind : kinds) {
    EXPECT_TRUE(std::ranges::any_of(kind.parameters, [](const EffectParameter& one) { return one.strength; }))
        << kind.id;
  }
}

TEST(EffectKinds, RolesFollowFromUnits) {
  const auto kinds = effect_kinds({});
  const auto role = [&](std::string_view effect, std::string_view parameter) {
    for (const EffectKind& kind : kinds) {
      for (const EffectParameter& one : kind.parameters) {
        if (kind.id == effect && one.name == parameter) {
          return one.role;
        }
      }
    }
    throw std::runtime_error("no parameter " + std::string(parameter));
  };
  EXPECT_EQ(role("backlash", "WIDTH"), Role::Gap);
  EXPECT_EQ(role("rate_limit", "RISE"), Role::Rate);
  EXPECT_EQ(role("delay", "DEAD_TIME"), Role::Duration);
  EXPECT_EQ(role("load", "T_ON"), Role::Instant);
  EXPECT_EQ(role("periodic_disturbance", "FREQUENCY"), Role::Frequency);
  EXPECT_EQ(role("cogging", "PITCH"), Role::Period);
  EXPECT_EQ(role("creep", "GAIN"), Role::Share);
  EXPECT_EQ(role("odd_nonlinearity", "REFERENCE"), Role::Reference);
}

TEST(EffectKinds, AParameterOfTheUsersOwnHasTheRoleThatItStates) {
  EXPECT_EQ(sag(own("@param")).parameters.at(1).role, Role::Other);
  EXPECT_EQ(sag(own("@param @unit s")).parameters.at(1).role, Role::Duration);
  EXPECT_EQ(sag(own("@param @unit s @role instant")).parameters.at(1).role, Role::Instant);
  EXPECT_EQ(sag(own("@param @role reference_size")).parameters.at(1).role, Role::Reference);
  EXPECT_EQ(sag(own("@param @role centre")).parameters.at(1).role, Role::Reference);
  EXPECT_EQ(sag(own("@param @role period")).parameters.at(1).role, Role::Period);
  EXPECT_TRUE(sag(own("@param @role period")).by_position);
  EXPECT_EQ(sag(own("@param @role softness")).parameters.at(1).role, Role::Softness);
  EXPECT_EQ(sag(own("@param @role start")).parameters.size(), 1U) << "where a block starts is not searched";
}

TEST(EffectKinds, HaveAFamily) {
  const auto kinds = effect_kinds({});
  for (const EffectKind& kind : kinds) {
    EXPECT_TRUE(std::ranges::any_of(family_texts, [&](const FamilyText& one) { return one.name == kind.family; }))
        << kind.id;
  }
  EXPECT_EQ(std::ranges::find(kinds, "asymmetry", &EffectKind::id)->family, "hysteresis");
  EXPECT_EQ(sag(own("@param")).family, "sag") << "one by itself";
  std::string stated = own("@param");
  stated.replace(stated.find("@effect sag"), 11, "@effect sag @family static_curve");
  EXPECT_EQ(sag(stated).family, "static_curve");
}

TEST(EffectKinds, OnlyADescriptionSaysWhatIsSimpler) {
  std::string longer =
      own("@param", "@neutral 0 *) LEVEL : LREAL := 0.0; (* @neutral 0 *) PRESLIDE : LREAL; (* @param");
  EXPECT_EQ(sag(longer).parameters.size(), 4U);
  EXPECT_EQ(sag(longer).simpler, "");
  const auto kinds = effect_kinds({});
  EXPECT_EQ(std::ranges::find(kinds, "stribeck_friction", &EffectKind::id)->simpler, "coulomb_friction");
}

}  // namespace
}  // namespace hysteron::diagnosis
