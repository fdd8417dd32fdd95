#include "codegen/interpreter/machine_impl.hpp"

template class hysteron::Machine<float>;
