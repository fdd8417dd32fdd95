#include "robots/robot_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <pugixml.hpp>
#include <utility>

#include "robots/joint_law.hpp"
#include "robots/xml_edit.hpp"
#include "support/errors.hpp"
#include "support/markup.hpp"
#include "support/names.hpp"

namespace hysteron::robots {
namespace {

using Attributes = std::vector<std::pair<std::string, std::string>>;

std::string text_of(double number) {
  return fmt::format("{:.9g}", number == 0.0 ? 0.0 : number);
}
std::string text_of(const Range& range, double factor) {
  return text_of(factor * range.low) + " " + text_of(factor * range.high);
}
bool has_both_ends(const Range& range) {
  return std::isfinite(range.low) && std::isfinite(range.high);
}

double armature_of(const Joint& joint, const FileOptions& options) {
  const double armature = joint.inertia - options.link_inertia;
  if (armature < 0.0) {
    throw InputError(error::bad_usage, {},
                     fmt::format("The inertia of the link, {:.4g}, is larger than all that the diagram moves, {:.4g}.",
                                 options.link_inertia, joint.inertia),
                     "write what the bodies of the robot have of it, in kg*m^2, or kg of a joint that slides.");
  }
  return armature;
}

/// What a format has no word for, and what both lack.
class Unmapped {
 public:
  void add(std::string what, std::string why, std::string size) {
    list_.push_back({.what = std::move(what), .why = std::move(why), .size = std::move(size)});
  }
  void add_half_open(const char* what, const Range& range, const std::string& unit) {
    if (range.is_bounded() && !has_both_ends(range)) {
      add(what, "a range needs both ends", fmt::format("{:.4g} to {:.4g}{}", range.low, range.high, " " + unit));
    }
  }
  [[nodiscard]] std::vector<Neglected> take() { return std::move(list_); }

 private:
  std::vector<Neglected> list_;
};

// ---- MJCF -----------------------------------------------------------------------------------------------------------

/// `angle` is what one rad is in the file. `known` says whether the element has an attribute already.
template <class Known>
Attributes joint_attributes(const Joint& joint, const FileOptions& options, double angle, const Known& known,
                            Unmapped& unmapped) {
  Attributes result{{"armature", text_of(armature_of(joint, options))},
                    {"damping", text_of(joint.damping)},
                    {"frictionloss", text_of(joint.friction)}};
  if (joint.stiffness != 0.0 || known("stiffness")) {
    result.emplace_back("stiffness", text_of(joint.stiffness));
  }
  if (joint.stiffness != 0.0 && joint.offset != 0.0 && !joint.actuator) {
    result.emplace_back("springref", text_of(angle * joint.offset / joint.stiffness));
  } else if (joint.offset != 0.0 && !joint.actuator) {
    unmapped.add("a constant force", "a joint without an actuator has no place for it",
                 fmt::format("{:.4g} {}", joint.offset, joint.force_unit()));
  }
  if (has_both_ends(joint.position)) {
    result.emplace_back("range", text_of(joint.position, angle));
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

/// A file of MuJoCo counts angles in degrees, unless it says otherwise.
template <class Known>
Attributes actuator_attributes(const Joint& joint, double gear, const Known& known, Unmapped& unmapped) {
  const Actuator& actuator = *joint.actuator;
  Attributes result{{"gainprm", text_of(actuator.gain / gear)}};
  const auto set = [&](bool is_needed, const char* type, const char* word, const char* otherwise, const char* number,
                       double value) {
    if (is_needed) {
      result.emplace_back(type, word);
      result.emplace_back(number, text_of(value));
    } else if (known(type)) {
      result.emplace_back(type, otherwise);
    }
  };
  if (known("gaintype")) {
    result.emplace_back("gaintype", "fixed");
  }
  set(joint.offset != 0.0, "biastype", "affine", "none", "biasprm", joint.offset / gear);
  set(actuator.lag > 0.0, "dyntype", "filter", "none", "dynprm", actuator.lag);
  const auto range = [&](const Range& limits, const char* name, const char* limited, double factor) {
    if (has_both_ends(limits)) {
      result.emplace_back(name, text_of(limits.times(factor), 1.0));
      if (known(limited)) {
        result.emplace_back(limited, "true");
      }
    }
  };
  range(actuator.control, "ctrlrange", "ctrllimited", 1.0);
  range(actuator.force, "forcerange", "forcelimited", 1.0 / gear);
  unmapped.add_half_open("range of the control", actuator.control, actuator.unit);
  unmapped.add_half_open("range of the force", actuator.force, joint.force_unit());
  return result;
}

std::string written(const Attributes& attributes) {
  std::string text;
  for (const auto& [name, value] : attributes) {
    text += fmt::format(" {}=\"{}\"", name, value);
  }
  return text;
}

void note(RobotFile& file, const std::string& element, const Attributes& attributes) {
  for (const auto& [name, value] : attributes) {
    file.changes.push_back(fmt::format("{} {} = \"{}\"", element, name, value));
  }
}

RobotFile mujoco_bench(const Joint& joint, const FileOptions& options) {
  Unmapped unmapped;
  const auto known = [](const char* /*name*/) { return false; };
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

std::size_t place_of(const pugi::xml_node& node) {
  return static_cast<std::size_t>(node.offset_debug());
}

/// The only joint of a name, with its kind as it should be.
pugi::xml_node joint_node(const pugi::xml_document& robot, const char* path, const FileOptions& options,
                          const std::string& file) {
  pugi::xml_node found;
  std::vector<std::string> names;
  for (const pugi::xpath_node& one : robot.select_nodes(path)) {
    names.emplace_back(one.node().attribute("name").value());
    if (names.back() == options.joint) {
      found = one.node();
    }
  }
  if (!found) {
    const auto near = nearest_name(options.joint, names);
    throw InputError(error::bad_usage, {.file = file}, fmt::format("{} has no joint {}.", file, options.joint),
                     !near.empty()   ? fmt::format("did you mean --joint {}?", near)
                     : names.empty() ? "take the file that holds the joint itself; files that it includes are not read."
                                     : fmt::format("its joints are {}.", fmt::join(names, ", ")));
  }
  return found;
}

void refuse_kind(const Joint& joint, const FileOptions& options, const std::string& file, const std::string& type,
                 bool fits) {
  if (!fits) {
    throw InputError(error::bad_usage, {.file = file},
                     fmt::format("The joint {} is of type {}, and what the diagram moves {}.", options.joint, type,
                                 joint.turns ? "turns" : "slides"),
                     "name another joint, or correct the unit of the velocity in the diagram.");
  }
}

void apply(XmlEdit& edit, const pugi::xml_node& node, const Attributes& attributes) {
  for (const auto& [name, value] : attributes) {
    edit.set(place_of(node), name, value);
  }
}

void merge_actuator(const Joint& joint, const FileOptions& options, const pugi::xml_document& robot, XmlEdit& edit,
                    RobotFile& file, Unmapped& unmapped) {
  const pugi::xml_node root = robot.child("mujoco");
  std::vector<pugi::xml_node> drives;
  for (const pugi::xml_node section : root.children("actuator")) {
    for (const pugi::xml_node one : section.children()) {
      if (options.joint == one.attribute("joint").value()) {
        drives.push_back(one);
      }
    }
  }
  if (drives.empty()) {
    const Attributes attributes = actuator_attributes(
        joint, 1.0, [](const char* /*name*/) { return false; }, unmapped);
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
  const bool plain = joint.actuator->lag == 0.0 && joint.offset == 0.0;
  if (drives.size() > 1 || (kind != "general" && !(kind == "motor" && plain))) {
    unmapped.add(drives.size() > 1 ? fmt::format("{} actuators of the joint", drives.size())
                                   : fmt::format("the actuator <{}>", kind),
                 drives.size() > 1 ? "which one the diagram's input is, is not known; they stay as they are"
                 : kind == "motor" ? "a <motor> has no lag and no offset; it stays as it is, write it as <general>"
                                   : "its law is another than the diagram's; it stays as it is",
                 fmt::format("{:.4g} {} for each {}", joint.actuator->gain, joint.force_unit(),
                             joint.actuator->unit.empty() ? "1" : joint.actuator->unit));
    return;
  }
  const pugi::xml_node drive = drives.front();
  const auto known = [&](const char* name) { return !drive.attribute(name).empty(); };
  Attributes attributes;
  if (kind == "motor") {
    attributes = actuator_attributes(joint, joint.actuator->gain, known, unmapped);
    attributes.front() = {"gear", text_of(joint.actuator->gain)};  // a motor's gain is 1
  } else {
    const double gear = drive.attribute("gear").as_double(1.0);
    attributes = actuator_attributes(joint, gear == 0.0 ? 1.0 : gear, known, unmapped);
  }
  note(file, "actuator", attributes);
  apply(edit, drive, attributes);
}

RobotFile merged_mujoco(const Joint& joint, const FileOptions& options, const std::string& name,
                        const pugi::xml_document& robot, const std::string& text) {
  const pugi::xml_node node = joint_node(robot, "/mujoco/worldbody//joint", options, name);
  const std::string type = node.attribute("type").as_string("hinge");
  refuse_kind(joint, options, name, type, type == (joint.turns ? "hinge" : "slide"));
  std::string unit = "degree";
  for (const pugi::xml_node compiler : robot.child("mujoco").children("compiler")) {
    unit = compiler.attribute("angle").as_string(unit.c_str());
  }
  const double angle = joint.turns && unit != "radian" ? 180.0 / std::numbers::pi : 1.0;
  Unmapped unmapped;
  RobotFile file;
  XmlEdit edit(text);
  const Attributes attributes = joint_attributes(
      joint, options, angle, [&](const char* one) { return !node.attribute(one).empty(); }, unmapped);
  note(file, "joint", attributes);
  apply(edit, node, attributes);
  if (joint.actuator) {
    merge_actuator(joint, options, robot, edit, file, unmapped);
  }
  file.text = edit.text();
  file.unmapped = unmapped.take();
  return file;
}

// ---- URDF -----------------------------------------------------------------------------------------------------------

struct UrdfParts {
  Attributes dynamics{};
  Attributes limit{};
};

/// The largest force that the actuator has; infinite where nothing limits it.
double largest_force(const Joint& joint) {
  const Actuator& actuator = *joint.actuator;
  const Range by_control = actuator.control.times(actuator.gain);
  const Range range = actuator.force.both(by_control);
  return std::max(std::fabs(range.low), std::fabs(range.high));
}

UrdfParts urdf_parts(const Joint& joint, const FileOptions& options, Unmapped& unmapped) {
  UrdfParts parts{.dynamics = {{"damping", text_of(joint.damping)}, {"friction", text_of(joint.friction)}}};
  if (has_both_ends(joint.position)) {
    parts.limit = {{"lower", text_of(joint.position.low)}, {"upper", text_of(joint.position.high)}};
  }
  unmapped.add_half_open("range of the position", joint.position, joint.position_unit());
  if (joint.actuator && std::isfinite(largest_force(joint))) {
    parts.limit.emplace_back("effort", text_of(largest_force(joint)));
  }
  if (std::isfinite(joint.speed)) {
    parts.limit.emplace_back("velocity", text_of(joint.speed));
  }
  const std::string force = joint.force_unit();
  const std::string why = "URDF has no word for it";
  if (const double armature = armature_of(joint, options); armature > 0.0) {
    unmapped.add("inertia of rotor and gear", why, fmt::format("{:.4g} {}", armature, joint.turns ? "kg*m^2" : "kg"));
  }
  if (joint.stiffness != 0.0) {
    unmapped.add("stiffness", why, fmt::format("{:.4g} {}/{}", joint.stiffness, force, joint.position_unit()));
  }
  if (joint.offset != 0.0) {
    unmapped.add("a constant force", why, fmt::format("{:.4g} {}", joint.offset, force));
  }
  if (joint.actuator) {
    unmapped.add(fmt::format("gain of {}", joint.actuator->input), why,
                 fmt::format("{:.4g} {} for each {}", joint.actuator->gain, force,
                             joint.actuator->unit.empty() ? "1" : joint.actuator->unit));
    if (joint.actuator->lag > 0.0) {
      unmapped.add("lag of the actuator", why, fmt::format("{:.4g} s", joint.actuator->lag));
    }
  }
  return parts;
}

RobotFile urdf_bench(const Joint& joint, const FileOptions& options) {
  Unmapped unmapped;
  UrdfParts parts = urdf_parts(joint, options, unmapped);
  RobotFile file;
  note(file, "dynamics", parts.dynamics);
  note(file, "limit", parts.limit);
  const bool bounded = has_both_ends(joint.position);
  const std::string limit = parts.limit.empty() ? "" : fmt::format("    <limit{}/>\n", written(parts.limit));
  file.text = fmt::format(
      "<?xml version=\"1.0\"?>\n<robot name=\"{0}\">\n  <link name=\"base\"/>\n  <link name=\"{1}_link\">\n"
      "    <inertial><mass value=\"1\"/><inertia ixx=\"{2}\" ixy=\"0\" ixz=\"0\" iyy=\"{2}\" iyz=\"0\" izz=\"{2}\"/>"
      "</inertial>\n  </link>\n  <joint name=\"{1}\" type=\"{3}\">\n    <parent link=\"base\"/>\n"
      "    <child link=\"{1}_link\"/>\n    <axis xyz=\"0 0 1\"/>\n    <dynamics{4}/>\n{5}  </joint>\n</robot>\n",
      escaped(options.model), escaped(options.joint), text_of(joint.inertia),
      !joint.turns ? "prismatic"
      : bounded    ? "revolute"
                   : "continuous",
      written(parts.dynamics), limit);
  file.unmapped = unmapped.take();
  return file;
}

RobotFile merged_urdf(const Joint& joint, const FileOptions& options, const std::string& name,
                      const pugi::xml_document& robot, const std::string& text) {
  const pugi::xml_node node = joint_node(robot, "/robot/joint", options, name);
  const std::string type = node.attribute("type").value();
  refuse_kind(joint, options, name, type,
              joint.turns ? type == "revolute" || type == "continuous" : type == "prismatic");
  Unmapped unmapped;
  const UrdfParts parts = urdf_parts(joint, options, unmapped);
  RobotFile file;
  XmlEdit edit(text);
  std::vector<std::string> missing;
  const auto take = [&](const char* element, const Attributes& attributes) {
    if (attributes.empty()) {
      return;
    }
    note(file, element, attributes);
    if (const pugi::xml_node child = node.child(element)) {
      apply(edit, child, attributes);
    } else {
      missing.push_back(fmt::format("<{}{}/>", element, written(attributes)));
    }
  };
  take("dynamics", parts.dynamics);
  take("limit", parts.limit);
  if (!missing.empty()) {
    edit.add_children(place_of(node), missing);
  }
  file.text = edit.text();
  file.unmapped = unmapped.take();
  return file;
}

}  // namespace

RobotFile bench_of(const Joint& joint, const FileOptions& options) {
  return options.format == Format::Mujoco ? mujoco_bench(joint, options) : urdf_bench(joint, options);
}

RobotFile merged(const Joint& joint, const FileOptions& options, const std::string& file, const std::string& text) {
  const bool is_mujoco = options.format == Format::Mujoco;
  pugi::xml_document robot;
  const pugi::xml_parse_result read =
      robot.load_buffer(text.data(), text.size(), pugi::parse_default, pugi::encoding_utf8);
  const char* const root = is_mujoco ? "mujoco" : "robot";
  if (!read || !robot.child(root)) {
    throw InputError(error::bad_usage, {.file = file},
                     read ? fmt::format("{} has no element <{}>.", file, root)
                          : fmt::format("{} is no XML: {}.", file, read.description()),
                     is_mujoco ? "give a robot as MJCF, or write --format urdf."
                               : "give a robot as URDF, or write --format mujoco.");
  }
  RobotFile result =
      is_mujoco ? merged_mujoco(joint, options, file, robot, text) : merged_urdf(joint, options, file, robot, text);
  pugi::xml_document again;
  if (!again.load_buffer(result.text.data(), result.text.size())) {
    throw InputError(error::bad_usage, {.file = file}, "The robot could not be edited: its attributes are not read.",
                     "write each attribute as name=\"value\".");
  }
  return result;
}

}  // namespace hysteron::robots
