#include "diagnosis/findings/loops.hpp"

#include <algorithm>
#include <cstdint>

#include "blocks/families.hpp"
#include "diagnosis/effects/motions.hpp"

namespace hysteron::diagnosis {
namespace {

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

/// Whether a wire comes from a node that lies behind what the steps were counted from.
bool is_behind(const Wire& wire, const std::vector<std::size_t>& steps) {
  return wire.from == Wire::From::Node && steps[wire.index] != unconnected;
}

std::vector<std::uint32_t> readers_of_input(const Graph& graph, std::uint32_t input) {
  std::vector<std::uint32_t> readers;
  for (std::uint32_t n = 0; n < graph.nodes.size(); ++n) {
    for (std::uint32_t pin = 0; pin < graph.nodes[n].wire_count; ++pin) {
      const Wire& wire = graph.wire(graph.nodes[n], pin);
      if (wire.from == Wire::From::Input && wire.index == input) {
        readers.push_back(n);
        break;
      }
    }
  }
  return readers;
}

/// The inputs that lead to an output; `through_loop`: on a way with a hysteresis or a play.
std::vector<std::string> leading_inputs(const Graph& graph, std::string_view output, bool through_loop) {
  std::vector<std::string> names;
  const Port* const port = find_port(graph.outputs, output);
  for (std::uint32_t i = 0; port != nullptr && i < graph.inputs.size(); ++i) {
    const bool is_itself = port->wire.from == Wire::From::Input && port->wire.index == i;
    std::vector<std::size_t> steps = steps_behind(graph, readers_of_input(graph, i));
    if (through_loop) {
      std::vector<std::uint32_t> loops;
      for (std::uint32_t n = 0; n < graph.nodes.size(); ++n) {
        if (steps[n] != unconnected && is_loop(graph.nodes[n])) {
          loops.push_back(n);
        }
      }
      steps = steps_behind(graph, loops);
    }
    if (is_behind(port->wire, steps) || (is_itself && !through_loop)) {
      names.push_back(graph.inputs[i].name);
    }
  }
  return names;
}

bool moves(const records::Column& column) {
  const auto [low, high] = std::ranges::minmax(column.values);
  return low < high;
}

}  // namespace

std::vector<std::string> inputs_of(const Graph& graph, std::string_view output) {
  return leading_inputs(graph, output, false);
}

std::vector<std::string> inputs_of_loop(const Graph& graph, std::string_view output) {
  return leading_inputs(graph, output, true);
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
