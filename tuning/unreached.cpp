// See unreached.hpp.
#include "tuning/unreached.hpp"

#include <algorithm>
#include <string_view>

#include "codegen/language/syntax.hpp"

namespace hysteron::detail {
namespace {

using Eigen::Index;

/// The node whose state this is: LAG of LAG.XOUT.
bool owns_state(const Node& node, std::string_view path) {
  return node.block != nullptr && path.size() > node.path.size() + 1 && path[node.path.size()] == '.' &&
         path.find('.', node.path.size() + 1) == std::string_view::npos &&
         language::same_name(path.substr(0, node.path.size()), node.path);
}

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
  has_fmu_ = std::ranges::any_of(graph.nodes,
                                 [](const Node& node) { return node.block != nullptr && node.block->fmu != nullptr; });
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
    for (std::size_t n = 0; n < nodes_; ++n) {
      reached[n] = owns_state(graph.nodes[n], state.path);
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
  std::vector<bool> still(nodes_, !has_fmu_);
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
