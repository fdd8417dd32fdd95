// Example 3: the paper's control loop (Fig. 1) on a simulated actuator that follows (20) (Fig. 9).
#pragma once

#include <string_view>

#include "examples/03_feedforward/actuator.hpp"

namespace hysteron::examples {

/// Reference (20), -1.6e-6 cos(2πt) m, from t = -1/4 s, where it passes 0 and the actuator rests on its skeleton curve,
/// to 2 s. The first branching point is at t = 0. Column Y_REF.
records::Record reference(double sample_time);

/// Runs a diagram with input Y_REF and output U, and the actuator on its U. Columns Y_REF, U, Y.
records::Record feed_forward(std::string_view diagram, double sample_time);

/// Runs servo.st with feedback of gain K, in V/(m·s), and the actuator with a disturbance of 0.1 µm added to its output
/// from t = 1 s on. Columns Y_REF, Y, U, E.
records::Record control(double K);

/// The error Y - Y_REF from the first branching point on, as shares of the range of the reference.
struct FollowingError {
  double rms = 0.0;
  double worst = 0.0;
};

FollowingError error_of(const records::Record& run, double from = 0.0);

}  // namespace hysteron::examples
