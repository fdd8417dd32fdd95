#include "robots/mjcf_file.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <functional>
#include <numbers>
#include <utility>

#include "robots/file_parts.hpp"
#include "robots/joint_law.hpp"
#include "robots/mjcf_defaults.hpp"
#include "support/markup.hpp"

namespace hysteron::robots {
namespace {

/// Says whether an attribute is stated already: by the element, by a default of it, or by nothing.
using Known = std::function<bool(const std::string&)>;

/// Without automatic limits, no range counts until its word says so.
Known known_of(MjcfAttributes stated, const MjcfDefaults& defaults) {
  return [stated = std::move(stated), is_automatic = defaults.has_automatic_limits()](const std::string& name) {
    return stated.contains(name) || (name.ends_with("limited") && !is_automatic);
  };
}

/// A constant force moves the point that the spring pulls to. Without a spring it is the bias of the actuator.
bool is_in_spring(const Joint& joint) {
  return joint.offset != 0.0 && joint.stiffness != 0.0;
}

/// `angle` is what one rad is in the file: a file of MuJoCo counts in degrees, unless it says otherwise.
Attributes joint_attributes(const Joint& joint, const FileOptions& options, double angle, const Known& known,
                            Unmapped& unmapped) {
  Attributes result{{"armature", text_of(armature_of(joint, options))},
                    {"damping", text_of(joint.damping)},
                    {"frictionloss", text_of(joint.friction)}};
  if (joint.stiffness != 0.0 || known("stiffness")) {
    result.emplace_back("stiffness", text_of(joint.stiffness));
  }
  if (known("springdamper")) {
    result.emplace_back("springdamper", "0 0");  // two positive numbers would override stiffness and damping
  }
  if (is_in_spring(joint)) {
    result.emplace_back("springref", text_of(angle * joint.offset / joint.stiffness));
  } else if (joint.stiffness != 0.0 && known("springref")) {
    result.emplace_back("springref", "0");
  } else if (joint.offset != 0.0 && !joint.actuator) {
    unmapped.add("a constant force", "a joint without an actuator has no place for it",
                 fmt::format("{:.4g} {}", joint.offset, joint.force_unit()));
  }
  if (has_both_ends(joint.position)) {
    result.emplace_back("range", text_of(joint.position.times(angle)));
    if (known("limited")) {
      result.emplace_back("limited", "true");
    }
  }
  unmapped.add_half_open("range of the position", joint.position, joint.position_unit());
  if (std::isfinite(joint.speed)) {
    unmapped.add("largest velocity", "MuJoCo limits no velocity",
                 fmt::format("{:.4g} {}/s", joint.speed, joint.position_unit()));
  }
  if (joint.friction > 0.0) {
    unmapped.add("frictionloss",
                 "MuJoCo holds dry friction by a soft constraint: at rest under a load the joint creeps",
                 fmt::format("up to {:.2g} {}/s", creep_at_rest(joint), joint.position_unit()));
  }
  return result;
}

void add_ranges(Attributes& result, const Joint& joint, double gear, const Known& known, Unmapped& unmapped) {
  const Actuator& actuator = *joint.actuator;
  const auto range = [&](const Range& limits, const char* name, const char* limited, double factor) {
    if (has_both_ends(limits)) {
      result.emplace_back(name, text_of(limits.times(factor)));
      if (known(limited)) {
        result.emplace_back(limited, "true");
      }
    }
  };
  range(actuator.control, "ctrlrange", "ctrllimited", 1.0);
  range(actuator.force, "forcerange", "forcelimited", 1.0 / gear);
  unmapped.add_half_open("range of the control", actuator.control, actuator.unit);
  unmapped.add_half_open("range of the force", actuator.force, joint.force_unit());
}

/// Of a <general>.
Attributes actuator_attributes(const Joint& joint, double gear, const Known& known, Unmapped& unmapped) {
  const Actuator& actuator = *joint.actuator;
  Attributes result{{"gainprm", text_of(actuator.gain / gear)}};
  const auto set = [&](bool is_needed, const char* type, const char* word, const char* number,
                       const std::string& value) {
    if (is_needed) {
      result.emplace_back(type, word);
      result.emplace_back(number, value);
    } else if (known(type)) {
      result.emplace_back(type, "none");
    }
  };
  if (known("gaintype")) {
    result.emplace_back("gaintype", "fixed");
  }
  // Of a list that is written shorter, MuJoCo takes the other numbers from the default.
  set(joint.offset != 0.0 && !is_in_spring(joint), "biastype", "affine", "biasprm",
      text_of(joint.offset / gear) + (known("biasprm") ? " 0 0" : ""));
  set(actuator.lag > 0.0, "dyntype", "filter", "dynprm", text_of(actuator.lag));
  add_ranges(result, joint, gear, known, unmapped);
  return result;
}

/// Of a <general> that is put into a robot: no default of the robot may change what the diagram says.
Attributes new_actuator_attributes(const Joint& joint, const Known& known, Unmapped& unmapped) {
  Attributes result = actuator_attributes(joint, 1.0, known, unmapped);
  if (known("gear")) {
    result.emplace_back("gear", "1");
  }
  const auto free = [&](const char* limited, const char* range, bool is_limited) {
    if (!is_limited && (known(limited) || known(range))) {
      result.emplace_back(limited, "false");
    }
  };
  free("ctrllimited", "ctrlrange", has_both_ends(joint.actuator->control));
  free("forcelimited", "forcerange", has_both_ends(joint.actuator->force));
  free("actlimited", "actrange", false);
  if (known("actearly")) {
    result.emplace_back("actearly", "false");
  }
  return result;
}

/// Everything that an actuator which stays as it is does not have from the diagram.
void list_actuator(const Joint& joint, const std::string& what, const std::string& why, Unmapped& unmapped) {
  const Actuator& actuator = *joint.actuator;
  const std::string force = joint.force_unit();
  unmapped.add(what, why, gain_text(actuator, force));
  constexpr const char* stays = "the actuator stays as it is";
  if (actuator.lag > 0.0) {
    unmapped.add("lag of the actuator", stays, fmt::format("{:.4g} s", actuator.lag));
  }
  if (joint.offset != 0.0 && !is_in_spring(joint)) {
    unmapped.add("a constant force", stays, fmt::format("{:.4g} {}", joint.offset, force));
  }
  const auto range = [&](const char* name, const Range& limits, const std::string& unit) {
    if (limits.is_bounded()) {
      unmapped.add(name, stays, range_text(limits, unit));
    }
  };
  range("range of the control", actuator.control, actuator.unit.empty() ? actuator.input : actuator.unit);
  range("range of the force", actuator.force, force);
}

void merge_actuator(const Joint& joint, const FileOptions& options, const pugi::xml_node& root,
                    const MjcfDefaults& defaults, XmlEdit& edit, RobotFile& file, Unmapped& unmapped) {
  std::vector<pugi::xml_node> drives;
  for (const pugi::xml_node section : root.children("actuator")) {
    for (const pugi::xml_node one : section.children()) {
      if (options.joint == one.attribute("joint").value() || options.joint == one.attribute("jointinparent").value()) {
        drives.push_back(one);
      }
    }
  }
  const MjcfAttributes stated = defaults.of_actuator(drives.empty() ? pugi::xml_node() : drives.front());
  const Known known = known_of(stated, defaults);
  if (drives.empty()) {
    const Attributes attributes = new_actuator_attributes(joint, known, unmapped);
    const std::string element =
        fmt::format("<general name=\"{}\" joint=\"{}\"{}/>", escaped(options.joint + "_" + joint.actuator->input),
                    escaped(options.joint), written(attributes));
    note(file, "actuator", attributes);
    if (const pugi::xml_node section = root.child("actuator")) {
      edit.add_children(place_of(section), {element});
    } else {
      edit.add_children(place_of(root), {"<actuator>" + element + "</actuator>"});
    }
    return;
  }
  const std::string kind = drives.front().name();
  const bool plain = joint.actuator->lag == 0.0 && (joint.offset == 0.0 || is_in_spring(joint));
  if (drives.size() > 1 || (kind != "general" && !(kind == "motor" && plain))) {
    list_actuator(joint,
                  drives.size() > 1 ? fmt::format("{} actuators of the joint", drives.size())
                                    : fmt::format("the actuator <{}>", kind),
                  drives.size() > 1 ? "which one the diagram's input is, is not known; they stay as they are"
                  : kind == "motor" ? "a <motor> has no lag and no offset; it stays as it is, write it as <general>"
                                    : "its law is another than the diagram's; it stays as it is",
                  unmapped);
    return;
  }
  Attributes attributes;
  if (kind == "motor") {
    attributes = {{"gear", text_of(joint.actuator->gain)}};  // a motor's gain is 1, whatever a default says
    add_ranges(attributes, joint, joint.actuator->gain, known, unmapped);
  } else {
    const auto stated_gear = stated.find("gear");
    const double gear = stated_gear == stated.end() ? 1.0 : std::strtod(stated_gear->second.c_str(), nullptr);
    attributes = actuator_attributes(joint, gear == 0.0 ? 1.0 : gear, known, unmapped);
    if (gear == 0.0) {
      attributes.emplace_back("gear", "1");
    }
  }
  note(file, "actuator", attributes);
  apply(edit, drives.front(), attributes);
}

}  // namespace

RobotFile mujoco_bench(const Joint& joint, const FileOptions& options) {
  Unmapped unmapped;
  const Known known = [](const std::string& /*name*/) { return false; };
  RobotFile file;
  const Attributes of_joint = joint_attributes(joint, options, 1.0, known, unmapped);
  note(file, "joint", of_joint);
  // MuJoCo takes no body without mass: this one is a millionth of the joint's inertia, where no link is stated.
  const double link = options.link_inertia > 0.0 ? options.link_inertia : 1e-6 * joint.inertia;
  file.text = fmt::format(
      "<mujoco model=\"{}\">\n  <compiler angle=\"radian\"/>\n  <option timestep=\"{}\" gravity=\"0 0 0\"/>\n"
      "  <worldbody>\n    <body name=\"{}\">\n      <inertial pos=\"0 0 0\" mass=\"{}\" diaginertia=\"{} {} {}\"/>\n"
      "      <joint name=\"{}\" type=\"{}\" axis=\"0 0 1\"{}/>\n    </body>\n  </worldbody>\n",
      escaped(options.model), text_of(options.sample_time > 0.0 ? options.sample_time : 0.002),
      escaped(options.joint + "_link"), text_of(joint.turns ? 1e-3 : link), text_of(link), text_of(link), text_of(link),
      escaped(options.joint), joint.turns ? "hinge" : "slide", written(of_joint));
  if (joint.actuator) {
    const Attributes of_actuator = actuator_attributes(joint, 1.0, known, unmapped);
    note(file, "actuator", of_actuator);
    file.text += fmt::format("  <actuator>\n    <general name=\"{}\" joint=\"{}\"{}/>\n  </actuator>\n",
                             escaped(joint.actuator->input), escaped(options.joint), written(of_actuator));
  }
  file.text += "</mujoco>\n";
  file.unmapped = unmapped.take();
  return file;
}

RobotFile merged_mujoco(const Joint& joint, const FileOptions& options, const std::string& name,
                        const pugi::xml_document& robot, const std::string& text) {
  const pugi::xml_node node = joint_node(robot, "/mujoco/worldbody//joint", options, name);
  const pugi::xml_node root = robot.child("mujoco");
  const MjcfDefaults defaults(root);
  const MjcfAttributes stated = defaults.of_joint(node);
  const std::string type = stated.contains("type") ? stated.at("type") : "hinge";
  refuse_kind(joint, options, name, type, type == (joint.turns ? "hinge" : "slide"));
  std::string unit = "degree";
  for (const pugi::xml_node compiler : root.children("compiler")) {
    unit = compiler.attribute("angle").as_string(unit.c_str());
  }
  const double angle = joint.turns && unit != "radian" ? 180.0 / std::numbers::pi : 1.0;
  Unmapped unmapped;
  RobotFile file;
  XmlEdit edit(text);
  const Attributes attributes = joint_attributes(joint, options, angle, known_of(stated, defaults), unmapped);
  note(file, "joint", attributes);
  apply(edit, node, attributes);
  if (joint.actuator) {
    merge_actuator(joint, options, root, defaults, edit, file, unmapped);
  }
  for (const pugi::xpath_node& one : robot.select_nodes("//include")) {
    unmapped.add("a file that the robot includes",
                 "it is not read; a default or an actuator in it may change the joint",
                 one.node().attribute("file").value());
  }
  file.text = edit.text();
  file.unmapped = unmapped.take();
  return file;
}

}  // namespace hysteron::robots
