// The interpreter with dual scalars of 4 and 8 derivatives: more parameters take several passes.
#include "codegen/interpreter/machine_impl.hpp"
#include "tuning/dual.hpp"

template class hysteron::Machine<hysteron::Dual<4>>;
template class hysteron::Machine<hysteron::Dual<8>>;
