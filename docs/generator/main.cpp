// Prints the reference of the blocks into a folder: the index between its marks in README.md, and for each block its
// page and its picture. Called by scripts/make-reference.
#include <fmt/format.h>

#include <filesystem>
#include <string>
#include <vector>

#include "codegen/backends/reference/block_picture.hpp"
#include "codegen/backends/reference/reference_pages.hpp"
#include "codegen/trace/sized_block.hpp"
#include "support/atomic_file.hpp"
#include "support/diagnostic.hpp"
#include "support/text_file.hpp"

int main(int argc, char** argv) {
  namespace fs = std::filesystem;
  if (argc != 2) {
    fmt::print(stderr, "usage: make_reference REFERENCE_FOLDER\n");
    return 2;
  }
  const fs::path reference = argv[1];
  try {
    std::vector<hysteron::OutputFile> files;
    const fs::path index = reference / "README.md";
    files.push_back({index, hysteron::with_block_index(hysteron::read_text_file(index.string()))});
    for (const hysteron::BlockType* const block : hysteron::documented_blocks()) {
      files.push_back({reference / hysteron::reference_page_path(*block), hysteron::reference_page(*block)});
      if (block->sized == nullptr) {
        files.push_back({reference / hysteron::reference_picture_path(*block), hysteron::block_picture(*block)});
      }
    }
    hysteron::write_files_atomically(files);
  } catch (const std::exception& problem) {
    fmt::print(stderr, "make_reference: {}\n", problem.what());
    return 1;
  }
  return 0;
}
