// Where a body keeps its values: a tree of places along the types, with a number for each plain variable.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "codegen/graph/body/types.hpp"

namespace hysteron::bodies {

struct Place {
  static constexpr std::uint32_t no_leaf = std::numeric_limits<std::uint32_t>::max();
  TypeRef type{};
  std::string path{};                           ///< MOTOR.SPEED; empty for the body itself
  std::uint32_t leaf = no_leaf;                 ///< of a plain type
  std::vector<std::unique_ptr<Place>> parts{};  ///< elements, members, or the pins and outputs of a library block
  std::vector<Member> members{};                ///< beside parts; of an array empty
  std::vector<Place*> aliases{};                ///< beside parts: what a VAR_IN_OUT stands for in this call
  bool called = false;                          ///< a library block, in this step
  std::unique_ptr<Place> by_clock{};            ///< of a timer: the variables of its text, where it runs by TIME()
  bool clocked = false;                         ///< it does
  language::Span call{};

  /// The part of a name in upper case; null where there is none.
  [[nodiscard]] Place* find(const std::string& name) const {
    for (std::size_t i = 0; i < members.size(); ++i) {
      if (members[i].name == name) {
        return aliases[i] != nullptr ? aliases[i] : parts[i].get();
      }
    }
    return nullptr;
  }
};

/// A mend for a member that is not there: the nearest one, or all that can be named.
[[nodiscard]] std::string one_of_members(const Place& place, std::string_view wanted);

}  // namespace hysteron::bodies
