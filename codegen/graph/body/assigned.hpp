// Which variables the statements of a unit may write.
#pragma once

#include <set>
#include <string>

#include "codegen/graph/body/types.hpp"

namespace hysteron::bodies {

/// The first names, in upper case, of all that is assigned, counted, taken from an output, or handed to a call.
std::set<std::string> assigned_names(const Source& source);

}  // namespace hysteron::bodies
