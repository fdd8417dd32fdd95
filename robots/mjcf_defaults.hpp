// What counts for an element of MJCF: its own attributes, then those of its default class and of the classes round it
// (mujoco.readthedocs.io, Modeling, "Default settings"). One record of defaults serves all kinds of actuators.
#pragma once

#include <map>
#include <pugixml.hpp>
#include <string>

namespace hysteron::robots {

/// By name. The value is empty where a shortcut such as <position> states an attribute of <general>.
using MjcfAttributes = std::map<std::string, std::string>;

class MjcfDefaults {
 public:
  /// Of <mujoco>. Files that it includes are not read.
  explicit MjcfDefaults(const pugi::xml_node& mujoco);

  [[nodiscard]] MjcfAttributes of_joint(const pugi::xml_node& joint) const;
  /// An empty node stands for an actuator that states no class.
  [[nodiscard]] MjcfAttributes of_actuator(const pugi::xml_node& actuator) const;
  /// A range counts without the word that it does.
  [[nodiscard]] bool has_automatic_limits() const { return has_automatic_limits_; }

 private:
  struct Class {
    MjcfAttributes joint{};
    MjcfAttributes actuator{};
  };
  void take(const pugi::xml_node& defaults, const std::string& name, const Class& around);
  [[nodiscard]] const Class& named(const std::string& name) const;

  Class outermost_{};
  std::map<std::string, Class> classes_{};
  bool has_automatic_limits_ = true;
};

}  // namespace hysteron::robots
