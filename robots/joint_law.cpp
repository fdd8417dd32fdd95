#include "robots/joint_law.hpp"

#include <algorithm>
#include <cmath>

namespace hysteron::robots {
namespace {

// The defaults of solreffriction and solimpfriction.
constexpr double time_constant = 0.02;
constexpr double impedance = 0.9;
constexpr double largest_impedance = 0.95;

double stiffness_of_hold(double step) {
  return 2.0 / (largest_impedance * std::max(time_constant, 2.0 * step));
}

}  // namespace

double creep_at_rest(const Joint& joint) {
  return joint.friction * (1.0 - impedance) / impedance / joint.inertia / stiffness_of_hold(0.0);
}

std::vector<double> velocities(const Joint& joint, std::span<const double> control, double step) {
  std::vector<double> result;
  result.reserve(control.size());
  const Actuator actuator = joint.actuator.value_or(Actuator{});
  const double admittance = 1.0 / joint.inertia;
  const double softness = admittance * (1.0 - impedance) / impedance;
  const double hold = stiffness_of_hold(step);
  // With a spring the constant force is in springref, and no range of the force limits it.
  const double bias = joint.stiffness != 0.0 ? 0.0 : joint.offset;
  double q = 0.0;
  double v = 0.0;
  double activation = 0.0;
  for (const double wanted : control) {
    result.push_back(v);
    const double u = std::clamp(wanted, actuator.control.low, actuator.control.high);
    const double driving = actuator.lag > 0.0 ? activation : u;
    const double force = std::clamp(actuator.gain * driving + bias, actuator.force.low, actuator.force.high);
    const double free = force - joint.damping * v - joint.stiffness * q + (joint.offset - bias);
    const double held =
        std::clamp((-hold * v - free * admittance) / (admittance + softness), -joint.friction, joint.friction);
    v += step * (free + held) / (joint.inertia + step * joint.damping);
    q = std::clamp(q + step * v, joint.position.low, joint.position.high);
    activation += actuator.lag > 0.0 ? step * (u - activation) / actuator.lag : 0.0;
  }
  return result;
}

}  // namespace hysteron::robots
