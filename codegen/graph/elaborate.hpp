// Elaboration: from definitions to a flat graph.
#pragma once

#include <string>
#include <vector>

#include "codegen/graph/definition.hpp"
#include "codegen/graph/graph.hpp"
#include "codegen/graph/outermost.hpp"

namespace hysteron {

/// An LREAL output of the top block whose readers within the block get the sum of the output and an input more: the
/// noise of a sensor in a loop. The output itself is without it.
struct NoisyOutput {
  std::string output{};
  std::string input{};  ///< a name that the block does not declare; the input comes behind the declared ones
};

struct ElaborateOptions {
  bool keep_names = false;  ///< Graph::named is filled
  std::vector<NoisyOutput> noisy_outputs{};
};

/// Instantiates a definition and, within it, all that it contains. Reports what is wrong with its statements: unknown
/// names and pins, types, double drive, unconnected inputs, rates, and reads that come before the call. The graph is
/// sound only where no error was reported. `places` is filled beside its wires.
Graph elaborate(const Definitions& definitions, std::uint32_t top, Diagnostics& diagnostics,
                const ElaborateOptions& options = {}, OuterPlaces* places = nullptr);

}  // namespace hysteron
