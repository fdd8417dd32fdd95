// A diagram of an axis, read as a joint that simulators of robots know.
//
//   J·q'' = gain·u + offset − damping·q' − stiffness·q − friction·sign(q')
//
// What has no place in this equation is listed with its size, never dropped.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "codegen/compile.hpp"

namespace hysteron::robots {

/// What the joint leaves out.
struct Neglected {
  std::string what{};  ///< DRY, a HY_STRIBECK_FRICTION
  std::string why{};
  std::string size{};  ///< in SI units, as far as a number says it; never empty
};

struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();

  [[nodiscard]] bool is_bounded() const;
  /// What both allow.
  [[nodiscard]] Range both(const Range& other) const;
  /// Of the value times a factor.
  [[nodiscard]] Range times(double factor) const;
};

/// The input that drives the joint.
struct Actuator {
  std::string input{};
  std::string unit{};  ///< of the input, in which a simulator has to be given it; empty: none is stated
  double gain = 0.0;   ///< force or torque over the input
  double lag = 0.0;    ///< time constant of a lag before the force, s
  Range control{};     ///< of the input
  Range force{};       ///< of the force or torque
};

/// Of a joint that turns, and of one that slides.
struct JointUnits {
  const char* position;
  const char* force;
  const char* inertia;
};
constexpr JointUnits units_of_joint(bool turns) {
  return turns ? JointUnits{.position = "rad", .force = "N*m", .inertia = "kg*m^2"}
               : JointUnits{.position = "m", .force = "N", .inertia = "kg"};
}

/// In SI units: rad and N·m of a joint that turns, m and N of one that slides.
struct Joint {
  bool turns = true;
  std::string velocity{};  ///< the signal that is q'
  double velocity_to_si = 1.0;
  double inertia = 0.0;  ///< J, kg·m² or kg
  double damping = 0.0;
  double friction = 0.0;
  double stiffness = 0.0;
  double offset = 0.0;  ///< constant force or torque
  Range position{};
  double speed = std::numeric_limits<double>::infinity();  ///< largest |q'|
  std::optional<Actuator> actuator{};                      ///< none where no input drives it
  std::vector<Neglected> neglected{};

  [[nodiscard]] std::string position_unit() const { return units_of_joint(turns).position; }
  [[nodiscard]] std::string force_unit() const { return units_of_joint(turns).force; }
  [[nodiscard]] std::string inertia_unit() const { return units_of_joint(turns).inertia; }
};

struct JointOptions {
  std::string velocity{};           ///< the signal that is q'; empty: the only integral whose unit is a velocity
  std::string input{};              ///< the one that drives; empty: the only one
  std::optional<double> inertia{};  ///< J, where no signal of the diagram has the unit of a force or torque
};

/// Reads the joint from the units of the wires and from what the blocks are; no name decides. The program is compiled
/// with keep_names, and its parameters are set. Throws InputError HY730 where it is no axis, or where something has to
/// be stated, and HY708 for a signal that is not there.
[[nodiscard]] Joint joint_of(const Program& program, const JointOptions& options);

/// The joint behind a gear that turns it once where the motor turns `ratio` times.
[[nodiscard]] Joint behind_gear(Joint joint, double ratio);

}  // namespace hysteron::robots
