// The Structured Text target: one FUNCTION_BLOCK that needs no other, for the compilers of PLCs.
#pragma once

#include <vector>

#include "codegen/backends/shared/generated_file.hpp"
#include "codegen/backends/st/pou.hpp"

namespace hysteron {

/// The block and, where the dialect has files for both, a program that calls it. The text depends on the program
/// alone, to the byte. Throws InputError: HY404 where the diagram states no sample time, HY732 where a name is longer
/// than the dialect allows.
std::vector<GeneratedFile> generate_st(const Program& program, const StOptions& options);

}  // namespace hysteron
