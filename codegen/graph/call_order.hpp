// Which definitions contain which: the order in which they are elaborated, and how large they become.
#pragma once

#include "codegen/graph/definition.hpp"

namespace hysteron {

/// Fills callees_first. Reports a block that contains itself (HY213), and one that is too large or too deep (HY121);
/// those are then not usable.
void sort_by_calls(Definitions& definitions, Diagnostics& diagnostics);

}  // namespace hysteron
