#include "codegen/backends/reference/reference_pages.hpp"

#include <fmt/format.h>

#include <stdexcept>

#include "codegen/backends/reference/block_page.hpp"

namespace hysteron {
namespace {

constexpr std::string_view begin_mark = "<!-- blocks: printed by scripts/make-reference -->\n";
constexpr std::string_view end_mark = "<!-- end of blocks -->\n";

}  // namespace

std::string reference_page_path(const BlockType& block) {
  return fmt::format("blocks/{}.md", block.about.name);
}

std::string reference_picture_path(const BlockType& block) {
  return fmt::format("blocks/pictures/{}.svg", block.about.name);
}

std::string reference_page(const BlockType& block) {
  return fmt::format(
      "<!-- Printed by scripts/make-reference from the block's header; not to be edited. -->\n"
      "[Reference](../README.md) · {}\n\n{}",
      group_name(block.about.group),
      block_page(block, {.picture = block.sized != nullptr ? std::string()
                                                           : fmt::format("pictures/{}.svg", block.about.name)}));
}

std::string with_block_index(std::string_view page) {
  const auto begin = page.find(begin_mark);
  const auto end = page.find(end_mark);
  if (begin == std::string_view::npos || end == std::string_view::npos || end < begin) {
    throw std::invalid_argument("the index page lacks the marks between which the blocks are listed");
  }
  return fmt::format("{}\n{}\n{}\n{}", page.substr(0, begin + begin_mark.size()), block_index("blocks"),
                     family_index("blocks"), page.substr(end));
}

}  // namespace hysteron
