#include "codegen/graph/defaults.hpp"

#include "codegen/language/body.hpp"

namespace hysteron {

bool has_default(const Graph& graph, const Port& input) {
  for (const language::FunctionBlock& block : graph.source->blocks) {
    for (std::size_t i = 0; i < block.variables.size(); ++i) {
      if (block.variables[i].name.span.offset != input.span.offset) {
        continue;
      }
      // The values of a sequential body may be lists and structures: its unit keeps them.
      return block.body == language::FunctionBlock::no_body
                 ? block.variables[i].initial != language::no_expression
                 : graph.source->bodies->units[block.body].declarations[i].initial.given();
    }
  }
  return false;
}

}  // namespace hysteron
