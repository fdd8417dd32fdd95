#include "lsp/words.hpp"

#include "codegen/language/reporter.hpp"

namespace hysteron::lsp {

using language::Symbol;
using language::Token;

Tokens tokens_of(std::string_view text) {
  language::Reporter refused;
  language::Lexer lexer(text, language::Comments::All, &refused);
  Tokens tokens;
  for (Token one = lexer.next(); one.symbol != Symbol::End; one = lexer.next()) {
    tokens.list.push_back(one);
  }
  tokens.comments = lexer.comments();
  return tokens;
}

std::string_view word(std::string_view text, const Token& token) {
  return text.substr(token.offset, token.length);
}

bool touches(const language::Span& span, std::size_t offset) {
  return span.offset <= offset && offset <= span.offset + span.length;
}

std::string_view called_name(std::string_view text, const std::vector<Token>& tokens, std::size_t before) {
  int depth = 0;
  for (std::size_t i = before; i-- > 0;) {
    const auto symbol = tokens[i].symbol;
    if (symbol == Symbol::Semicolon) {
      return {};
    }
    depth += symbol == Symbol::RightParenthesis ? 1 : symbol == Symbol::LeftParenthesis ? -1 : 0;
    if (depth < 0) {
      const auto name = i > 1 && tokens[i - 1].symbol == Symbol::Assign ? i - 2 : i - 1;
      return i > 0 && tokens[name].symbol == Symbol::Identifier ? word(text, tokens[name]) : std::string_view();
    }
  }
  return {};
}

}  // namespace hysteron::lsp
