// Example 3: the paper's control loop (Fig. 1) on a simulated actuator that follows (20) (Fig. 9).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "examples/03_feedforward/actuator.hpp"

namespace hysteron::examples {

/// Where the actuator and the feedforward begin.
enum class Start : std::uint8_t {
  BranchingPoint,  ///< as in Theorem 8: t = 0, u = 0, y = -1.6 µm, and a rising branch ahead
  Rest             ///< t = -1/4 s, u = 0, y = 0, on the skeleton curve; the first branching point is at t = 0
};

/// Reference (20), -1.6e-6 cos(2πt) m, up to t = 2 s. Column Y_REF.
records::Record reference(Start start, double sample_time);

/// A form of the feedforward: a diagram with input Y_REF and output U.
struct Form {
  const char* name = "";
  const char* diagram = "";
  std::vector<Setting> at_rest{};  ///< what it has to be told where it begins at rest
};

/// Linear spring, ODE form by Euler and by Heun, closed form.
const std::array<Form, 4>& forms();

/// Runs a form, and the actuator on its U. Columns Y_REF, U, Y.
records::Record feed_forward(const Form& form, Start start, double sample_time);

/// Runs servo.st from rest with feedback of this gain, in V/(m·s), and the actuator with a disturbance of 0.1 µm added
/// to its output from t = 1 s on. Columns Y_REF, Y, U, E.
records::Record control(double gain);

/// The error Y - Y_REF from a time on, as shares of the range of the reference.
struct FollowingError {
  double rms = 0.0;
  double worst = 0.0;
};

FollowingError error_of(const records::Record& run, double from = -1.0);

}  // namespace hysteron::examples
