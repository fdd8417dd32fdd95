// A block of the library as a POU of its own, by the convention of docs/explanation/semantics.md: a call leaves in
// outputs of memory alone what they are in the next step.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "codegen/backends/st/pou.hpp"
#include "codegen/trace/block_type.hpp"

namespace hysteron {

/// `sample_time_ns` is that of the task. Parameters are inputs, with the block's own names. `options.outputs_ahead`
/// says which outputs depend on memory alone, as the block is wired.
[[nodiscard]] StPou library_pou(const BlockType& block, std::int64_t sample_time_ns, const StOptions& options);

/// Which outputs of a block are memory: those that no pin decides in the step, as long as pins that may be left open
/// are (`open_pins`); else those that no input decides at all.
[[nodiscard]] std::vector<bool> outputs_of_memory(const BlockType& block, bool open_pins);

/// One block of the library in the text: its outputs of memory, and what it is called for them. The plain name belongs
/// to outputs_of_memory with open pins, NAME_NOW to those without; others are numbered.
struct LibraryBlock {
  const BlockType* block = nullptr;
  std::vector<bool> ahead{};
  std::string name{};
  StPou pou{};
  bool sample_time = false;  ///< it has an input TS
};

/// The blocks of a text, by name and without repetition.
class LibraryText {
 public:
  LibraryText(std::int64_t sample_time_ns, StOptions options);

  /// The block for these outputs of memory; it is made where it is new.
  const LibraryBlock& block(const BlockType& type, const std::vector<bool>& ahead);
  /// Sorted by name.
  [[nodiscard]] std::vector<const LibraryBlock*> list() const;

 private:
  std::int64_t sample_time_ns_;
  StOptions options_;
  std::vector<LibraryBlock> blocks_;
};

}  // namespace hysteron
