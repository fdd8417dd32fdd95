#include "diagnosis/findings/loops.hpp"

#include <algorithm>
#include <cstdint>

#include "blocks/families.hpp"

namespace hysteron::diagnosis {
namespace {

/// What leads to some wires: nodes and inputs, by their places in the graph.
struct Behind {
  std::vector<bool> nodes{};
  std::vector<bool> inputs{};

  explicit Behind(const Graph& graph) : nodes(graph.nodes.size()), inputs(graph.inputs.size()) {}

  void add(const Graph& graph, const Wire& first) {
    std::vector<Wire> open{first};
    while (!open.empty()) {
      const Wire wire = open.back();
      open.pop_back();
      if (wire.from == Wire::From::Input) {
        inputs[wire.index] = true;
      } else if (wire.from == Wire::From::Node && !nodes[wire.index]) {
        nodes[wire.index] = true;
        add_pins(graph, graph.nodes[wire.index], open);
      }
    }
  }

  static void add_pins(const Graph& graph, const Node& node, std::vector<Wire>& open) {
    for (std::uint32_t pin = 0; pin < node.wire_count; ++pin) {
      open.push_back(graph.wire(node, pin));
    }
  }
};

bool is_loop(Family family) {
  return family == Family::Hysteresis || family == Family::Play;
}

bool is_loop(std::string_view family) {
  return family == name_of(Family::Hysteresis) || family == name_of(Family::Play);
}

bool is_loop(const Node& node) {
  const auto tells = [](const Field& field) { return is_loop(field.family); };
  return node.block != nullptr &&
         (is_loop(node.block->about.family) || std::ranges::any_of(node.block->inputs, tells) ||
          std::ranges::any_of(node.block->params, tells));
}

std::vector<std::string> names_of(const Graph& graph, const std::vector<bool>& inputs) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    if (inputs[i]) {
      names.push_back(graph.inputs[i].name);
    }
  }
  return names;
}

Behind behind_output(const Graph& graph, std::string_view output) {
  Behind behind(graph);
  if (const Port* const port = find_port(graph.outputs, output)) {
    behind.add(graph, port->wire);
  }
  return behind;
}

bool moves(const records::Column& column) {
  const auto [low, high] = std::ranges::minmax(column.values);
  return low < high;
}

}  // namespace

std::vector<std::string> inputs_of(const Graph& graph, std::string_view output) {
  return names_of(graph, behind_output(graph, output).inputs);
}

std::vector<std::string> inputs_of_loop(const Graph& graph, std::string_view output) {
  const Behind behind = behind_output(graph, output);
  Behind loops(graph);
  for (std::size_t n = 0; n < graph.nodes.size(); ++n) {
    if (behind.nodes[n] && is_loop(graph.nodes[n])) {
      loops.add(graph, {.from = Wire::From::Node, .index = static_cast<std::uint32_t>(n)});
    }
  }
  return names_of(graph, loops.inputs);
}

void draw_over_inputs(const Task& task, const Graph& graph, const Evidence& evidence, std::vector<Trace>& traces) {
  const bool is_told = evidence.is_told && !evidence.families.empty() && is_loop(evidence.families.front().family);
  for (Trace& trace : traces) {
    std::vector<std::string> names = inputs_of_loop(graph, trace.signal);
    if (names.empty() && is_told) {
      names = inputs_of(graph, trace.signal);
    }
    const auto record = std::ranges::find(task.records, trace.record, [](const auto& one) { return one.file(); });
    if (record == task.records.end()) {
      continue;
    }
    for (const std::string& name : names) {
      const records::Column* const column = record->find(name);
      if (column != nullptr && moves(*column)) {
        const Port* const port = find_port(graph.inputs, name);
        trace.over = {.name = name, .unit = port->unit.empty() ? column->unit : port->unit, .values = column->values};
        break;
      }
    }
  }
}

}  // namespace hysteron::diagnosis
