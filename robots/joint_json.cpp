#include "robots/joint_json.hpp"

#include <cmath>

namespace hysteron::robots {
namespace {

using Json = nlohmann::ordered_json;

/// Of a zero without its sign: a limit of 0 times a gain below 0 is -0.
Json number_or_null(double number) {
  return std::isfinite(number) ? Json(number + 0.0) : Json(nullptr);
}

Json range_json(const Range& range) {
  return {number_or_null(range.low), number_or_null(range.high)};
}

Json actuator_json(const Actuator& actuator) {
  return {{"input", actuator.input},
          {"unit", actuator.unit},
          {"gain", actuator.gain},
          {"lag", actuator.lag},
          {"control", range_json(actuator.control)},
          {"force", range_json(actuator.force)}};
}

}  // namespace

Json joint_json(const Joint& joint) {
  return {{"velocity", joint.velocity},
          {"turns", joint.turns},
          {"inertia", joint.inertia},
          {"damping", joint.damping},
          {"friction", joint.friction},
          {"stiffness", joint.stiffness},
          {"offset", joint.offset},
          {"position", range_json(joint.position)},
          {"speed", number_or_null(joint.speed)},
          {"actuator", joint.actuator ? actuator_json(*joint.actuator) : Json(nullptr)}};
}

Json left_out_json(const std::vector<Neglected>& list) {
  Json json = Json::array();
  for (const Neglected& one : list) {
    json.push_back({{"what", one.what}, {"why", one.why}, {"size", one.size}});
  }
  return json;
}

}  // namespace hysteron::robots
