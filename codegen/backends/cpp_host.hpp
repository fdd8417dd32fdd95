// The program round a generated step: reads a record, runs the step over it, writes a record; and its CMakeLists.
#pragma once

#include "codegen/backends/cpp.hpp"

namespace hysteron {

/// The members of In or Out, by port.
std::vector<std::string> cpp_port_names(const std::vector<Port>& ports);

GeneratedFile cpp_host_main(const Program& program);
GeneratedFile cpp_host_cmake(const Program& program);

}  // namespace hysteron
