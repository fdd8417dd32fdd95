// The order of the text against the order of the data flow.
//
// In any IEC compiler, an output that is read before its instance is called holds last cycle's value. So that an
// accepted file means the same there and here: an output that depends on this step's inputs is read after the call
// (else HY402, a hidden delay), and an output that depends on the state alone, such as a delay's, is read before it
// (else HY405, a warning: elsewhere it is already the next value). Formatting puts statements in such an order.
#pragma once

#include <cstdint>
#include <vector>

#include "codegen/graph/definition.hpp"
#include "codegen/graph/graph.hpp"

namespace hysteron {

/// Reports reads that stand on the wrong side of a call. `graph` is the definition elaborated by itself.
void check_text_order(const Definitions& definitions, std::uint32_t definition, const Graph& graph,
                      Diagnostics& diagnostics);

/// The statements of a definition in the order of the data flow, by index; the order of the text where that leaves a
/// choice.
std::vector<std::uint32_t> statement_order(const Definitions& definitions, std::uint32_t definition,
                                           const Graph& graph);

}  // namespace hysteron
