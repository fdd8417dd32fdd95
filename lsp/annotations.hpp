// What may stand in the comment of a declaration: the keys of annotations, and units behind @unit.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string_view>

#include "codegen/language/syntax.hpp"

namespace hysteron::lsp {

/// A list of CompletionItem for an offset within a comment: units behind `@unit`, those of the file first, keys behind
/// `@`; empty elsewhere.
[[nodiscard]] nlohmann::json annotation_completion(std::string_view text, const language::SourceFile& tree,
                                                   const language::Span& comment, std::size_t offset);

}  // namespace hysteron::lsp
