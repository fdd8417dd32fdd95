// The committed reference is what the descriptions of the blocks say, and every block has its page and picture.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <set>
#include <string>

#include "codegen/backends/reference/block_picture.hpp"
#include "codegen/backends/reference/block_response.hpp"
#include "codegen/backends/reference/reference_pages.hpp"
#include "codegen/compile.hpp"
#include "codegen/trace/sized_block.hpp"
#include "tests/docs/page.hpp"

namespace hysteron::test {
namespace {

constexpr const char* remedy = ": run scripts/make-reference and commit what it changes";

std::filesystem::path reference_folder() {
  return source_folder() / "docs" / "reference";
}

TEST(Reference, PagesSayWhatTheDescriptionsSay) {
  for (const BlockType* const block : documented_blocks()) {
    const auto path = reference_folder() / reference_page_path(*block);
    EXPECT_EQ(contents_of(path), reference_page(*block)) << path << remedy;
  }
}

TEST(Reference, TheIndexListsEveryBlock) {
  const auto index = contents_of(reference_folder() / "README.md");
  EXPECT_EQ(index, with_block_index(index)) << remedy;
  for (const BlockType* const block : documented_blocks()) {
    EXPECT_NE(index.find("(" + reference_page_path(*block) + ")"), std::string::npos) << block->about.name;
  }
}

TEST(Reference, EveryBlockHasASmallPicture) {
  for (const BlockType& block : block_types()) {
    const auto picture = contents_of(reference_folder() / reference_picture_path(block));
    EXPECT_TRUE(picture.starts_with("<svg ") && picture.ends_with("</svg>\n")) << block.about.name << remedy;
    EXPECT_LT(picture.size(), 15000U) << block.about.name;
  }
}

TEST(Reference, NoPageIsLeftOfABlockThatIsGone) {
  std::set<std::filesystem::path> expected;
  for (const BlockType* const block : documented_blocks()) {
    expected.insert(reference_folder() / reference_page_path(*block));
    if (block->sized == nullptr) {
      expected.insert(reference_folder() / reference_picture_path(*block));
    }
  }
  for (const auto& entry : std::filesystem::recursive_directory_iterator(reference_folder() / "blocks")) {
    EXPECT_TRUE(entry.is_directory() || expected.contains(entry.path())) << entry.path() << remedy;
  }
}

TEST(Reference, EveryResponseMoves) {
  for (const BlockType& block : block_types()) {
    const BlockResponse response = block_response(block);
    bool any_output = false;
    bool any_motion = false;
    for (const ResponseTrace& trace : response.traces) {
      any_output = any_output || !trace.is_input;
      for (const double value : trace.values) {
        EXPECT_TRUE(std::isfinite(value)) << block.about.name << " " << trace.name;
        any_motion = any_motion || (!trace.is_input && value != trace.values.front());
      }
    }
    EXPECT_TRUE(any_output) << block.about.name;
    EXPECT_TRUE(any_motion || block.about.name == "HY_CONSTANT") << block.about.name << " stands still in its picture";
  }
}

TEST(Reference, PicturesHaveTheSameBytesEachTime) {
  for (const BlockType& block : block_types()) {
    EXPECT_EQ(block_picture(block), block_picture(block)) << block.about.name;
  }
}

}  // namespace
}  // namespace hysteron::test
