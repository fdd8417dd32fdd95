// The global variables of a file, VAR_GLOBAL: those that nothing in it assigns are constants, and those that it assigns
// and reads are memory of the block that does. What comes into the text by one, or goes out of it, is a port.
#pragma once

#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "codegen/graph/body/types.hpp"

namespace hysteron::bodies {

class Globals {
 public:
  explicit Globals(const language::body::Library& library);

  /// The declarations, each with what it is: a constant, or a variable.
  [[nodiscard]] const std::vector<language::body::Declaration>& declarations() const { return declarations_; }
  /// The variables that a unit, or what it calls, reads or assigns.
  [[nodiscard]] std::vector<const language::body::Declaration*> variables_of(const language::body::Unit& unit) const;
  /// Of a block that is run by itself: what its globals would carry into the text, out of it, or to another block.
  void check(const language::body::Unit& unit, const Types::Report& report) const;

 private:
  using Units = std::set<const language::body::Unit*>;
  struct Users {
    Units readers{};
    Units writers{};
  };
  [[nodiscard]] Units within(const language::body::Unit& unit) const;
  [[nodiscard]] bool has_value(const language::body::Declaration& global) const;

  const language::body::Library& library_;
  std::vector<language::body::Declaration> declarations_{};
  std::map<std::string, Users> users_{};  ///< by name in upper case: of those that are not declared as constants
  std::map<const language::body::Unit*, std::set<std::string>> named_{};  ///< functions and types
};

}  // namespace hysteron::bodies
