#include "robots/urdf_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "robots/file_parts.hpp"
#include "support/markup.hpp"

namespace hysteron::robots {
namespace {

struct UrdfParts {
  Attributes dynamics{};
  Attributes limit{};
};

/// What SDFormat takes as no limit, where URDF requires a number.
constexpr double no_limit = 1e16;

Range force_of(const Actuator& actuator) {
  return actuator.force.both(actuator.control.times(actuator.gain));
}

/// `present` is the <limit> that is there already, or nothing.
UrdfParts urdf_parts(const Joint& joint, const FileOptions& options, const std::string& type,
                     const pugi::xml_node& present, Unmapped& unmapped) {
  UrdfParts parts{.dynamics = {{"damping", text_of(joint.damping)}, {"friction", text_of(joint.friction)}}};
  const bool is_endless = type == "continuous";
  if (is_endless && has_both_ends(joint.position)) {
    unmapped.add("range of the position", "a continuous joint has none; write it as revolute",
                 range_text(joint.position, joint.position_unit()));
  } else if (has_both_ends(joint.position)) {
    parts.limit = {{"lower", text_of(joint.position.low)}, {"upper", text_of(joint.position.high)}};
  }
  unmapped.add_half_open("range of the position", joint.position, joint.position_unit());
  const std::string force = joint.force_unit();
  if (joint.actuator) {
    const Range range = force_of(*joint.actuator);
    const double largest = std::max(std::fabs(range.low), std::fabs(range.high));
    if (std::isfinite(largest)) {
      parts.limit.emplace_back("effort", text_of(largest));
    }
    if (range.is_bounded() && range.low != -range.high) {
      unmapped.add("range of the force", "URDF has one effort for both directions", range_text(range, force));
    }
  }
  if (std::isfinite(joint.speed)) {
    parts.limit.emplace_back("velocity", text_of(joint.speed));
  }
  if (!parts.limit.empty() || !(is_endless || present)) {
    const auto require = [&](const char* name, double number, const std::string& unit) {
      const bool is_there = !present.attribute(name).empty() ||
                            std::ranges::any_of(parts.limit, [&](const auto& one) { return one.first == name; });
      if (!is_there) {
        parts.limit.emplace_back(name, text_of(number));
        unmapped.add(fmt::format("limit {}", name), "URDF requires it and the diagram has none: it stands for no limit",
                     fmt::format("{} {}", text_of(number), unit));
      }
    };
    // Of a <limit> that is there, lower and upper are the robot's own, 0 where it has none.
    if (!is_endless && !present) {
      require("lower", -no_limit, joint.position_unit());
      require("upper", no_limit, joint.position_unit());
    }
    require("effort", no_limit, force);
    require("velocity", no_limit, joint.position_unit() + "/s");
  }
  const std::string why = "URDF has no word for it";
  if (const double armature = armature_of(joint, options); armature > 0.0) {
    unmapped.add("inertia of rotor and gear", why, fmt::format("{:.4g} {}", armature, joint.inertia_unit()));
  }
  if (joint.stiffness != 0.0) {
    unmapped.add("stiffness", why, fmt::format("{:.4g} {}/{}", joint.stiffness, force, joint.position_unit()));
  }
  if (joint.offset != 0.0) {
    unmapped.add("a constant force", why, fmt::format("{:.4g} {}", joint.offset, force));
  }
  if (joint.actuator) {
    unmapped.add(fmt::format("gain of {}", joint.actuator->input), why, gain_text(*joint.actuator, force));
    if (joint.actuator->lag > 0.0) {
      unmapped.add("lag of the actuator", why, fmt::format("{:.4g} s", joint.actuator->lag));
    }
  }
  return parts;
}

}  // namespace

RobotFile urdf_bench(const Joint& joint, const FileOptions& options) {
  Unmapped unmapped;
  const std::string type = !joint.turns ? "prismatic" : has_both_ends(joint.position) ? "revolute" : "continuous";
  FileOptions whole = options;
  whole.link_inertia = joint.inertia;  // the link of the bench has all of it
  const UrdfParts parts = urdf_parts(joint, whole, type, {}, unmapped);
  // The mass of what turns, and the inertia of what slides, move nothing: 1 kg, and a ball of 10 cm radius.
  const double mass = joint.turns ? 1.0 : joint.inertia;
  const double inertia = joint.turns ? joint.inertia : 0.4 * 0.1 * 0.1 * joint.inertia;
  RobotFile file;
  note(file, "dynamics", parts.dynamics);
  note(file, "limit", parts.limit);
  const std::string limit = parts.limit.empty() ? "" : fmt::format("    <limit{}/>\n", written(parts.limit));
  file.text = fmt::format(
      "<?xml version=\"1.0\"?>\n<robot name=\"{0}\">\n  <link name=\"base\"/>\n  <link name=\"{1}_link\">\n"
      "    <inertial><mass value=\"{6}\"/><inertia ixx=\"{2}\" ixy=\"0\" ixz=\"0\" iyy=\"{2}\" iyz=\"0\" izz=\"{2}\"/>"
      "</inertial>\n  </link>\n  <joint name=\"{1}\" type=\"{3}\">\n    <parent link=\"base\"/>\n"
      "    <child link=\"{1}_link\"/>\n    <axis xyz=\"0 0 1\"/>\n    <dynamics{4}/>\n{5}  </joint>\n</robot>\n",
      escaped(options.model), escaped(options.joint), text_of(inertia), type, written(parts.dynamics), limit,
      text_of(mass));
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
  const UrdfParts parts = urdf_parts(joint, options, type, node.child("limit"), unmapped);
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

}  // namespace hysteron::robots
