// An FMU as one file: the generated sources, compiled by the system's C compiler where there is one, and packed.
#pragma once

#include "codegen/backends/fmu/fmu.hpp"
#include "support/diagnostic.hpp"

namespace hysteron::tool {

/// NAME.fmu. Without a C compiler ($CC, cc, gcc, clang) it has sources alone, and a warning HY748 says so. Throws
/// InputError: HY404 for a diagram without a sample time, HY726 where the compiler refuses.
[[nodiscard]] GeneratedFile pack_fmu(const Program& program, const FmuOptions& options, Diagnostics& warnings);

}  // namespace hysteron::tool
