// The schedule: in which order a step computes the outputs of nodes and moves their states.
#pragma once

#include <cstdint>
#include <vector>

#include "codegen/graph/graph.hpp"

namespace hysteron {

/// One action of a step.
struct Action {
  enum class Kind : std::uint8_t {
    Output,  ///< compute outputs from state and from the inputs that are known by now
    Update,  ///< move the state on
    Step     ///< both at once: all inputs are known
  };
  Kind kind = Kind::Step;
  std::uint32_t node = 0;
  bool operator==(const Action&) const = default;
};

struct Schedule {
  std::vector<Action> actions;
};

/// Sorts the dependences between ports. Where values depend on each other in a circle within one step, reports
/// HY401 with the path of the loop and the wires where a delay would cut it.
///
/// The order depends on the data flow and, where that leaves a choice, on the names; never on the order of the text.
Schedule schedule(const Graph& graph, Diagnostics& diagnostics);

/// For each output of the diagram, whether it depends on an input within the same step.
std::vector<bool> outputs_with_feedthrough(const Graph& graph);

/// Whether an output of a node depends, within the same step, on something that is computed in the step: its
/// feedthrough pins are wired to an input or to a node.
bool has_feedthrough(const Graph& graph, const Node& node, std::size_t output);

}  // namespace hysteron
