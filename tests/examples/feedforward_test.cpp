// Example 3: how far each form of the feedforward misses reference (20) on the second implementation of the actuator.
#include "examples/03_feedforward/feedforward.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace hysteron::examples {
namespace {

const Form& spring = forms()[0];
const Form& euler = forms()[1];
const Form& heun = forms()[2];
const Form& closed_form = forms()[3];

FollowingError error(const Form& form, double sample_time = 1e-3, Start start = Start::BranchingPoint) {
  return error_of(feed_forward(form, start, sample_time));
}

TEST(Feedforward, ClosedFormFollowsToRounding) {
  EXPECT_LT(error(closed_form).worst, 1e-12);
  EXPECT_LT(error(closed_form, 4e-3).worst, 1e-12);
}

TEST(Feedforward, OdeFormByEulerIsOfFirstOrder) {
  EXPECT_NEAR(error(euler).rms, 9.6e-4, 0.05e-4);
  EXPECT_NEAR(error(euler).rms / error(euler, 0.5e-3).rms, 2.0, 0.02);
  EXPECT_NEAR(error(euler, 0.5e-3).rms / error(euler, 0.25e-3).rms, 2.0, 0.02);
}

TEST(Feedforward, OdeFormByHeunIsOfThirdOrderForAStraightSlope) {
  // Heun's rule is of second order; for du/dy = f(u) = 1/(C1 + C2·u) its leading error h³(f'²f/6 − f''f²/12) is 0.
  EXPECT_NEAR(error(heun).rms, 4.6e-9, 0.05e-9);
  EXPECT_NEAR(error(heun).rms / error(heun, 0.5e-3).rms, 8.0, 0.2);
}

TEST(Feedforward, LinearSpringMissesByFifteenPercent) {
  EXPECT_NEAR(error(spring).rms, 0.095, 0.0005);
  EXPECT_NEAR(error(spring).worst, 0.15, 0.005);
}

TEST(Feedforward, SkeletonBeforeTheFirstBranchingPointIsFollowedToo) {
  EXPECT_LT(error(closed_form, 1e-3, Start::Rest).worst, 1e-12);
  EXPECT_LT(error(heun, 1e-3, Start::Rest).worst, 1e-6);
  EXPECT_LT(error(euler, 1e-3, Start::Rest).worst, 3e-3);
  EXPECT_NEAR(error(euler, 1e-3, Start::Rest).rms / error(euler, 0.5e-3, Start::Rest).rms, 2.0, 0.02);
}

TEST(Feedforward, MistakenStartIsMissed) {
  // a feedforward that takes the skeleton for a branch is off by a good part of the range
  Form mistaken = closed_form;
  mistaken.at_rest = {{"INV.START", -1.0}, {"INV.Y0", 0.0}};
  EXPECT_GT(error(mistaken, 1e-3, Start::Rest).worst, 0.05);
}

TEST(Feedforward, ActuatorObeysItsSkeletonAndReturnsToTheOrigin) {
  RambergOsgoodActuator actuator(Material{}.reconciled());
  EXPECT_DOUBLE_EQ(actuator(0.0), 0.0);
  EXPECT_NEAR(actuator(250.0), 1.6125e-6, 1e-20);
  EXPECT_NEAR(actuator(0.0), 0.5e-6, 1e-20);
  EXPECT_NEAR(actuator(-250.0), -1.6125e-6, 1e-20);
  EXPECT_NEAR(actuator(0.0), -0.5e-6, 1e-20);
  EXPECT_NEAR(actuator(250.0), 1.6125e-6, 1e-20);
}

TEST(Servo, WithoutFeedbackADisturbanceStays) {
  const records::Record run = control(0.0);
  EXPECT_LT(error_of(run.slice(run.rows_between(-0.25, 1.0)), -0.25).worst, 1e-12);
  const auto e = column(run, "E");
  EXPECT_NEAR(e.back(), -0.1e-6, 1e-17);
}

TEST(Servo, FeedbackRemovesADisturbanceAndLeavesThePerfectFeedforwardAlone) {
  const records::Record run = control(2e10);
  EXPECT_LT(error_of(run.slice(run.rows_between(-0.25, 1.0)), -0.25).worst, 1e-12);
  // 0.1 µm is 3.1 % of the range
  EXPECT_NEAR(error_of(run, 1.0).worst, 0.1 / 3.2, 1e-9);
  EXPECT_LT(error_of(run, 1.5).worst, 0.1 * 0.1 / 3.2);
}

}  // namespace
}  // namespace hysteron::examples
