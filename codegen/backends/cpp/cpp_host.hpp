// The program round a generated step: reads a record, runs the step over it, writes a record; and its CMakeLists.
#pragma once

#include "codegen/backends/cpp/cpp.hpp"

namespace hysteron {

GeneratedFile cpp_host_main(const Program& program);
GeneratedFile cpp_host_cmake(const Program& program);

}  // namespace hysteron
