// The cases of a test file as a bench in Structured Text, which runs them on the PLC.
#pragma once

#include <string>
#include <vector>

#include "codegen/backends/shared/generated_file.hpp"
#include "codegen/backends/st/dialect.hpp"
#include "tool/test_plan.hpp"

namespace hysteron::tool {

/// What the bench of a diagram's file is made of: the block NAME_TEST, and the files that hold it. A golden record
/// counts as what is expected of each output. Throws InputError HY728 where a case cannot be written, and HY723 where
/// its golden record is missing or does not fit.
[[nodiscard]] std::vector<GeneratedFile> bench_files(const std::string& diagram, const std::vector<PlannedCase>& cases,
                                                     const StDialect& dialect);

}  // namespace hysteron::tool
