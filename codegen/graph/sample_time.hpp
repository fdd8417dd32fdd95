// The sample time of a diagram, where there must be one.
#pragma once

#include "codegen/graph/graph.hpp"

namespace hysteron {

/// HY404, at the name of the block.
[[nodiscard]] Diagnostic missing_sample_time(const Graph& graph);

/// Throws InputError with it where the graph states none.
void require_sample_time(const Graph& graph);

}  // namespace hysteron
