// The C99 target: NAME.h and NAME.c, a step over structures that the caller owns.
#pragma once

#include <vector>

#include "codegen/backends/shared/generated_file.hpp"
#include "codegen/compile.hpp"

namespace hysteron {

struct COptions {
  bool float32 = false;  ///< real numbers of the target are float
};

/// The text depends on the program alone, to the byte. Throws InputError (HY404) where the diagram states no sample
/// time.
std::vector<GeneratedFile> generate_c(const Program& program, const COptions& options = {});

}  // namespace hysteron
