#include "codegen/interpreter/machine_impl.hpp"
#include "codegen/interpreter/run_table.hpp"

template class hysteron::Machine<float>;
