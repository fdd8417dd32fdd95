// The reference of the blocks as files: what stands where below docs/reference.
#pragma once

#include <string>
#include <string_view>

#include "codegen/trace/block_type.hpp"

namespace hysteron {

/// blocks/HY_LAG.md
[[nodiscard]] std::string reference_page_path(const BlockType& block);
/// blocks/pictures/HY_LAG.svg
[[nodiscard]] std::string reference_picture_path(const BlockType& block);

/// The page of a block with its picture and a link back to the index.
[[nodiscard]] std::string reference_page(const BlockType& block);

/// The text of the index page, what stands between its two marks replaced by the list of blocks. Throws
/// std::invalid_argument where a mark is missing.
[[nodiscard]] std::string with_block_index(std::string_view page);

}  // namespace hysteron
