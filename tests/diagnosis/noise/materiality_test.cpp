// What is a gap and what is noise, of residuals whose RMS is known.
#include "diagnosis/noise/materiality.hpp"

#include <gtest/gtest.h>

namespace hysteron::diagnosis {
namespace {

/// Residuals of two outputs, each of one RMS, on a task whose scales are 1.
VectorXd of_rms(double first, double second) {
  VectorXd residuals(200);
  residuals << VectorXd::Constant(100, first), VectorXd::Constant(100, -second);
  return residuals;
}

class MaterialityOfTwo : public testing::Test {
 protected:
  Task task_{.outputs = {"Y", "V"}, .scales = {1.0, 1.0}};
  std::vector<NoiseFloor> floors_{{.value = 1.0, .evidence = "dwells"}, {.value = 0.1, .evidence = "repeats"}};
};

TEST_F(MaterialityOfTwo, WhatStandsAboveTheFloorByHalfOfItIsLeft) {
  const Materiality gate(task_, floors_, 0.0);
  EXPECT_FALSE(gate.is_left(of_rms(1.1, 0.1)));
  EXPECT_TRUE(gate.is_left(of_rms(1.2, 0.1)));
  EXPECT_TRUE(gate.is_left(of_rms(1.0, 0.2)));
  EXPECT_FALSE(gate.is_left(of_rms(1.0, 0.2), 0));
  EXPECT_TRUE(gate.is_left(of_rms(1.0, 0.2), 1));
}

TEST_F(MaterialityOfTwo, WhatDoesNotMatterToTheUserIsTooSmall) {
  const Materiality gate(task_, floors_, 2.0);
  EXPECT_FALSE(gate.is_left(of_rms(1.5, 0.1)));
  EXPECT_TRUE(gate.is_too_small(of_rms(1.5, 0.1)));
  EXPECT_FALSE(gate.is_too_small(of_rms(1.0, 0.1)));  // noise
  EXPECT_FALSE(gate.is_too_small(of_rms(3.0, 0.1)));  // a gap
}

TEST_F(MaterialityOfTwo, NoFewParametersExplainNoise) {
  const Materiality gate(task_, floors_, 0.0);
  EXPECT_TRUE(gate.was_taken_for_noise(of_rms(0.95, 0.1), of_rms(0.55, 0.1)));
  EXPECT_FALSE(gate.was_taken_for_noise(of_rms(0.95, 0.1), of_rms(0.9, 0.1)));   // little
  EXPECT_FALSE(gate.was_taken_for_noise(of_rms(1.9, 0.1), of_rms(1.05, 0.1)));   // down to the floor: a gap as any
  EXPECT_FALSE(gate.was_taken_for_noise(of_rms(0.55, 0.1), of_rms(0.95, 0.1)));  // worse
}

}  // namespace
}  // namespace hysteron::diagnosis
