// The generated step behind plain C functions, so that a host can link it, or open it as a library, without its types.
#pragma once

#include "codegen/backends/cpp/cpp.hpp"

namespace hysteron {

/// NAME_step.cpp, which includes NAME.hpp and has one Params and one State of its own:
///   void hysteron_reset(void)
///   void hysteron_step(const double* inputs, double* outputs)
///   void hysteron_set_parameter(size_t index, double value), double hysteron_parameter(size_t index)
///   void* hysteron_state(void), size_t hysteron_state_size(void)
/// Elements of array parameters count one by one. BOOL is 0 or 1.
GeneratedFile generate_cpp_step(const Program& program);

}  // namespace hysteron
