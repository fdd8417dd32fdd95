#include "codegen/interpreter/machine_lanes.hpp"

#include "codegen/interpreter/machine_impl.hpp"

template class hysteron::Machine<hysteron::Lanes>;
