// What stands under the cursor, and what may stand there: the lexer's tokens, read with the parser's tree.
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "codegen/language/syntax.hpp"
#include "codegen/trace/block_type.hpp"

namespace hysteron::lsp {

/// The description of a block, as its reader sees it.
using Card = std::function<std::string(const BlockType&)>;

/// A text and what the parser made of it. Where the text is broken, `known` is the tree of the last text that was not.
struct Insight {
  std::string_view text;
  const language::SourceFile& tree;
  const language::SourceFile* known = nullptr;
};

/// What to say of the word at an offset: the card of a block or of an instance's block, the meaning of a pin. Empty
/// where there is nothing to say.
[[nodiscard]] std::string hover(const Insight& insight, std::size_t offset, const Card& card);

/// The names that may stand at an offset, as a list of CompletionItem: the outputs behind `INSTANCE.`, inputs and
/// parameters within the parentheses of a call, block types behind a colon; else keywords and the variables. In a
/// comment the keys of annotations, and units.
[[nodiscard]] nlohmann::json completion(const Insight& insight, std::size_t offset);

}  // namespace hysteron::lsp
