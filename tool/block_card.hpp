// The description of a block, printed: for a terminal, as Markdown, as JSON. All of it comes from the block's header.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "codegen/trace/block_type.hpp"

namespace hysteron::tool {

[[nodiscard]] std::string_view group_name(Group group);

/// A field's range in words: `above 0 and at most 1`; empty where everything is allowed.
[[nodiscard]] std::string range_text(const Field& field);

/// The value where nothing is connected or set: `TRUE`, `0.5`; empty where there is none.
[[nodiscard]] std::string preset_text(const Field& field);

/// Inputs, and nothing else, that an output depends on within the same step.
[[nodiscard]] std::vector<std::string_view> feedthrough_inputs(const BlockType& block, std::size_t output);

[[nodiscard]] std::string card_text(const BlockType& block);
[[nodiscard]] std::string card_markdown(const BlockType& block);
[[nodiscard]] nlohmann::json card_json(const BlockType& block);

}  // namespace hysteron::tool
