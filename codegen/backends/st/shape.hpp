// A POU as the text of its file.
#pragma once

#include <string>
#include <string_view>

#include "codegen/backends/st/pou.hpp"

namespace hysteron {

/// A FUNCTION_BLOCK. `mark` stands behind its name.
[[nodiscard]] std::string st_text(const StPou& block, StDialect::Shape shape, std::string_view mark = "");

/// A PROGRAM, where all POUs stand in one text.
[[nodiscard]] std::string st_program_text(const StPou& program);

/// Whether a file of this shape may hold several blocks.
[[nodiscard]] constexpr bool holds_several_blocks(StDialect::Shape shape) {
  return shape == StDialect::Shape::OneFile || shape == StDialect::Shape::Source;
}

}  // namespace hysteron
