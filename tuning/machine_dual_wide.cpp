#include "codegen/interpreter/machine_impl.hpp"
#include "tuning/dual.hpp"

template class hysteron::Machine<hysteron::Dual<7, 8>>;
