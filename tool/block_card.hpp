// The description of a block, printed for a terminal and as JSON. All of it comes from the block's header.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "codegen/trace/block_type.hpp"

namespace hysteron::tool {

/// Inputs, and nothing else, that an output depends on within the same step.
[[nodiscard]] std::vector<std::string_view> feedthrough_inputs(const BlockType& block, std::size_t output);

[[nodiscard]] std::string card_text(const BlockType& block);
[[nodiscard]] nlohmann::json card_json(const BlockType& block);

}  // namespace hysteron::tool
