// A port that is called T, as the time is in a record: the time constant of a filter, or a temperature.
#pragma once

#include <string_view>

#include "codegen/graph/graph.hpp"
#include "support/time_heading.hpp"

namespace hysteron {

/// Null where there is none.
[[nodiscard]] inline const Port* port_called_t(const Graph& graph) {
  const Port* const input = find_port(graph.inputs, "T");
  return input != nullptr ? input : find_port(graph.outputs, "T");
}

/// What the time is called in the records of a diagram, whichever of its ports they hold.
[[nodiscard]] inline std::string_view time_heading(const Graph& graph) {
  return time_heading(port_called_t(graph) != nullptr);
}

}  // namespace hysteron
