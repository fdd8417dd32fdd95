// The description of a block, printed for a terminal and as JSON. All of it comes from the block's header.
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "codegen/trace/block_type.hpp"

namespace hysteron::tool {

/// Inputs, and nothing else, that an output depends on within the same step.
[[nodiscard]] std::vector<std::string_view> feedthrough_inputs(const BlockType& block, std::size_t output);

/// Lines no longer than `terminal`, as far as words can be broken; 0: paragraphs of 100 characters, rows as they are.
[[nodiscard]] std::string card_text(const BlockType& block, std::size_t terminal = 0);
[[nodiscard]] nlohmann::json card_json(const BlockType& block);

}  // namespace hysteron::tool
