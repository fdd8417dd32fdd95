// A joint in a file of MuJoCo. Internal to robot_file.
#pragma once

#include <pugixml.hpp>
#include <string>

#include "robots/robot_file.hpp"

namespace hysteron::robots {

[[nodiscard]] RobotFile mujoco_bench(const Joint& joint, const FileOptions& options);
[[nodiscard]] RobotFile merged_mujoco(const Joint& joint, const FileOptions& options, const std::string& name,
                                      const pugi::xml_document& robot, const std::string& text);

}  // namespace hysteron::robots
