// The interpreter with dual scalars, compiled in machine_dual.cpp alone.
#pragma once

#include "codegen/interpreter/machine.hpp"
#include "tuning/dual.hpp"

namespace hysteron {

extern template class Machine<Dual<4>>;
extern template class Machine<Dual<8>>;

}  // namespace hysteron
