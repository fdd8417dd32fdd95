#include "tuning/friction_curves.hpp"

#include <algorithm>
#include <functional>
#include <optional>
#include <string_view>
#include <utility>

#include "blocks/families.hpp"
#include "codegen/graph/fmu_files.hpp"
#include "codegen/graph/units.hpp"

namespace hysteron {
namespace {

/// The wire of an input of a node; nothing where its block has no such input, or nothing drives it.
std::optional<Wire> input_wire(const Graph& graph, const Node& node, std::string_view name) {
  const auto found = std::ranges::find(node.block->inputs, name, &Field::name);
  if (found == node.block->inputs.end()) {
    return std::nullopt;
  }
  const Wire& wire = graph.wire(node, static_cast<std::uint32_t>(found - node.block->inputs.begin()));
  return wire.from == Wire::From::Node || wire.from == Wire::From::Input ? std::optional(wire) : std::nullopt;
}

std::string unit_of(const Wire& wire, const Graph& graph, const std::vector<std::vector<std::string>>& of_nodes) {
  if (wire.from == Wire::From::Input) {
    return graph.inputs[wire.index].unit;
  }
  const std::vector<std::string>& units = of_nodes[wire.index];
  return wire.port < units.size() ? units[wire.port] : std::string();
}

}  // namespace

std::vector<FrictionCurve> friction_curves(const Program& program, const Drive& drive) {
  const Graph& graph = program.graph;
  std::vector<FrictionCurve> curves;
  if (has_fmu(graph)) {
    return curves;
  }
  std::vector<Wire> watched;
  const std::vector<std::vector<std::string>> units = units::Solution(graph, program.schedule).outputs();
  for (std::uint32_t n = 0; n < graph.nodes.size(); ++n) {
    const Node& node = graph.nodes[n];
    const bool is_friction = node.block != nullptr && (node.block->about.family == Family::DryFriction ||
                                                       node.block->about.family == Family::ViscousFriction);
    const auto force = is_friction ? input_wire(graph, node, "XIN") : std::nullopt;
    const auto velocity = is_friction ? input_wire(graph, node, "V") : std::nullopt;
    if (!force || !velocity) {
      continue;
    }
    const Wire after{.from = Wire::From::Node, .index = n};
    curves.push_back({.block = node.path,
                      .force_unit = unit_of(after, graph, units),
                      .velocity_unit = unit_of(*velocity, graph, units)});
    watched.insert(watched.end(), {*velocity, *force, after});
  }
  if (curves.empty()) {
    return curves;
  }
  std::vector<Signal> signals = interpret(program, drive, watched);
  for (std::size_t i = 0; i < curves.size(); ++i) {
    curves[i].velocity = std::move(signals[3 * i]);
    const Signal& before = signals[3 * i + 1];
    curves[i].force = std::move(signals[3 * i + 2]);
    std::ranges::transform(before, curves[i].force, curves[i].force.begin(), std::minus{});
  }
  std::ranges::sort(curves, {}, &FrictionCurve::block);
  return curves;
}

}  // namespace hysteron
