// Ports and states as a caller sees them: a vector is one array, everything else a variable of its own.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "codegen/backends/shared/routine.hpp"
#include "codegen/graph/graph.hpp"

namespace hysteron {

/// A single port or state, or the elements of a vector from 0 on, which stand behind each other.
struct PortGroup {
  std::string_view name{};   ///< its own, or that of the vector without an index
  std::uint32_t first = 0;   ///< its place in the list
  std::uint32_t length = 1;  ///< 1: a single one
  [[nodiscard]] bool is_array() const { return length > 1; }
};

/// In the order of the ports. A vector of one element is a single port.
[[nodiscard]] std::vector<PortGroup> port_groups(const std::vector<Port>& ports);

/// The same for what lives from step to step.
[[nodiscard]] std::vector<PortGroup> cell_groups(std::span<const CellInfo> cells);

/// By cell the length of the variable that it is declared as: of a vector at its first element, and 0 at the others.
[[nodiscard]] std::vector<std::uint32_t> declared_lengths(std::span<const CellInfo> cells);

[[nodiscard]] bool has_arrays(const std::vector<Port>& ports);

/// By port or state what it is called: of an array the elements, `x[2]`. `make` gives the name of a group.
template <class Make>
[[nodiscard]] std::vector<std::string> port_names(const std::vector<PortGroup>& groups, Make make) {
  std::vector<std::string> names;
  for (const PortGroup& group : groups) {
    const std::string name(make(group));
    for (std::uint32_t i = 0; i < group.length; ++i) {
      names.push_back(group.is_array() ? name + "[" + std::to_string(i) + "]" : name);
    }
  }
  return names;
}

/// The variable that a name of `port_names` belongs to: of `x[2]`, x.
[[nodiscard]] inline std::string_view variable_of(std::string_view name) {
  return name.substr(0, name.find('['));
}

}  // namespace hysteron
