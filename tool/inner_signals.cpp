#include "tool/inner_signals.hpp"

#include <algorithm>
#include <utility>

#include "codegen/graph/units.hpp"

namespace hysteron::tool {

std::vector<InnerSignal> inner_signals(const Program& program) {
  const Graph& graph = program.graph;
  const auto units = units::Solution(graph, program.schedule).outputs();
  std::vector<InnerSignal> found;
  const auto add = [&](const Wire& wire, const std::string& sink, const std::string& unit) {
    const bool known = std::ranges::any_of(found, [&](const InnerSignal& other) { return other.wire == wire; });
    if (wire.from != Wire::From::Node || known || graph.nodes[wire.index].rate != Rate{}) {
      return;
    }
    const Node& node = graph.nodes[wire.index];
    const std::string own = node.block == nullptr ? std::string() : units[wire.index][wire.port];
    found.push_back(
        {.name = node.block == nullptr ? sink : node.path + "." + std::string(node.block->outputs[wire.port].name),
         .unit = own.empty() ? unit : own,
         .type = output_type(node, wire.port),
         .wire = wire});
  };
  for (const Node& node : graph.nodes) {
    for (std::size_t pin = 0; pin < node.wire_count; ++pin) {
      const Wire& wire = graph.wire(node, pin);
      if (node.block != nullptr) {
        add(wire, node.path + "." + std::string(node.block->pin(pin).name), {});
      } else if (wire.from == Wire::From::Node && graph.nodes[wire.index].block != nullptr) {
        add(wire, {}, {});  // an expression within an expression has no name
      }
    }
  }
  for (const Port& port : graph.outputs) {
    add(port.wire, port.name, port.unit);
  }
  return found;
}

}  // namespace hysteron::tool
