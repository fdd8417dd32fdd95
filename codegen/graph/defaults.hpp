// What the text says of an input beyond what its port keeps.
#pragma once

#include "codegen/graph/graph.hpp"

namespace hysteron {

/// Whether the diagram gives an input a default.
[[nodiscard]] bool has_default(const Graph& graph, const Port& input);

}  // namespace hysteron
