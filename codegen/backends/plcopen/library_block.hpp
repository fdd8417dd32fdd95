// A block of the library as a POU of its own, by the convention of docs/explanation/semantics.md: a call leaves in
// outputs of memory alone what they are in the next step.
#pragma once

#include <cstdint>

#include "codegen/backends/st/pou.hpp"
#include "codegen/trace/block_type.hpp"

namespace hysteron::plcopen {

/// `sample_time_ns` is that of the task. Parameters are inputs, with the block's own names. `options.outputs_ahead`
/// says which outputs depend on memory alone, as the block is wired.
[[nodiscard]] StPou library_pou(const BlockType& block, std::int64_t sample_time_ns, const StOptions& options);

}  // namespace hysteron::plcopen
