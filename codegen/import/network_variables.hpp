// The variables of a network while its elements run: which of them have been assigned, what holds their values by now,
// and what of them is the last cycle's.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>

#include "codegen/import/drawing.hpp"
#include "codegen/import/expression.hpp"
#include "codegen/import/function_text.hpp"
#include "codegen/import/made_variables.hpp"
#include "codegen/import/network_check.hpp"
#include "codegen/import/network_text.hpp"

namespace hysteron::import {

/// How an element is refused: why, and the mend.
using Refuse = std::function<void(std::string, std::string)>;

class NetworkVariables {
 public:
  /// POU and text outlive it.
  NetworkVariables(const DrawnPou& pou, NetworkText& text);

  /// What the elements of the network will assign.
  void expect(const Assigners& assigners);

  [[nodiscard]] const Variables& all() const { return variables_; }
  /// Null where none is declared.
  [[nodiscard]] const DrawnVariable* find(const std::string& name) const;
  /// See MadeVariables.
  [[nodiscard]] std::string new_name(const std::string& base) { return made_.new_name(base); }
  void declare(const std::string& name, const Carried& carried);

  /// A variable, or an element of one, by its `target_key`. A text assigns it once: what the drawing assigns before has
  /// a variable of its own, which is read until then.
  void assign(const std::string& key, const std::string& value, std::optional<std::uint64_t> order,
              const Refuse& refuse);

  /// What a name reads at this place of the network.
  [[nodiscard]] std::string read(const NameRead& name, const Refuse& refuse);

  /// What a value was a cycle ago; of a vector, of each element.
  [[nodiscard]] Value delayed(const std::string& text, const Carried& carried, const std::string& start = {});

  /// Behind the last element: what no element assigned of an array whose elements are assigned, and the delays.
  void finish();

 private:
  struct Assigned {
    std::string name{};  ///< that holds the value now
    std::optional<std::uint64_t> order{};
  };

  [[nodiscard]] std::string whole_by_elements(const DrawnVariable& variable, const Refuse& refuse) const;

  NetworkText& text_;
  Variables variables_;
  MadeVariables made_;
  std::map<std::string, std::size_t> to_come_;                ///< by target: how many assignments of it
  std::map<std::string, const DrawnVariable*> by_elements_;   ///< in capitals: arrays whose elements are assigned
  std::map<std::string, Assigned> assigned_;                  ///< by target
  std::map<std::string, std::string> vectors_of_last_cycle_;  ///< by their value
};

}  // namespace hysteron::import
