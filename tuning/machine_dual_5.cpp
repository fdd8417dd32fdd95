#include "codegen/interpreter/machine_impl.hpp"
#include "codegen/interpreter/run_table.hpp"
#include "tuning/dual.hpp"

template class hysteron::Machine<hysteron::Dual<5>>;
