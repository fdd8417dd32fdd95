// Names for C and C++: of namespaces and prefixes, of members, of ports; and the layout of a step in structures.
#pragma once

#include <deque>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "codegen/backends/shared/identifiers.hpp"
#include "codegen/backends/shared/layout.hpp"
#include "support/name_table.hpp"

namespace hysteron {

/// A name in lower case, with anything but letters and digits made an underscore; numbered where it is a keyword.
std::string field_identifier(std::string_view name);

/// The same for the namespace of a diagram, which the C library's names must not be either.
std::string namespace_identifier(std::string_view name);

/// The members of the structure of inputs or outputs, by port; an element of a vector is that of an array, `x[2]`.
std::vector<std::string> port_members(const std::vector<Port>& ports);

/// Parameters and state as structures: what belongs to one instance stands in a structure of its own.
class StructLayout {
 public:
  StructLayout(const Graph& graph, const Routine& routine, std::span<const std::string_view> reserved);
  StructLayout(const StructLayout&) = delete;
  StructLayout& operator=(const StructLayout&) = delete;
  ~StructLayout() = default;

  [[nodiscard]] const Layout& names() const { return layout_; }

  /// Calls `line(index)` for the members in the order of their first mention, those of one instance together, in a
  /// structure of theirs.
  template <class Line>
  static void append_grouped(std::string& text, const std::vector<Member>& members, Line line);

 private:
  Identifiers members_;               ///< groups of parameters and state, and what stands there alone
  NameTable fields_;                  ///< members of groups
  std::deque<std::string> elements_;  ///< of states that are arrays: x[2]
  std::vector<std::string> inputs_;
  std::vector<std::string> outputs_;
  Layout layout_;
};

/// The places of the members of each group, by the place of its first; other places are empty.
std::vector<std::vector<std::size_t>> places_by_group(const std::vector<Member>& members);

template <class Line>
void StructLayout::append_grouped(std::string& text, const std::vector<Member>& members, Line line) {
  const auto groups = places_by_group(members);
  for (std::size_t i = 0; i < members.size(); ++i) {
    if (members[i].group.empty()) {
      line(i);
    } else if (!groups[i].empty()) {
      text.append("  struct {\n");
      for (const std::size_t place : groups[i]) {
        line(place);
      }
      text.append("  } ").append(members[i].group).append(";\n");
    }
  }
}

}  // namespace hysteron
