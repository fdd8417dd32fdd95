#include "robots/file_parts.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "support/errors.hpp"
#include "support/names.hpp"

namespace hysteron::robots {

std::string text_of(double number) {
  return fmt::format("{:.9g}", number == 0.0 ? 0.0 : number);
}
std::string text_of(const Range& range) {
  return text_of(range.low) + " " + text_of(range.high);
}
std::string range_text(const Range& range, const std::string& unit) {
  return fmt::format("{:.4g} to {:.4g} {}", range.low, range.high, unit);
}
std::string gain_text(const Actuator& actuator, const std::string& force_unit) {
  return fmt::format("{:.4g} {} for each {}", actuator.gain, force_unit, actuator.unit.empty() ? "1" : actuator.unit);
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

void Unmapped::add(std::string what, std::string why, std::string size) {
  list_.push_back({.what = std::move(what), .why = std::move(why), .size = std::move(size)});
}

void Unmapped::add_half_open(const char* what, const Range& range, const std::string& unit) {
  if (range.is_bounded() && !has_both_ends(range)) {
    add(what, "a range needs both ends", range_text(range, unit));
  }
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

std::size_t place_of(const pugi::xml_node& node) {
  return static_cast<std::size_t>(node.offset_debug());
}

pugi::xml_node joint_node(const pugi::xml_document& robot, const char* path, const FileOptions& options,
                          const std::string& file) {
  pugi::xml_node found;
  std::vector<std::string> names;
  for (const pugi::xpath_node& one : robot.select_nodes(path)) {
    names.emplace_back(one.node().attribute("name").value());
    if (names.back() == options.joint) {
      if (found) {
        throw InputError(error::bad_usage, {.file = file},
                         fmt::format("{} has two joints with the name {}.", file, options.joint),
                         "give each joint a name of its own; a simulator refuses the file, too.");
      }
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

}  // namespace hysteron::robots
