#include "robots/mjcf_defaults.hpp"

#include <algorithm>
#include <array>
#include <string_view>

namespace hysteron::robots {
namespace {

constexpr std::array<std::string_view, 10> actuators{"general", "motor",    "position", "velocity", "intvelocity",
                                                     "damper",  "cylinder", "muscle",   "adhesion", "dcmotor"};

void add_own(MjcfAttributes& all, const pugi::xml_node& element) {
  for (const pugi::xml_attribute one : element.attributes()) {
    all[one.name()] = one.value();
  }
}

}  // namespace

MjcfDefaults::MjcfDefaults(const pugi::xml_node& mujoco) {
  for (const pugi::xml_node compiler : mujoco.children("compiler")) {
    has_automatic_limits_ = compiler.attribute("autolimits").as_bool(has_automatic_limits_);
  }
  for (const pugi::xml_node section : mujoco.children("default")) {
    const std::string name = section.attribute("class").as_string("main");
    take(section, name, outermost_);
    outermost_ = classes_[name];
  }
}

void MjcfDefaults::take(const pugi::xml_node& defaults, const std::string& name, const Class& around) {
  Class all = around;
  for (const pugi::xml_node one : defaults.children()) {
    const std::string_view kind = one.name();
    if (kind == "joint") {
      add_own(all.joint, one);
    } else if (std::ranges::find(actuators, kind) != actuators.end()) {
      add_own(all.actuator, one);
      if (kind != "general") {
        for (const char* const law : {"gaintype", "gainprm", "biastype", "biasprm", "dyntype", "dynprm"}) {
          all.actuator[law] = "";
        }
      }
    }
  }
  classes_[name] = all;
  for (const pugi::xml_node one : defaults.children("default")) {
    take(one, one.attribute("class").value(), all);
  }
}

const MjcfDefaults::Class& MjcfDefaults::named(const std::string& name) const {
  const auto found = classes_.find(name);
  return found == classes_.end() ? outermost_ : found->second;
}

MjcfAttributes MjcfDefaults::of_joint(const pugi::xml_node& joint) const {
  std::string name = joint.attribute("class").value();
  for (pugi::xml_node above = joint.parent(); above && name.empty(); above = above.parent()) {
    name = above.attribute("childclass").value();
  }
  MjcfAttributes all = named(name).joint;
  add_own(all, joint);
  return all;
}

MjcfAttributes MjcfDefaults::of_actuator(const pugi::xml_node& actuator) const {
  MjcfAttributes all = named(actuator.attribute("class").value()).actuator;
  add_own(all, actuator);
  return all;
}

}  // namespace hysteron::robots
