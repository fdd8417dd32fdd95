// The picture of a block's response, as SVG: numbers over time with truth values below them, or a curve or loop.
#pragma once

#include <string>

#include "codegen/trace/block_type.hpp"

namespace hysteron {

[[nodiscard]] std::string block_picture(const BlockType& block);

}  // namespace hysteron
