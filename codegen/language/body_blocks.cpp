#include "codegen/language/body_blocks.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <unordered_set>

#include "codegen/language/lexer.hpp"
#include "codegen/language/syntax.hpp"

namespace hysteron::language {
namespace {

constexpr std::array<std::string_view, 9> types_of_bodies{"SINT", "INT",   "USINT", "UINT", "UDINT",
                                                          "BYTE", "DWORD", "REAL",  "TIME"};

class Scan {
 public:
  explicit Scan(std::string_view text) : text_(text), lexer_(text, Comments::Annotated, nullptr) { advance(); }

  std::vector<TextPart> parts() {
    collect_functions();
    std::vector<TextPart> found;
    while (token_.symbol != Symbol::End) {
      if (token_.keyword == Keyword::FunctionBlock) {
        found.push_back(block());
      } else if (is("TYPE") || is("FUNCTION")) {
        found.push_back(unit(is("TYPE") ? TextPart::Kind::Types : TextPart::Kind::Function));
      } else {
        advance();
      }
    }
    const bool any = std::ranges::any_of(found, &TextPart::sequential);
    return any ? found : std::vector<TextPart>{};
  }

 private:
  [[nodiscard]] std::string_view word() const { return text_.substr(token_.offset, token_.length); }
  [[nodiscard]] bool is(std::string_view name) const {
    return token_.keyword != Keyword::None && same_name(word(), name);
  }
  void advance() {
    last_end_ = token_.end();
    token_ = lexer_.next();
  }

  /// Whether the word FUNCTION may stand somewhere: most texts have none, and need not be read for their names.
  [[nodiscard]] bool may_have_functions() const {
    constexpr std::string_view word = "FUNCTION";
    for (std::size_t at = 0; at + word.size() <= text_.size(); ++at) {
      if ((text_[at] | 0x20) != 'f' || !same_name(text_.substr(at, word.size()), word)) {
        continue;
      }
      const bool part_of_another = (at > 0 && text_[at - 1] == '_') || text_.substr(at + word.size(), 1) == "_";
      if (!part_of_another) {  // FUNCTION_BLOCK, END_FUNCTION
        return true;
      }
    }
    return false;
  }

  /// The names of the FUNCTIONs of the text: to call one is to be sequential.
  void collect_functions() {
    if (!may_have_functions()) {
      return;
    }
    Lexer lexer(text_, Comments::Annotated, nullptr);
    bool function = false;
    for (Token one = lexer.next(); one.symbol != Symbol::End; one = lexer.next()) {
      const auto text = text_.substr(one.offset, one.length);
      if (function && one.symbol == Symbol::Identifier) {
        functions_.insert(upper(text));
      }
      function = one.keyword == Keyword::Unit && same_name(text, "FUNCTION");
    }
  }

  TextPart block() {
    TextPart part{.kind = TextPart::Kind::Block, .begin = token_.offset};
    advance();
    advance();
    const auto head = text_.substr(last_end_, token_.offset - last_end_);
    part.sequential = marked(head);
    bool declares = false;
    bool typed = false;
    bool called = false;
    while (token_.symbol != Symbol::End && token_.keyword != Keyword::EndFunctionBlock &&
           token_.keyword != Keyword::FunctionBlock) {
      declares = token_.keyword == Keyword::EndVar
                     ? false
                     : declares || token_.keyword == Keyword::Var || token_.keyword == Keyword::VarInput ||
                           token_.keyword == Keyword::VarOutput;
      part.sequential = part.sequential || token_.keyword == Keyword::ControlBegin || is("RETURN") || is("VAR_TEMP") ||
                        is("VAR_IN_OUT") || token_.keyword == Keyword::Qualifier || (declares && typed && is_type()) ||
                        is_time() || (!declares && called && token_.symbol == Symbol::LeftParenthesis);
      called = token_.symbol == Symbol::Identifier && !functions_.empty() && functions_.contains(upper(word()));
      typed = token_.symbol == Symbol::Colon;
      advance();
    }
    if (token_.keyword == Keyword::EndFunctionBlock) {
      advance();
    }
    part.end = last_end_;
    return part;
  }

  TextPart unit(TextPart::Kind kind) {
    TextPart part{.kind = kind, .begin = token_.offset};
    const std::string_view end = kind == TextPart::Kind::Types ? "END_TYPE" : "END_FUNCTION";
    while (token_.symbol != Symbol::End && token_.keyword != Keyword::FunctionBlock && !is(end)) {
      advance();
    }
    if (is(end)) {
      advance();
    }
    part.end = last_end_;
    return part;
  }

  [[nodiscard]] bool is_type() const {
    return same_name(word(), "ARRAY")
               ? !is_vector()
               : std::ranges::any_of(types_of_bodies, [&](std::string_view type) { return same_name(type, word()); });
  }
  /// ARRAY[0..3] OF LREAL, which a diagram has, too: one dimension that begins at 0, of one of its four types.
  [[nodiscard]] bool is_vector() const {
    Lexer lexer = lexer_;
    const auto text = [&](const Token& token) { return text_.substr(token.offset, token.length); };
    if (lexer.next().symbol != Symbol::LeftBracket || text(lexer.next()) != "0") {
      return false;
    }
    Token one = lexer.next();
    while (one.symbol != Symbol::RightBracket && one.symbol != Symbol::Comma && one.symbol != Symbol::Semicolon &&
           one.symbol != Symbol::End) {
      one = lexer.next();
    }
    return one.symbol == Symbol::RightBracket && same_name(text(lexer.next()), "OF") &&
           is_elementary_type(text(lexer.next()));
  }
  [[nodiscard]] bool is_time() const {
    if (token_.symbol != Symbol::Typed) {
      return false;
    }
    const auto type = word().substr(0, word().find('#'));
    return same_name(type, "T") || same_name(type, "TIME");
  }
  static bool marked(std::string_view comments) {
    for (auto at = comments.find('@'); at != std::string_view::npos; at = comments.find('@', at + 1)) {
      const auto word = comments.substr(at + 1, 4);
      const auto after = comments.substr(std::min(comments.size(), at + 5), 1);
      if (same_name(word, "body") &&
          (after.empty() || after == " " || after == "*" || after == "\n" || after == "\r")) {
        return true;
      }
    }
    return false;
  }

  std::string_view text_;
  Lexer lexer_;
  Token token_{};
  std::uint32_t last_end_ = 0;
  std::unordered_set<std::string> functions_{};
};

}  // namespace

std::vector<TextPart> parts_with_bodies(std::string_view text) {
  return Scan(text).parts();
}

}  // namespace hysteron::language
