// Signals inside a diagram by their names.
#pragma once

#include <string>

#include "codegen/graph/graph.hpp"
#include "support/diagnostic.hpp"

namespace hysteron {

/// The wire of a variable, of an output of an instance, as PID.XOUT, or of either inside a nested block, as
/// PLANT.HYST.XOUT, without regard to case. Variables are known only to a graph that was compiled with keep_names.
/// Throws InputError HY708 at `place` where there is none.
[[nodiscard]] Wire find_signal(const Graph& graph, const std::string& path, const Place& place);

}  // namespace hysteron
