// A PLCopen TC6 project as it was drawn: POUs, their variables, and the elements of their networks, before anything is
// known of their meaning.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "support/diagnostic.hpp"

namespace hysteron::import {

struct Link {
  std::uint64_t element = 0;  ///< its localId
  std::string pin{};
};

struct DrawnPin {
  std::string name{};
  bool negated = false;
  bool edge = false;      ///< only its rise or fall counts
  std::string storage{};  ///< set, reset
  std::vector<Link> links{};
  std::string expression{};  ///< in place of links
};

struct DrawnElement {
  std::string kind{};  ///< the name of its XML element: block, inVariable, contact, …
  std::uint64_t id = 0;
  std::optional<std::uint64_t> order{};  ///< of execution, where it is stated
  std::string unread_order{};            ///< what stands for it and is no whole number, in quotation marks
  std::vector<std::string> unread{};     ///< other attributes, of its pins too, whose value says nothing
  double x = 0.0;
  double y = 0.0;
  std::string text{};      ///< expression, type of a block, variable of a contact or coil, name of a connector
  std::string instance{};  ///< of a block
  bool negated = false;
  std::string storage{};  ///< set, reset; of a coil
  std::string edge{};     ///< rising, falling; of a contact or coil
  std::vector<DrawnPin> inputs{};
  std::vector<DrawnPin> outputs{};
  std::vector<DrawnPin> both{};  ///< of a block: its VAR_IN_OUT, by what is handed over
  std::uint32_t line = 0;
};

struct DrawnVariable {
  /// Both: VAR_IN_OUT, or VAR_EXTERNAL, a variable of the project
  enum class Section : std::uint8_t { Input, Output, Both, Local, Constant };
  Section section = Section::Local;
  bool external = false;
  std::string name{};
  std::string type{};
  std::string initial{};
  std::string remark{};
  std::uint32_t line = 0;
};

/// What hands back the new value of a variable that is both input and output.
[[nodiscard]] inline std::string name_of_output(const DrawnVariable& variable) {
  return variable.section == DrawnVariable::Section::Both ? variable.name + "_OUT" : variable.name;
}

struct DrawnPou {
  std::string name{};
  std::string kind{};  ///< functionBlock, function, program
  std::string remark{};
  std::string cycle{};     ///< of the task that runs it: T#20ms
  std::string language{};  ///< ST, FBD, LD, …; empty without a body
  std::string text{};      ///< of ST
  std::vector<DrawnVariable> variables{};
  std::vector<DrawnElement> elements{};
  std::uint32_t line = 0;
};

/// Whether it does something when its turn comes: a block, or what assigns a variable.
[[nodiscard]] bool is_executed(const DrawnElement& element);

/// By its localId; null where there is none.
[[nodiscard]] const DrawnElement* find_element(const DrawnPou& pou, std::uint64_t id);

/// By its name; null where none is declared.
[[nodiscard]] const DrawnVariable* find_variable(const DrawnPou& pou, std::string_view name);

/// Reads a project. Throws InputError: HY743 where the text is no PLCopen XML or larger than any project is, HY744
/// where a variable is of a kind that no diagram has.
std::vector<DrawnPou> read_project(const std::string& file, const std::string& text);

}  // namespace hysteron::import
