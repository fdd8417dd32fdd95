// What the files of both formats share. Internal to robot_file.
#pragma once

#include <pugixml.hpp>
#include <string>
#include <utility>
#include <vector>

#include "robots/robot_file.hpp"
#include "robots/xml_edit.hpp"

namespace hysteron::robots {

using Attributes = std::vector<std::pair<std::string, std::string>>;

[[nodiscard]] std::string text_of(double number);
[[nodiscard]] std::string text_of(const Range& range);
/// For a list of what is left out: `-5 to 5 V`, and of an actuator `8 N for each V`.
[[nodiscard]] std::string range_text(const Range& range, const std::string& unit);
[[nodiscard]] std::string gain_text(const Actuator& actuator, const std::string& force_unit);
[[nodiscard]] bool has_both_ends(const Range& range);
/// J without that of the link. Throws InputError HY730 where the link has more.
[[nodiscard]] double armature_of(const Joint& joint, const FileOptions& options);

/// What a format has no word for, and what both lack.
class Unmapped {
 public:
  void add(std::string what, std::string why, std::string size);
  /// Where one end is missing.
  void add_half_open(const char* what, const Range& range, const std::string& unit);
  [[nodiscard]] std::vector<Neglected> take() { return std::move(list_); }

 private:
  std::vector<Neglected> list_{};
};

[[nodiscard]] std::string written(const Attributes& attributes);
void note(RobotFile& file, const std::string& element, const Attributes& attributes);
[[nodiscard]] std::size_t place_of(const pugi::xml_node& node);
void apply(XmlEdit& edit, const pugi::xml_node& node, const Attributes& attributes);

/// The only joint of a name. Throws InputError HY730 where there is none, or a second one.
[[nodiscard]] pugi::xml_node joint_node(const pugi::xml_document& robot, const char* path, const FileOptions& options,
                                        const std::string& file);
/// Throws InputError HY730 where the joint's type does not fit the diagram.
void refuse_kind(const Joint& joint, const FileOptions& options, const std::string& file, const std::string& type,
                 bool fits);

}  // namespace hysteron::robots
