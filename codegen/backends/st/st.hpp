// The Structured Text target: one FUNCTION_BLOCK that needs no other, for the compilers of PLCs.
#pragma once

#include <cstdint>
#include <vector>

#include "codegen/backends/shared/generated_file.hpp"
#include "codegen/backends/st/pou.hpp"

namespace hysteron {

/// The block and, where the dialect has files for both, a program that calls it. The text depends on the program
/// alone, to the byte. Throws InputError: HY404 where the diagram states no sample time, HY732 where a name is longer
/// than the dialect allows.
std::vector<GeneratedFile> generate_st(const Program& program, const StOptions& options);

/// The diagram as calls of its blocks, and the blocks of the library that it calls: in one file, or in a file each
/// where the dialect wants that. The diagram is the first file, or the end of the only one. Throws InputError HY404,
/// HY732, and HY742 where single calls cannot compute it.
std::vector<GeneratedFile> generate_st_structured(const Program& program, const StOptions& options);

/// All blocks of the library, for diagrams as they are written.
std::vector<GeneratedFile> generate_st_library(std::int64_t sample_time_ns, const StOptions& options);

}  // namespace hysteron
