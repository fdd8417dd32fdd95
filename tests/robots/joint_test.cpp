// Joints that are known by hand, and what is said where a diagram is none.
#include "robots/joint.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "support/errors.hpp"
#include "tests/robots/axes.hpp"

namespace hysteron::robots {
namespace {

using testing::AllOf;
using testing::HasSubstr;

std::string refusal(const std::string& text, const JointOptions& options = {}) {
  try {
    (void)joint_of_text(text, options);
  } catch (const InputError& refused) {
    const Diagnostic& one = refused.diagnostics().all().front();
    EXPECT_FALSE(one.mend.empty());
    return one.cause + " " + one.mend;
  }
  return "accepted";
}

TEST(Joint, IsReadFromTheUnitsOfAServo) {
  const Joint joint = joint_of_text(servo);
  EXPECT_TRUE(joint.turns);
  EXPECT_EQ(joint.velocity, "SPEED.XOUT");
  EXPECT_NEAR(joint.inertia, 2e-4, 1e-18);
  EXPECT_NEAR(joint.damping, 6e-4, 1e-18);
  EXPECT_NEAR(joint.friction, 0.004, 1e-17);
  EXPECT_EQ(joint.stiffness, 0.0);
  EXPECT_FALSE(std::signbit(joint.stiffness));  // "-0.0" in the JSON
  EXPECT_EQ(joint.offset, 0.0);
  ASSERT_TRUE(joint.actuator);
  EXPECT_EQ(joint.actuator->input, "I");
  EXPECT_EQ(joint.actuator->unit, "A");
  EXPECT_NEAR(joint.actuator->gain, 0.05, 1e-17);
  EXPECT_EQ(joint.actuator->control.high, 4.0);
  EXPECT_FALSE(joint.actuator->force.is_bounded());
  const std::string left = all_of(joint.neglected);
  EXPECT_THAT(left, AllOf(HasSubstr("DRY, a HY_COULOMB_FRICTION; 1e-05 rad of travel"),
                          HasSubstr("TACHO, a HY_QUANTIZER; its numbers: QUANTUM = 0.01")));
}

TEST(Joint, IsReadFromATableOnASpring) {
  const Joint joint = joint_of_text(table);
  EXPECT_FALSE(joint.turns);
  EXPECT_NEAR(joint.inertia, 3.0, 1e-12);
  EXPECT_NEAR(joint.damping, 40.0, 1e-10);
  EXPECT_NEAR(joint.stiffness, 200.0, 1e-9);
  EXPECT_NEAR(joint.offset, 1.0, 1e-12);
  EXPECT_NEAR(joint.position.low, -0.03, 1e-15);
  EXPECT_NEAR(joint.position.high, 0.05, 1e-15);
  ASSERT_TRUE(joint.actuator);
  EXPECT_NEAR(joint.actuator->gain, 8.0, 1e-12);
  EXPECT_EQ(joint.actuator->lag, 0.01);
  EXPECT_EQ(joint.actuator->control.low, -5.0);
  EXPECT_NEAR(joint.actuator->force.high, 20.0, 1e-12);
}

TEST(Joint, TellsTheSizeOfWhatItLeavesOut) {
  const auto left = [](const std::string& other) {
    return all_of(
        joint_of_text(with(servo, "HY_COULOMB_FRICTION := (LEVEL := 0.004, PRESLIDE := 0.00001)", other)).neglected);
  };
  EXPECT_THAT(left("HY_STRIBECK_FRICTION := (LEVEL := 0.004, STICTION := 0.5, V_STRIBECK := 0.1)"),
              HasSubstr("DRY, a HY_STRIBECK_FRICTION; 0.002 N*m more at rest"));
  EXPECT_THAT(left("HY_VISCOUS_FRICTION := (COEFFICIENT := 0.001, QUADRATIC := 0.00002)"),
              HasSubstr("2e-05 N*m at 1 rad/s, and grows with the square"));
  const Joint asymmetric = joint_of_text(with(servo, "HY_COULOMB_FRICTION := (LEVEL := 0.004, PRESLIDE := 0.00001)",
                                              "HY_ASYMMETRIC_FRICTION := (UP := 0.005, DOWN := 0.003)"));
  EXPECT_NEAR(asymmetric.friction, 0.004, 1e-17);
  EXPECT_NEAR(asymmetric.offset, -0.001, 1e-17);
  EXPECT_THAT(all_of(joint_of_text(with(servo, "MOST    : HY_LIMIT            := (MN := -4.0, MX := 4.0);",
                                        "MOST : HY_DEAD_TIME := (DEAD_TIME := 0.003);"))
                         .neglected),
              HasSubstr("MOST, a HY_DEAD_TIME; 0.003 s late"));
}

TEST(Joint, StandsBehindAGear) {
  const Joint joint = behind_gear(joint_of_text(servo), 50.0);
  EXPECT_NEAR(joint.inertia, 0.5, 1e-14);
  EXPECT_NEAR(joint.damping, 1.5, 1e-14);
  EXPECT_NEAR(joint.friction, 0.2, 1e-14);
  EXPECT_NEAR(joint.actuator->gain, 2.5, 1e-14);
}

TEST(Joint, AsksForWhatTheDiagramDoesNotTell) {
  EXPECT_THAT(refusal(with(servo, "(* @unit N*m *)", "")),
              AllOf(HasSubstr("No signal on the way to SPEED has the unit N*m"), HasSubstr("--inertia")));
  EXPECT_NEAR(joint_of_text(with(servo, "(* @unit N*m *)", ""), {.inertia = 4e-4}).actuator->gain, 0.1, 1e-15);
  EXPECT_THAT(refusal(servo, {.inertia = 4e-4}),
              HasSubstr("--inertia 0.0004 contradicts the units of the diagram, which tell 0.0002 kg*m^2."));
  EXPECT_EQ(joint_of_text(servo, {.inertia = 2.001e-4}).inertia, 2.001e-4);
  EXPECT_THAT(refusal(with(servo, "(* @unit rad/s *)", "")),
              HasSubstr("has no integral or lag whose unit is a velocity"));
  EXPECT_THAT(refusal(servo, {.velocity = "KT.XOUT"}), HasSubstr("is no output of an integral or a lag"));
  EXPECT_THAT(refusal(servo, {.velocity = "SPEED.XOUR"}), HasSubstr("did you mean"));
  EXPECT_THAT(refusal(servo, {.input = "J"}), HasSubstr("inputs that do: I."));
  EXPECT_THAT(refusal(with(servo, "INERTIA(XIN := DRY.XOUT - B.XOUT);", "INERTIA(XIN := DRY.XOUT * B.XOUT);")),
              HasSubstr("is not linear"));
  const std::string loaded =
      with(with(servo, "  END_VAR\n  VAR_OUTPUT", "    LOAD : LREAL;  (* @unit N*m *)\n  END_VAR\n  VAR_OUTPUT"),
           "DRY.XOUT - B.XOUT", "DRY.XOUT - B.XOUT - LOAD");
  EXPECT_THAT(refusal(loaded), HasSubstr("Several inputs drive the joint: I, LOAD."));
  const Joint joint = joint_of_text(loaded, {.input = "I"});
  EXPECT_NEAR(joint.actuator->gain, 0.05, 1e-17);
  EXPECT_THAT(all_of(joint.neglected), HasSubstr("LOAD, an input; -1 N*m for each N*m"));
}

}  // namespace
}  // namespace hysteron::robots
