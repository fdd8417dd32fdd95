// Loops beside memory: what is left of the algebraic loops of a block, where a variable that is read before its
// assignment is last cycle's value, as an IEC compiler has it.
#pragma once

#include <cstdint>
#include <unordered_set>

#include "codegen/graph/definition.hpp"

namespace hysteron {

/// HY401 for each loop that goes on without the remembered reads; nothing else.
Diagnostics remaining_loops(const Definitions& definitions, std::uint32_t definition,
                            const std::unordered_set<const language::Reference*>& remembered);

}  // namespace hysteron
