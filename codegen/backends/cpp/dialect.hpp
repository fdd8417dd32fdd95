// How C++ spells the operations and types of a step.
#pragma once

#include "codegen/backends/c_family/printer.hpp"

namespace hysteron {

extern const DialectOfC cpp_dialect;

}  // namespace hysteron
