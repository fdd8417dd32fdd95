// The interpreter for eight sets of parameters side by side.
#pragma once

#include "codegen/interpreter/lanes.hpp"
#include "codegen/interpreter/machine.hpp"

namespace hysteron {

extern template class Machine<Lanes>;

}  // namespace hysteron
