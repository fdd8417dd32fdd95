// A joint as JSON: its numbers in SI units, and what it leaves out.
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "robots/joint.hpp"

namespace hysteron::robots {

/// The equation's numbers and ranges; null where an end is open, and for an actuator or a speed that is not there.
[[nodiscard]] nlohmann::ordered_json joint_json(const Joint& joint);

[[nodiscard]] nlohmann::ordered_json left_out_json(const std::vector<Neglected>& list);

}  // namespace hysteron::robots
