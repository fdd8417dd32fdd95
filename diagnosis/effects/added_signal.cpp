#include "diagnosis/effects/added_signal.hpp"

#include "diagnosis/effects/insertion.hpp"

namespace hysteron::diagnosis {

std::optional<AddedSignal> with_added_signal(const language::SourceFile& source, const Edge& edge,
                                             const std::string& top, Variant variant) {
  const language::FunctionBlock& block = source.blocks[edge.definition];
  AddedSignal added{.input = free_name(block, "ADDED_SIGNAL")};
  const std::string instance = free_name(block, "ADDED");
  try {
    variant.text = with_effect(source, edge,
                               {.block = "HY_SUM",
                                .instance = instance,
                                .input = "IN1",
                                .wires = {{"IN2", added.input}},
                                .new_input = added.input});
    added.program = compiled(variant, top);
  } catch (const InputError&) {
    return std::nullopt;
  }
  const Graph& graph = added.program->graph;
  const Node* const node = find_node(graph, instance);
  if (node == nullptr) {
    return std::nullopt;
  }
  added.before = graph.wire(*node, 0);
  return added;
}

VectorXd residuals_with(const Task& task, const AddedSignal& added, const RecordSignals& signal,
                        std::span<const Unknown> further, const VectorXd& x) {
  Task driven = task;
  for (std::size_t e = 0; e < driven.records.size(); ++e) {
    driven.records[e].add({.name = added.input, .values = signal[e]});
  }
  Model model(driven, *added.program, further);
  VectorXd residuals;
  return model.residuals(x, residuals) ? residuals : VectorXd();
}

}  // namespace hysteron::diagnosis
