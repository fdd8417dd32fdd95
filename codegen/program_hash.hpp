// A hash of a diagram and its parameters: two programs with the same hash compute the same.
#pragma once

#include <string>

#include "codegen/compile.hpp"

namespace hysteron {

/// The first 16 hexadecimal digits of the SHA-256 over ports, nodes, wires, literals, parameters and sample time.
/// Layout, comments and the order of the text do not count.
std::string program_hash(const Program& program);

}  // namespace hysteron
