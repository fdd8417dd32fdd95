// The step of a program as calls of its blocks, which stay blocks: for a target that has the library in its own
// language. Each block is called once in a step, by the convention of docs/explanation/semantics.md.
#pragma once

#include <cstdint>
#include <vector>

#include "codegen/backends/shared/routine.hpp"

namespace hysteron {

/// A block of the diagram as an instance.
struct BlockInstance {
  std::uint32_t node = 0;
  std::vector<bool> ahead{};                ///< by output: as the block is wired, it depends on memory alone
  std::vector<std::uint32_t> settings{};    ///< parameters that stand with the declaration, by their index in the graph
  std::vector<std::uint32_t> array_pins{};  ///< pins whose arrays are variables of the caller
};

struct CallRoutine {
  /// Its cells are the outputs of all blocks, then what slower parts hold, then the counter of steps. A call in
  /// `routine.reset` lets the memory of a block begin anew and makes no step.
  Routine routine{};
  std::uint32_t output_cells = 0;
  std::vector<BlockInstance> instances{};  ///< by node, without operations
  std::vector<bool> is_setting{};          ///< by parameter of the graph: it stands with an instance
};

/// Throws InputError HY742 where no order of single calls has the meaning of the program: an input of a block waits for
/// an output of the same block, or a state begins where a parameter file says.
CallRoutine make_calls(const Program& program);

}  // namespace hysteron
