// The words of a text that may be broken, and what stands around them.
#pragma once

#include <string_view>
#include <vector>

#include "codegen/language/lexer.hpp"

namespace hysteron::lsp {

struct Tokens {
  std::vector<language::Token> list{};
  std::vector<language::Comment> comments{};
};

/// What the lexer refuses is left out.
[[nodiscard]] Tokens tokens_of(std::string_view text);

[[nodiscard]] std::string_view word(std::string_view text, const language::Token& token);

/// Whether an offset lies in a stretch of the text, or at one of its ends.
[[nodiscard]] bool touches(const language::Span& span, std::size_t offset);

/// The call or the declaration within whose parentheses a token stands: the name before them, none where there is none.
[[nodiscard]] std::string_view called_name(std::string_view text, const std::vector<language::Token>& tokens,
                                           std::size_t before);

}  // namespace hysteron::lsp
