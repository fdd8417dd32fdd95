// Elaboration: from definitions to a flat graph.
#pragma once

#include "codegen/graph/definition.hpp"
#include "codegen/graph/graph.hpp"
#include "codegen/graph/outermost.hpp"

namespace hysteron {

/// Instantiates a definition and, within it, all that it contains. Reports what is wrong with its statements: unknown
/// names and pins, types, double drive, unconnected inputs, rates, and reads that come before the call. The graph is
/// sound only where no error was reported. `keep_names` fills Graph::named; `places` is filled beside its wires.
Graph elaborate(const Definitions& definitions, std::uint32_t top, Diagnostics& diagnostics, bool keep_names = false,
                OuterPlaces* places = nullptr);

}  // namespace hysteron
