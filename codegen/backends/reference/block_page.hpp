// The page of a block in the reference, in Markdown. Everything on it comes from the block's header: the description,
// the feedthrough from its trace, and an example that compiles.
#pragma once

#include <string>
#include <string_view>

#include "codegen/trace/block_type.hpp"

namespace hysteron {

/// A group in a word, as `hysteron blocks` prints it: memory, dynamics.
[[nodiscard]] std::string_view group_name(Group group);

/// A field's range in words: `above 0 and at most 1`; empty where everything is allowed.
[[nodiscard]] std::string range_text(const Field& field);

/// Where a diagnosis tries the effect of a block, and with which values, each sentence behind a blank; empty: anywhere,
/// with any. A name stands between `quote`s.
[[nodiscard]] std::string limits_of_effect(const BlockType& block, std::string_view quote);

/// A value as the field's type writes it: `TRUE`, `0.5`.
[[nodiscard]] std::string value_text(const Field& field, double value);

struct BlockPageOptions {
  int heading = 1;             ///< level of the block's own heading; parts of it are one level below
  std::string_view picture{};  ///< path of the picture of its response; empty: none
};

/// Name, equation, meaning, picture, pins, parameters and states with unit, range, default and neutral setting,
/// feedthrough by output and input, delay, example, source.
[[nodiscard]] std::string block_page(const BlockType& block, const BlockPageOptions& options = {});

/// The index of the reference: every block with its title, by group, with links to pages NAME.md below `folder`.
[[nodiscard]] std::string block_index(std::string_view folder);

/// The families of effects, each with its effects and the blocks that have them.
[[nodiscard]] std::string family_index(std::string_view folder);

}  // namespace hysteron
