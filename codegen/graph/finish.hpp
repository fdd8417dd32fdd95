// The last steps of elaboration: variables of the text are followed to what drives them, nodes are sorted by name,
// and rates are settled.
#pragma once

#include <cstdint>
#include <vector>

#include "codegen/graph/graph.hpp"
#include "codegen/graph/outermost.hpp"

namespace hysteron {

/// A variable of the text while a graph is being built.
struct Slot {
  Wire wire{};
  bool driven = false;
  language::Span span{};    ///< where it was driven
  std::uint32_t level = 0;  ///< in how many blocks that place lies
};

/// Replaces aliases by their sources, sorts nodes and parameters by path, gives operations their rates, and reports
/// wires between two rates (HY403), rates without a usable common period (HY406) and variables that only name each
/// other (HY401). `levels` stands beside the nodes as they come, `places` beside the wires as they go.
void finish(Graph& graph, std::vector<Slot>& slots, std::vector<Parameter>& parameters,
            const std::vector<std::uint32_t>& levels, OuterPlaces& places, Diagnostics& diagnostics);

}  // namespace hysteron
