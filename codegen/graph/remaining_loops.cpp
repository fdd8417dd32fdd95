#include "codegen/graph/remaining_loops.hpp"

#include "codegen/graph/elaborator.hpp"
#include "codegen/graph/outermost.hpp"
#include "codegen/graph/schedule.hpp"
#include "support/errors.hpp"

namespace hysteron {

Diagnostics remaining_loops(const Definitions& definitions, std::uint32_t definition,
                            const std::unordered_set<const language::Reference*>& remembered) {
  Diagnostics found;
  OuterPlaces places;
  const ElaborateOptions options;
  Elaborator elaborator(definitions, found, options);
  elaborator.remember(remembered);
  const Graph graph = elaborator.run(definition, places);
  (void)schedule(graph, places, found);
  Diagnostics loops;
  for (const Diagnostic& one : found.all()) {
    if (one.number == error::algebraic_loop) {
      loops.add(one);
    }
  }
  return loops;
}

}  // namespace hysteron
