// The force of a friction over its velocity, as a run of the diagram has it.
#include "tuning/friction_curves.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "tuning/simulation.hpp"

namespace hysteron {
namespace {

constexpr double level = 0.25;
constexpr double coefficient = 0.02;

std::string axis(const std::string& blocks, const std::string& calls, const std::string& force) {
  return "FUNCTION_BLOCK AXIS (* @ts 1ms *) VAR_INPUT F : LREAL; (* @unit N *) END_VAR VAR_OUTPUT V : LREAL; (* @unit "
         "m/s *) END_VAR VAR MASS : HY_GAIN := (K := 1.0); SPEED : HY_INTEGRAL_FORWARD; " +
         blocks + " END_VAR V := SPEED.XOUT; " + calls + " MASS(XIN := " + force +
         "); SPEED(XIN := MASS.XOUT); END_FUNCTION_BLOCK";
}

Drive swing() {
  Drive drive{.inputs = {{}}, .steps = 2000, .sample_time = 1e-3};
  for (std::size_t k = 0; k < drive.steps; ++k) {
    drive.inputs.front().push_back(2.0 * std::sin(0.006 * static_cast<double>(k)));
  }
  return drive;
}

TEST(FrictionCurves, AreThoseOfTheLaws) {
  const Program program = compile_text(
      axis("DRY : HY_COULOMB_FRICTION := (LEVEL := 0.25, PRESLIDE := 1.0e-5); DAMP : HY_VISCOUS_FRICTION := "
           "(COEFFICIENT := 0.02);",
           "DRY(XIN := F, V := SPEED.XOUT); DAMP(XIN := DRY.XOUT, V := SPEED.XOUT);", "DAMP.XOUT"));
  const auto curves = friction_curves(program, swing());
  ASSERT_EQ(curves.size(), 2U);
  EXPECT_EQ(curves[0].block, "DAMP");
  EXPECT_EQ(curves[1].block, "DRY");
  EXPECT_EQ(curves[0].force_unit, "N");
  EXPECT_EQ(curves[0].velocity_unit, "m/s");
  ASSERT_EQ(curves[0].velocity.size(), 2000U);
  std::size_t sliding = 0;
  for (std::size_t k = 0; k < 2000; ++k) {
    const double v = curves[1].velocity[k];
    EXPECT_NEAR(curves[0].force[k], coefficient * v, 1e-12);
    if (std::abs(v) > 0.1) {  // far from a reversal the whole friction acts
      EXPECT_NEAR(curves[1].force[k], std::copysign(level, v), 1e-12);
      ++sliding;
    }
  }
  EXPECT_GT(sliding, 500U);
}

TEST(FrictionCurves, OfADiagramWithoutAFrictionAreNone) {
  EXPECT_TRUE(friction_curves(compile_text(axis("", "", "F")), swing()).empty());
  // A friction whose velocity is not wired has none to be drawn over.
  EXPECT_TRUE(
      friction_curves(compile_text(axis("DRY : HY_COULOMB_FRICTION;", "DRY(XIN := F);", "DRY.XOUT")), swing()).empty());
}

}  // namespace
}  // namespace hysteron
