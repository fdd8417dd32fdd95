// What the frictions of a diagram do in a run: the force of each over its velocity, the picture in which an engineer
// knows a friction.
#pragma once

#include <string>
#include <vector>

#include "codegen/compile.hpp"
#include "tuning/simulation.hpp"

namespace hysteron {

struct FrictionCurve {
  std::string block{};  ///< PLANT.DRY
  std::string force_unit{};
  std::string velocity_unit{};
  Signal velocity{};
  Signal force{};  ///< XIN - XOUT: what the block takes off
};

/// One for each block of the families dry and viscous friction that has a velocity, by their names. A diagram with
/// an FMU has none.
[[nodiscard]] std::vector<FrictionCurve> friction_curves(const Program& program, const Drive& drive);

}  // namespace hysteron
