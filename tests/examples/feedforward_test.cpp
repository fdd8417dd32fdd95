// Example 3: how far each form of the feedforward misses reference (20) on the second implementation of the actuator.
#include "examples/03_feedforward/feedforward.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace hysteron::examples {
namespace {

FollowingError error(std::string_view form, double sample_time = 1e-3, double from = 0.0) {
  return error_of(feed_forward("03_feedforward/" + std::string(form) + ".st", sample_time), from);
}

TEST(Feedforward, ClosedFormFollowsToRounding) {
  EXPECT_LT(error("closed_form").worst, 1e-12);
  EXPECT_LT(error("closed_form", 4e-3).worst, 1e-12);
}

TEST(Feedforward, OdeFormByEulerIsOfFirstOrder) {
  const double at_1_ms = error("ode_form").rms;
  EXPECT_NEAR(at_1_ms, 9.6e-4, 0.5e-4);
  EXPECT_NEAR(at_1_ms / error("ode_form", 0.5e-3).rms, 2.0, 0.02);
  EXPECT_NEAR(error("ode_form", 0.5e-3).rms / error("ode_form", 0.25e-3).rms, 2.0, 0.02);
}

TEST(Feedforward, OdeFormByHeunIsOfSecondOrder) {
  const double at_1_ms = error("heun_form").rms;
  EXPECT_LT(at_1_ms, 1e-6);
  EXPECT_NEAR(at_1_ms / error("heun_form", 0.5e-3).rms, 4.0, 0.1);
}

TEST(Feedforward, LinearSpringMissesByFifteenPercent) {
  const FollowingError spring = error("linear_spring");
  EXPECT_NEAR(spring.rms, 0.095, 0.001);
  EXPECT_NEAR(spring.worst, 0.15, 0.005);
}

TEST(Feedforward, SkeletonBeforeTheFirstBranchingPointIsFollowedToo) {
  EXPECT_LT(error("closed_form", 1e-3, -0.25).worst, 1e-12);
  EXPECT_LT(error("heun_form", 1e-3, -0.25).worst, 1e-6);
  EXPECT_LT(error("ode_form", 1e-3, -0.25).worst, 2e-3);
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
