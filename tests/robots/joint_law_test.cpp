// The law that MuJoCo documents against the diagram itself, and against closed forms.
#include "robots/joint_law.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "codegen/interpreter/machine.hpp"
#include "support/root_mean_square.hpp"
#include "tests/robots/axes.hpp"
#include "tuning/signal_names.hpp"

namespace hysteron::robots {
namespace {

struct Compared {
  double error = 0.0;  ///< RMS
  double size = 0.0;
};

Compared compared(const std::string& text, double amplitude, double frequency) {
  const Program program = program_of(text);
  const Joint joint = joint_of(program, {});
  Machine<double> machine(program);
  const Wire velocity = find_signal(program.graph, joint.velocity, {});
  std::vector<double> control;
  std::vector<double> wanted;
  for (int k = 0; k < 4000; ++k) {
    control.push_back(amplitude * std::sin(2.0 * M_PI * frequency * 1e-3 * k));
    machine.set_input(0, control.back());
    machine.step();
    wanted.push_back(joint.velocity_to_si * machine.value(velocity));
  }
  const std::vector<double> got = velocities(joint, control, 1e-3);
  RootMeanSquare error;
  RootMeanSquare size;
  for (std::size_t k = 0; k < wanted.size(); ++k) {
    error.add(got[k] - wanted[k]);
    size.add(wanted[k]);
  }
  return {.error = error.value(), .size = size.value()};
}

TEST(JointLaw, IsTheDiagramOfAServoWithFriction) {
  const auto [error, size] = compared(servo, 0.8, 1.0);
  EXPECT_GT(size, 5.0);
  EXPECT_LT(error, 0.01 * size);
}

TEST(JointLaw, IsTheDiagramOfATableOnASpring) {
  const auto [error, size] = compared(table, 2.0, 0.7);
  EXPECT_GT(size, 1e-3);
  EXPECT_LT(error, 0.02 * size);
}

/// Without friction v follows (gain/damping)·(1 − e^(−t·damping/J)).
TEST(JointLaw, OfADampedInertiaIsTheExponential) {
  const Joint joint{.inertia = 0.2, .damping = 0.5, .actuator = Actuator{.gain = 3.0}};
  const std::vector<double> v = velocities(joint, std::vector<double>(2000, 1.0), 1e-4);
  for (std::size_t k = 0; k < v.size(); k += 100) {
    EXPECT_NEAR(v[k], 6.0 * (1.0 - std::exp(-2.5 * 1e-4 * static_cast<double>(k))), 2e-3) << k;
  }
}

/// Below the friction it creeps no faster than is said, above it is driven by what is left.
TEST(JointLaw, SticksAndSlides) {
  const Joint joint{.inertia = 0.1, .friction = 2.0, .actuator = Actuator{.gain = 1.0}};
  const std::vector<double> stuck = velocities(joint, std::vector<double>(5000, 1.9), 1e-3);
  EXPECT_LE(std::fabs(stuck.back()), creep_at_rest(joint));
  EXPECT_GT(std::fabs(stuck.back()), 0.9 * creep_at_rest(joint));
  const std::vector<double> sliding = velocities(joint, std::vector<double>(1001, 3.0), 1e-3);
  EXPECT_NEAR(sliding.back(), 10.0, 0.01);
}

TEST(JointLaw, LimitsTheBiasOfAnActuatorAndNoConstantForceOfASpring) {
  Joint joint{.inertia = 1.0, .offset = 3.0, .actuator = Actuator{.gain = 1.0, .force = {.low = -1.0, .high = 1.0}}};
  const std::vector<double> control(2, 0.0);
  EXPECT_NEAR(velocities(joint, control, 1e-3).back(), 1e-3, 1e-15);
  joint.stiffness = 0.5;
  EXPECT_NEAR(velocities(joint, control, 1e-3).back(), 3e-3, 1e-15);
}

}  // namespace
}  // namespace hysteron::robots
