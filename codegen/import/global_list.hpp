// A list of global variables of TwinCAT, the declaration in a .TcGVL: its variables one by one, so that a block gets
// those that it names.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace hysteron {

struct GlobalVariable {
  std::vector<std::string> names{};  ///< in capitals; several of one declaration: A, B : REAL;
  std::string text{};                ///< VAR_GLOBAL CONSTANT … END_VAR around this declaration alone
};

struct GlobalList {
  bool qualified_only = false;  ///< LIST.NAME is the only way to name them
  std::vector<GlobalVariable> variables{};

  /// The variable of a name in capitals; null where there is none.
  [[nodiscard]] const GlobalVariable* find(std::string_view name) const;
};

/// Of the declaration in a list.
GlobalList read_global_list(std::string_view declaration);

/// The list in the file of an object; nothing where it is another object, or no XML.
std::optional<GlobalList> global_list_of(std::string_view file);

}  // namespace hysteron
