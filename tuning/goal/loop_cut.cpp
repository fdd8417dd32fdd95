#include "tuning/goal/loop_cut.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "support/errors.hpp"

namespace hysteron {

LoopCut cut_loop(Program& program, const Wire& wire, const std::string& name, const Place& place,
                 Diagnostics& diagnostics) {
  Graph& graph = program.graph;
  if (wire.from != Wire::From::Node || wire.type != Type::Real) {
    diagnostics.error(error::no_loop_there, place,
                      wire.type != Type::Real
                          ? fmt::format("{} is no LREAL: no small signal passes there.", name)
                          : fmt::format("Nothing in the diagram computes {}: no loop passes there.", name),
                      "name a signal of the loop, most often the controller's output, as PID.XOUT.");
    return {};
  }
  if (std::ranges::any_of(graph.nodes, [](const Node& node) { return node.rate.every > 1; })) {
    diagnostics.error(error::no_loop_there, place,
                      "The diagram has several rates: what comes back of a small signal depends on when it is put in.",
                      "leave loop and its margins out; effort, effort_rate and overshoot_percent can be limited.");
    return {};
  }
  LoopCut cut{.input = graph.inputs.size(),
              .behind = {.from = Wire::From::Node, .index = static_cast<std::uint32_t>(graph.nodes.size())}};
  std::ranges::replace(graph.wires, wire, cut.behind);
  graph.inputs.push_back({.name = "", .meaning = "what is put into the loop"});
  graph.nodes.push_back(
      {.op = Op::Add, .first_wire = static_cast<std::uint32_t>(graph.wires.size()), .wire_count = 2, .path = "#CUT"});
  graph.wires.push_back(wire);
  graph.wires.push_back({.from = Wire::From::Input, .index = static_cast<std::uint32_t>(cut.input)});
  graph.wire_spans.resize(graph.wires.size());
  program.schedule = schedule(graph, diagnostics);
  return cut;
}

}  // namespace hysteron
