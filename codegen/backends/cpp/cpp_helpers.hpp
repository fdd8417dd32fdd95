// The functions that generated C++ brings along: those of the vocabulary that <cmath> does not have.
#pragma once

#include <string>

#include "codegen/backends/shared/routine.hpp"

namespace hysteron {

/// The definitions of those that operations call, in a namespace of their own; empty where they call none. `stores`:
/// elements of arrays are set, which is no operation.
std::string cpp_helper_functions(const Operations& operations, bool stores);

}  // namespace hysteron
