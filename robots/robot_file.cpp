#include "robots/robot_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <pugixml.hpp>
#include <set>

#include "robots/mjcf_file.hpp"
#include "robots/urdf_file.hpp"
#include "support/errors.hpp"

namespace hysteron::robots {

namespace {

/// pugixml takes an attribute that stands twice, and more than one root. XML has neither.
void refuse_what_is_no_xml(const pugi::xml_document& robot, const std::string& file, const std::string& text) {
  const auto refuse = [&](const pugi::xml_node& node, const std::string& cause, const std::string& mend) {
    const auto end = text.begin() + std::min(node.offset_debug(), static_cast<std::ptrdiff_t>(text.size()));
    const auto line = static_cast<std::uint32_t>(1 + std::count(text.begin(), end, '\n'));
    throw InputError(error::bad_usage, {.file = file, .line = line},
                     fmt::format("{} is no XML, line {}: {}.", file, line, cause), mend);
  };
  for (const pugi::xpath_node& one : robot.select_nodes("//*")) {
    std::set<std::string> names;
    for (const pugi::xml_attribute attribute : one.node().attributes()) {
      if (!names.insert(attribute.name()).second) {
        refuse(one.node(), fmt::format("the attribute {} of <{}> stands twice", attribute.name(), one.node().name()),
               "take one of them out.");
      }
    }
  }
  bool has_root = false;
  for (const pugi::xml_node one : robot.children()) {
    if (one.type() == pugi::node_element && has_root) {
      refuse(one, fmt::format("<{}> is a second root", one.name()), "put one element round all others.");
    }
    has_root = has_root || one.type() == pugi::node_element;
  }
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
  refuse_what_is_no_xml(robot, file, text);
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
