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
    collect_names();
    std::vector<TextPart> found;
    while (token_.symbol != Symbol::End) {
      if (token_.keyword == Keyword::FunctionBlock) {
        found.push_back(block());
      } else if (is("TYPE") || is("FUNCTION") || is("VAR_GLOBAL")) {
        found.push_back(unit(is("TYPE")       ? TextPart::Kind::Types
                             : is("FUNCTION") ? TextPart::Kind::Function
                                              : TextPart::Kind::Globals));
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

  /// Whether a word may stand somewhere: most texts have no FUNCTION, TYPE or VAR_GLOBAL, and need not be read for
  /// their names.
  [[nodiscard]] bool may_have(std::string_view wanted) const {
    for (std::size_t at = 0; at + wanted.size() <= text_.size(); ++at) {
      if ((text_[at] | 0x20) != (wanted.front() | 0x20) || !same_name(text_.substr(at, wanted.size()), wanted)) {
        continue;
      }
      const bool part_of_another = (at > 0 && text_[at - 1] == '_') || text_.substr(at + wanted.size(), 1) == "_";
      if (!part_of_another) {  // FUNCTION_BLOCK, END_FUNCTION
        return true;
      }
    }
    return false;
  }

  /// The names of the FUNCTIONs, TYPEs and global constants of the text: to call one, to declare a variable of one or
  /// to read one is to be sequential.
  void collect_names() {
    if (!may_have("FUNCTION") && !may_have("TYPE") && !may_have("VAR_GLOBAL")) {
      return;
    }
    Lexer lexer(text_, Comments::Annotated, nullptr);
    std::unordered_set<std::string>* names = nullptr;  // of the part that is read
    bool begins = false;                               // a declaration of it
    int structures = 0;
    for (Token one = lexer.next(); one.symbol != Symbol::End; one = lexer.next()) {
      const auto text = text_.substr(one.offset, one.length);
      const auto is_word = [&](std::string_view word) { return one.keyword != Keyword::None && same_name(text, word); };
      const bool declared = one.symbol == Symbol::Identifier && begins && structures == 0;
      if (declared && names != nullptr) {
        names->insert(upper(text));
      }
      if (is_word("FUNCTION") || is_word("TYPE") || is_word("VAR_GLOBAL")) {
        names = is_word("FUNCTION") ? &functions_ : is_word("TYPE") ? &types_ : &globals_;
      } else if (is_word("END_TYPE") || is_word("END_VAR") || (declared && names == &functions_)) {
        names = nullptr;
      }
      structures += is_word("STRUCT") ? 1 : is_word("END_STRUCT") ? -1 : 0;
      begins = names != nullptr && (one.symbol == Symbol::Semicolon || one.symbol == Symbol::Comma ||
                                    (one.keyword != Keyword::None && !is_word("END_STRUCT")));
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
    std::unordered_set<std::string> own;  // names that it declares
    while (token_.symbol != Symbol::End && token_.keyword != Keyword::EndFunctionBlock &&
           token_.keyword != Keyword::FunctionBlock) {
      declares = token_.keyword == Keyword::EndVar
                     ? false
                     : declares || token_.keyword == Keyword::Var || token_.keyword == Keyword::VarInput ||
                           token_.keyword == Keyword::VarOutput;
      part.sequential = part.sequential || token_.keyword == Keyword::ControlBegin || is("RETURN") || is("VAR_TEMP") ||
                        is("VAR_IN_OUT") || token_.keyword == Keyword::Qualifier || (declares && typed && is_type()) ||
                        is_time() || (!declares && called && token_.symbol == Symbol::LeftParenthesis) ||
                        is("VAR_EXTERNAL") || reads_global(declares, typed, own);
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
    const std::string_view end = kind == TextPart::Kind::Types      ? "END_TYPE"
                                 : kind == TextPart::Kind::Function ? "END_FUNCTION"
                                                                    : "END_VAR";
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
    if (same_name(word(), "ARRAY")) {
      return !is_vector();
    }
    if (token_.symbol == Symbol::Identifier && !types_.empty() && types_.contains(upper(word()))) {
      return true;
    }
    if (is_elementary_type(word())) {  // DINT (0..9)
      Lexer lexer = lexer_;
      return lexer.next().symbol == Symbol::LeftParenthesis;
    }
    return std::ranges::any_of(types_of_bodies, [&](std::string_view type) { return same_name(type, word()); });
  }
  /// Notes what the block declares; whether it names a global constant that it does not declare.
  [[nodiscard]] bool reads_global(bool declares, bool typed, std::unordered_set<std::string>& own) const {
    if (globals_.empty() || token_.symbol != Symbol::Identifier) {
      return false;
    }
    const std::string name = upper(word());
    Lexer lexer = lexer_;
    const Symbol next = declares && !typed ? lexer.next().symbol : Symbol::End;
    if (next == Symbol::Colon || next == Symbol::Comma) {
      own.insert(name);
      return false;
    }
    return globals_.contains(name) && !own.contains(name);
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
  std::unordered_set<std::string> types_{};
  std::unordered_set<std::string> globals_{};
};

}  // namespace

std::vector<TextPart> parts_with_bodies(std::string_view text) {
  return Scan(text).parts();
}

}  // namespace hysteron::language
