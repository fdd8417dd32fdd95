// See unreached.hpp.
#include "tuning/unreached.hpp"

#include <algorithm>

#include "codegen/graph/fmu_files.hpp"
#include "codegen/parameters/apply.hpp"

namespace hysteron::detail {
namespace {

using Eigen::Index;

/// Adds to `reached` what reads of it, directly or through others.
void spread(const Graph& graph, std::vector<bool>& reached) {
  for (bool more = true; more;) {
    more = false;
    for (std::size_t n = 0; n < graph.nodes.size(); ++n) {
      const Node& node = graph.nodes[n];
      for (std::size_t pin = 0; pin < node.wire_count && !reached[n]; ++pin) {
        const Wire& wire = graph.wire(node, pin);
        if (wire.from == Wire::From::Node && reached[wire.index]) {
          reached[n] = true;
          more = true;
        }
      }
    }
  }
}

}  // namespace

Reach::Reach(const OutputErrorProblem& problem)
    : parameters_(problem.parameters.size()), nodes_(problem.program.graph.nodes.size()) {
  const Graph& graph = problem.program.graph;
  has_fmu_ = hysteron::has_fmu(graph);
  for (const FreeParameter& free : problem.parameters) {
    std::vector<bool>& reached = reached_.emplace_back(nodes_);
    for (std::size_t n = 0; n < nodes_; ++n) {
      for (std::size_t pin = 0; pin < graph.nodes[n].wire_count; ++pin) {
        const Wire& wire = graph.wire(graph.nodes[n], pin);
        reached[n] = reached[n] || (wire.from == Wire::From::Parameter && wire.index == free.parameter);
      }
    }
    spread(graph, reached);
  }
  for (const FreeState& state : problem.initial_states) {
    std::vector<bool>& reached = reached_.emplace_back(nodes_);
    Diagnostics diagnostics;  // the problem has found its states before
    if (const auto found = parameters::find_state(graph, state.path, {}, diagnostics)) {
      reached[found->node] = true;
    }
    spread(graph, reached);
  }
}

const std::vector<bool>& Reach::of(Index column) const {
  const auto at = static_cast<std::size_t>(column);
  return at < parameters_ ? reached_[at] : reached_[parameters_ + (at - parameters_) % (reached_.size() - parameters_)];
}

bool Reach::leaves(Index column, const std::vector<bool>& nodes) const {
  const std::vector<bool>& reached = of(column);
  for (std::size_t n = 0; n < nodes_; ++n) {
    if (reached[n] && nodes[n]) {
      return false;
    }
  }
  return true;
}

std::vector<bool> Reach::unreached(const std::vector<Index>& columns) const {
  std::vector<bool> still(nodes_, true);
  for (const Index column : columns) {
    const std::vector<bool>& reached = of(column);
    for (std::size_t n = 0; n < nodes_; ++n) {
      still[n] = still[n] && !reached[n];
    }
  }
  return still;
}

WithoutNodes without_nodes(const Program& program, const std::vector<bool>& still) {
  WithoutNodes result{.program = program, .first_input = program.graph.inputs.size()};
  Graph& graph = result.program.graph;
  const auto give = [&](Wire& wire) {
    if (wire.from != Wire::From::Node || !still[wire.index]) {
      return;
    }
    const auto found = std::ranges::find(result.given, wire);
    const auto input = result.first_input + static_cast<std::size_t>(found - result.given.begin());
    if (found == result.given.end()) {
      graph.inputs.push_back({.type = wire.type});
      result.given.push_back(wire);
    }
    wire = {.from = Wire::From::Input, .type = wire.type, .index = static_cast<std::uint32_t>(input)};
  };
  for (std::size_t n = 0; n < graph.nodes.size(); ++n) {
    for (std::size_t pin = 0; pin < graph.nodes[n].wire_count && !still[n]; ++pin) {
      give(graph.wires[graph.nodes[n].first_wire + pin]);
    }
  }
  for (Port& output : graph.outputs) {
    give(output.wire);
  }
  std::erase_if(result.program.schedule.actions, [&](const Action& action) { return still[action.node]; });
  return result;
}

}  // namespace hysteron::detail
