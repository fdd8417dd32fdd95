// Whether the files of a target do what the diagram does: each is run beside the interpreter over the same inputs.
//
//   cpp, c    compiled by the system's compiler
//   batch     compiled; all lanes take the same inputs
//   fmu       its sources compiled, and stepped through the functions of FMI
//   st        read back as a diagram
//   plcopen   imported, and read back as a diagram
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "codegen/backends/shared/generated_file.hpp"
#include "codegen/compile.hpp"
#include "tool/targets.hpp"

namespace hysteron::tool {

struct TargetProof {
  std::string way{};        ///< how it was run: the compiler, or "read back"
  std::size_t steps = 0;    ///< compared
  std::size_t outputs = 0;  ///< by so many outputs
  std::string fault{};      ///< empty where all bits are equal; else where they differ, or why it could not be run
  bool was_run = false;
  std::optional<std::size_t> stack_bytes{};  ///< of C: what a step takes at most, as its compiler says
};

/// Random inputs of a fixed seed: within the ranges that the diagram states, else of size 1 about 0.
[[nodiscard]] TargetProof prove(const Program& program, const Target& target, const std::vector<GeneratedFile>& files,
                                const TargetOptions& options);

}  // namespace hysteron::tool
