// The lexer: text to tokens, one at a time, in one pass over the text and without copying any of it.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "codegen/language/reporter.hpp"
#include "codegen/language/token.hpp"

namespace hysteron::language {

/// A comment, and how it stands to what is before it.
struct Comment {
  Span span{};
  std::uint32_t previous_end = 0;  ///< where the token before it ends; 0 if there is none
  bool trailing = false;           ///< no line ends between that token and the comment
};

/// Which comments a lexer keeps.
enum class Comments : std::uint8_t { All, Annotated };

class Lexer {
 public:
  /// Errors go to the reporter; without one, a text known to be right is read.
  Lexer(std::string_view text, Comments kept, Reporter* reporter);

  /// The next token; Symbol::End for ever after the last.
  Token next();

  [[nodiscard]] const std::vector<Comment>& comments() const { return comments_; }

  /// Goes on at an offset.
  void go_to(std::uint32_t offset) {
    at_ = offset;
    previous_end_ = offset;
  }
  /// Takes what PLC compilers write beside the standard: // and /* */, pragmas, comments in comments, any underscore.
  void take_foreign() { foreign_ = true; }

 private:
  void skip_blank();
  void skip_line();
  void skip_comment();
  void skip_foreign_comment();
  void skip_pragma();
  void skip_illegal();
  Token identifier();
  Token number(std::uint32_t start);
  void scan_number();
  Token typed(std::uint32_t start);
  Token quoted();
  Token address();
  void refuse_part(std::uint32_t start);
  Token sign();
  Token token(Symbol symbol, std::uint32_t start) const { return {start, at_ - start, symbol, Keyword::None}; }
  [[nodiscard]] char peek(std::uint32_t ahead = 0) const { return ahead < size_ - at_ ? text_[at_ + ahead] : '\0'; }
  void error(int number, std::uint32_t start, std::uint32_t length, std::string cause, std::string mend);

  std::string_view text_;
  std::uint32_t size_;
  std::uint32_t at_ = 0;
  std::uint32_t previous_end_ = 0;
  bool line_ended_ = true;  ///< since the last token or trailing comment
  bool no_brace_ahead_ = false;
  bool foreign_ = false;
  Comments kept_;
  Reporter* reporter_;
  std::vector<Comment> comments_;
};

}  // namespace hysteron::language
