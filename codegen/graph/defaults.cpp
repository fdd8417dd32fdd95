#include "codegen/graph/defaults.hpp"

namespace hysteron {

bool has_default(const Graph& graph, const Port& input) {
  for (const language::FunctionBlock& block : graph.source->blocks) {
    for (const language::Variable& variable : block.variables) {
      if (variable.name.span.offset == input.span.offset) {
        return variable.initial != language::no_expression;
      }
    }
  }
  return false;
}

}  // namespace hysteron
