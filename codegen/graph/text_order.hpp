// The order of the text against the order of the data flow.
//
// An IEC compiler executes the text from top to bottom, and a variable keeps its value between two calls. So that an
// accepted file means the same there and here: what depends on this step's inputs is read after its assignment or call
// (else HY402: last cycle's value, memory that nobody declared). An output of a library block that depends on memory
// alone, such as a delay's, is read before the call, and one of a FUNCTION_BLOCK behind it (else HY405, a warning).
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <unordered_set>
#include <vector>

#include "codegen/graph/definition.hpp"
#include "codegen/graph/graph.hpp"

namespace hysteron {

/// Reads of a variable before its assignment: memory, as an IEC compiler has it. A circle of statements through one of
/// them is no algebraic loop.
std::unordered_set<const language::Reference*> remembered_reads(const Definitions& definitions,
                                                                std::uint32_t definition, const Graph& graph);

/// Reports reads that stand on the wrong side of a call or an assignment. `graph` is the definition elaborated by
/// itself. With `has_loops` the outputs that are read within a circle of statements are left out: with that loop cut,
/// their order can be told.
void check_text_order(const Definitions& definitions, std::uint32_t definition, const Graph& graph, bool has_loops,
                      Diagnostics& diagnostics);

/// Whether an output of a block is worked out from what the block remembers.
bool has_memory(const BlockTrace& trace, std::size_t output);

/// Whether an output of a library block hands out what the block remembers, and nothing of this step: it is to be read
/// before the call.
bool is_remembered(const Graph& graph, const Node& node, std::size_t output);

/// The block of the library that remembers a value of a type for one step.
std::string_view delay_of(Type type);

/// The statements of a definition in the order of the data flow, by index; the order of the text where that leaves a
/// choice.
std::vector<std::uint32_t> statement_order(const Definitions& definitions, std::uint32_t definition,
                                           const Graph& graph);

}  // namespace hysteron
