#include "diagnosis/evidence/open_loop.hpp"

#include <algorithm>
#include <vector>

#include "diagnosis/effects/insertion.hpp"
#include "diagnosis/effects/motions.hpp"

namespace hysteron::diagnosis {

std::optional<OpenLoop> opened(const Task& task, const std::string& top, const Variant& variant) {
  const Graph& graph = variant.program->graph;
  std::vector<std::uint32_t> entries;  // what reads a column
  for (std::uint32_t i = 0; i < graph.nodes.size(); ++i) {
    for (std::size_t pin = 0; pin < graph.nodes[i].wire_count; ++pin) {
      const Wire& wire = graph.wire(graph.nodes[i], pin);
      if (wire.from == Wire::From::Input && task.records.front().find(graph.inputs[wire.index].name) != nullptr) {
        entries.push_back(i);
        break;
      }
    }
  }
  const std::vector<std::size_t> from_inputs = steps_behind(graph, entries);
  const Port* cut = nullptr;
  std::size_t nearest = unconnected;
  for (const std::string& name : task.outputs) {
    const Port* const port = find_port(graph.outputs, name);
    if (port->wire.from != Wire::From::Node) {
      continue;
    }
    const std::vector<std::size_t> behind = steps_behind(graph, {port->wire.index});
    const bool in_loop = std::ranges::any_of(task.outputs, [&](const std::string& other) {
      const Wire& wire = find_port(graph.outputs, other)->wire;
      return other != name && wire.from == Wire::From::Node && behind[wire.index] != unconnected &&
             steps_behind(graph, {wire.index})[port->wire.index] != unconnected;
    });
    if (in_loop && from_inputs[port->wire.index] < nearest) {
      nearest = from_inputs[port->wire.index];
      cut = port;
    }
  }
  if (cut == nullptr) {
    return std::nullopt;
  }
  const std::vector<Edge> edges = edges_of_text(variant.text, top);
  const Edge* const edge = find_edge(edges, cut->name);
  if (edge == nullptr || !edge->prefix.empty()) {
    return std::nullopt;
  }
  OpenLoop result{.task = task, .variant = variant, .cut = cut->name};
  // A block that hands on its other input, in the language itself.
  constexpr std::string_view handed_on =
      "FUNCTION_BLOCK MEASURED_INSTEAD\n  VAR_INPUT\n    XIN : LREAL;\n    MEASURED : LREAL;\n  END_VAR\n  VAR_OUTPUT\n"
      "    XOUT : LREAL;\n  END_VAR\n  XOUT := MEASURED + 0.0 * XIN;\nEND_FUNCTION_BLOCK\n";
  result.variant.text += handed_on;
  Diagnostics none;
  const language::SourceFile source = language::parse("text", result.variant.text, none);
  const language::FunctionBlock& block = source.blocks[edge->definition];
  const std::string input = free_name(block, cut->name + "_MEASURED");
  try {
    result.variant.text = with_effect(source, *edge,
                                      {.block = "MEASURED_INSTEAD",
                                       .instance = free_name(block, "EFFORT"),
                                       .wires = {{"MEASURED", input}},
                                       .new_input = input});
    result.variant.program = compiled(result.variant, top);
  } catch (const InputError&) {
    return std::nullopt;
  }
  for (records::Record& record : result.task.records) {
    record.add({.name = input, .values = record.column(cut->name).values});
  }
  const auto place = std::ranges::find(result.task.outputs, cut->name);
  const auto at = place - result.task.outputs.begin();
  result.task.outputs.erase(place);
  if (!result.task.scales.empty()) {
    result.task.scales.erase(result.task.scales.begin() + at);
  }
  result.task.left_out.clear();
  result.task.cells.clear();
  return result;
}

}  // namespace hysteron::diagnosis
