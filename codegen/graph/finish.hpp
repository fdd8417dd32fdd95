// The last steps of elaboration: variables of the text are followed to what drives them, nodes are sorted by name,
// and rates are settled.
#pragma once

#include <vector>

#include "codegen/graph/graph.hpp"

namespace hysteron {

/// A variable of the text while a graph is being built.
struct Slot {
  Wire wire{};
  bool driven = false;
  language::Span span{};  ///< where it was driven
};

/// Replaces aliases by their sources, sorts nodes and parameters by path, gives operations their rates, and reports
/// wires between two rates (HY403), rates without a usable common period (HY406) and variables that only name each
/// other (HY401).
void finish(Graph& graph, std::vector<Slot>& slots, std::vector<Parameter>& parameters, Diagnostics& diagnostics);

}  // namespace hysteron
