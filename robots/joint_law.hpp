// What MuJoCo makes of a joint, step by step, for the Euler integrator and its default settings (mujoco.readthedocs.io,
// Computation, "Constraint model" and "Numerical integration"):
//
//   a₀ = (gain·u + offset − damping·v − stiffness·q)/J
//   f  = clamp((−b·v − a₀)/(A + R), −frictionloss, frictionloss)      A = 1/J, R = A·(1 − d)/d, d = 0.9
//   v⁺ = v + h·(J·a₀ + f)/(J + h·damping),   q⁺ = q + h·v⁺           b = 2/(0.95·max(0.02 s, 2h))
//
// So an export is held against the diagram without the simulator.
#pragma once

#include <span>
#include <vector>

#include "robots/joint.hpp"

namespace hysteron::robots {

/// q' at the begin of each step, from rest; `control` by step.
[[nodiscard]] std::vector<double> velocities(const Joint& joint, std::span<const double> control, double step);

/// |q'| at which dry friction that nearly slides lets the joint creep.
[[nodiscard]] double creep_at_rest(const Joint& joint);

}  // namespace hysteron::robots
