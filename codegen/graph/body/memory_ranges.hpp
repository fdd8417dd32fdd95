// Between which numbers the memory of a body stays, by induction: it begins there, and no step leads out.
//
// `IF COUNT < 10 THEN COUNT := COUNT + 1; END_IF` keeps COUNT between 0 and 10 for ever. So FOR I := 1 TO COUNT has ten
// rounds at most. Inputs may be anything.
#pragma once

#include <map>
#include <string>

#include "codegen/graph/body/body.hpp"

namespace hysteron::bodies {

/// The ranges that a body needs for its loops to end: empty where it needs none, or where none are found.
[[nodiscard]] MemoryRanges memory_ranges(const language::body::Library& library, const language::body::Unit& unit,
                                         const Surroundings& around, const std::map<std::string, Wire>& inputs);

}  // namespace hysteron::bodies
