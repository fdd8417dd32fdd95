#include "codegen/language/lexer.hpp"

#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <string>
#include <utility>

#include "support/byte_order_mark.hpp"
#include "support/errors.hpp"

namespace hysteron::language {
namespace {

enum Class : std::uint8_t { Illegal, Blank, Letter, Digit, Sign };

constexpr std::array<Class, 256> classes = [] {
  std::array<Class, 256> table{};
  for (const char c : std::string_view(" \t\r\n\f\v")) {
    table[static_cast<unsigned char>(c)] = Blank;
  }
  for (unsigned char c = 'a'; c <= 'z'; ++c) {
    table[c] = Letter;
    table[static_cast<unsigned char>(c - 'a' + 'A')] = Letter;
  }
  table['_'] = Letter;
  for (unsigned char c = '0'; c <= '9'; ++c) {
    table[c] = Digit;
  }
  for (const char c : std::string_view("()[],;:.=+-*/<>&'\"{%")) {
    table[static_cast<unsigned char>(c)] = Sign;
  }
  return table;
}();

Class class_of(char c) {
  return classes[static_cast<unsigned char>(c)];
}
bool is_digit(char c) {
  return class_of(c) == Digit;
}
bool is_word(char c) {
  static_assert(Letter + 1 == Digit);
  return static_cast<unsigned>(class_of(c)) - Letter <= 1U;
}
bool is_exponent_mark(char c) {
  return c == 'e' || c == 'E';
}

/// One character for a message: itself where it can be printed, else its number.
std::string shown(std::string_view at) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned>(static_cast<unsigned char>(at[i])); };
  const unsigned first = byte(0);
  if (first < 0x80) {
    return first < 0x20 || first == 0x7F ? fmt::format("The character U+{:04X}", first)
                                         : fmt::format("The character `{}`", at[0]);
  }
  const std::size_t length = first >= 0xF0 ? 4 : (first >= 0xE0 ? 3 : (first >= 0xC2 ? 2 : 0));
  if (length == 0 || first > 0xF4 || at.size() < length) {
    return fmt::format("The byte 16#{:02X}", first);
  }
  unsigned point = first & (0x7FU >> length);
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0U) != 0x80U) {
      return fmt::format("The byte 16#{:02X}", first);
    }
    point = point << 6U | (byte(i) & 0x3FU);
  }
  return fmt::format("The character U+{:04X}", point);
}

std::string_view mend_of_illegal(char c) {
  switch (c) {
    case '!':
      return "Write NOT for a negation and <> for unequal.";
    case '|':
      return "Write OR.";
    case '^':
      return "Write ** for a power; pointers are not part of a diagram.";
    case '?':
      return "To take one of two values write SEL(CONDITION, IF_FALSE, IF_TRUE).";
    case '}':
      return "Remove it; pragmas are not part of a diagram.";
    default:
      return "Remove it, or put it in a comment (* … *).";
  }
}

}  // namespace

Lexer::Lexer(std::string_view text, Comments kept, Reporter* reporter)
    : text_(text), size_(static_cast<std::uint32_t>(text.size())), kept_(kept), reporter_(reporter) {
  if (text_.substr(0, byte_order_mark.size()) == byte_order_mark) {
    at_ = static_cast<std::uint32_t>(byte_order_mark.size());
  }
}

void Lexer::error(int number, std::uint32_t start, std::uint32_t length, std::string cause, std::string mend) {
  if (reporter_ != nullptr) {
    reporter_->error(number, {start, length}, std::move(cause), std::move(mend));
  }
}

Token Lexer::next() {
  skip_blank();
  Token result{};
  if (at_ == size_) {
    result = token(Symbol::End, at_);
  } else if (class_of(peek()) == Letter) {
    result = identifier();
  } else if (is_digit(peek()) || (peek() == '.' && is_digit(peek(1)))) {
    result = number(at_);
  } else if (peek() == '\'' || peek() == '"') {
    result = quoted();
  } else if (peek() == '%') {
    result = address();
  } else {
    result = sign();
  }
  previous_end_ = result.end();
  line_ended_ = false;
  return result;
}

/// Passes over everything that is no token: blanks, comments, and what is refused wherever it stands.
void Lexer::skip_blank() {
  while (at_ < size_) {
    while (at_ < size_ && text_[at_] == ' ') {
      ++at_;
    }
    if (at_ == size_) {
      return;
    }
    const char c = text_[at_];
    if (class_of(c) == Blank) {
      line_ended_ = line_ended_ || c == '\n';
      ++at_;
    } else if (c == '(' && peek(1) == '*') {
      skip_comment();
    } else if (c == '/' && peek(1) == '/') {
      skip_line();
    } else if (c == '/' && peek(1) == '*') {
      skip_foreign_comment();
    } else if (c == '{') {
      skip_pragma();
    } else if (class_of(c) == Illegal) {
      skip_illegal();
    } else {
      return;
    }
  }
}

void Lexer::skip_line() {
  const auto start = at_;
  const auto end = text_.find('\n', at_);
  at_ = end == std::string_view::npos ? size_ : static_cast<std::uint32_t>(end);
  if (!foreign_) {
    error(error::foreign_comment, start, 2, "A comment that begins with // is not portable.",
          "Write it as (* … *), which every IEC compiler reads.");
  }
}

void Lexer::skip_foreign_comment() {
  const auto start = at_;
  const auto end = text_.find("*/", at_ + 2);
  at_ = end == std::string_view::npos ? size_ : static_cast<std::uint32_t>(end) + 2;
  if (!foreign_) {
    error(error::foreign_comment, start, 2, "A comment between /* and */ is not portable.",
          "Write it as (* … *), which every IEC compiler reads.");
  }
}

void Lexer::skip_comment() {
  const auto start = at_;
  const auto body = start + 2;
  bool nested = false;
  std::size_t star = text_.find('*', body);
  for (; star != std::string_view::npos; star = text_.find('*', star + 1)) {
    if (star > body && text_[star - 1] == '(' && !nested && !foreign_) {
      nested = true;
      error(error::foreign_comment, static_cast<std::uint32_t>(star) - 1, 2,
            "A comment inside a comment is not portable: the editions of the standard differ on where it ends.",
            "End the outer comment first, or leave the inner (* and *) out.");
    }
    if (star + 1 < size_ && text_[star + 1] == ')') {
      break;
    }
  }
  if (star == std::string_view::npos) {
    at_ = size_;
    error(error::endless_comment, start, 2, "This comment has no end.", "Close it with *) where it should end.");
  } else {
    at_ = static_cast<std::uint32_t>(star) + 2;
  }
  const auto comment = text_.substr(start, at_ - start);
  if (kept_ == Comments::All || comment.find('@') != std::string_view::npos) {
    comments_.push_back({{start, at_ - start}, previous_end_, !line_ended_});
  }
}

void Lexer::skip_pragma() {
  const auto start = at_;
  auto end = no_brace_ahead_ ? std::string_view::npos : text_.find('}', at_);
  if (end == std::string_view::npos) {
    no_brace_ahead_ = true;
    end = start;
  }
  at_ = static_cast<std::uint32_t>(end) + 1;
  if (foreign_ && end != start) {
    return;
  }
  error(error::pragma, start, 1, "A pragma {…} is not part of a diagram: each compiler reads it in its own way.",
        "Remove it; what is said of a variable stands in a comment such as (* @unit um *).");
}

void Lexer::skip_illegal() {
  const auto start = at_;
  while (at_ < size_ && class_of(text_[at_]) == Illegal) {
    ++at_;
  }
  if (foreign_ && text_[start] == '^') {
    return;  // a pointer: refused where it stands
  }
  error(error::illegal_character, start, at_ - start, shown(text_.substr(start)) + " has no meaning in a diagram.",
        std::string(mend_of_illegal(text_[start])));
}

Token Lexer::identifier() {
  const auto start = at_;
  const char* const begin = text_.data() + start;
  const char* const end_of_text = text_.data() + size_;
  const char* end = begin;
  bool underscores = false;
  for (; end != end_of_text && is_word(*end); ++end) {
    underscores |= *end == '_';
  }
  at_ += static_cast<std::uint32_t>(end - begin);
  if (peek() == '#') {
    return typed(start);
  }
  Token word = token(Symbol::Identifier, start);
  const std::string_view name = text_.substr(start, word.length);
  const bool doubled = underscores && name.find("__") != std::string_view::npos;
  if (underscores && (name.back() == '_' || doubled) && !foreign_) {
    error(error::name_not_portable, start, word.length,
          fmt::format("The name {} {}, which IEC 61131-3 does not allow.", name,
                      doubled ? "has two underscores in a row" : "ends in an underscore"),
          "Rename it, with single underscores between letters or digits.");
    return word;
  }
  word.keyword = keyword_of(name);
  if (word.keyword != Keyword::None) {
    word.symbol = Symbol::Keyword;
  }
  return word;
}

/// Takes in all that hangs together as a number, right or wrong; it is checked where its value is wanted.
void Lexer::scan_number() {
  const auto start = at_;
  const auto digits = [&] {
    while (at_ < size_ && (is_digit(text_[at_]) || text_[at_] == '_')) {
      ++at_;
    }
  };
  digits();
  if (peek() == '#') {
    ++at_;
  } else {
    if (peek() == '.' && peek(1) != '.') {
      ++at_;
      digits();
      if (text_[start] == '.' && peek() == '#') {  // W.16#1, which the parser refuses as one thing
        ++at_;
      }
    }
    if (at_ > start && is_exponent_mark(peek()) && (peek(1) == '+' || peek(1) == '-') && is_digit(peek(2))) {
      at_ += 2;
    }
  }
  while (at_ < size_ && is_word(text_[at_])) {
    ++at_;
  }
}

Token Lexer::number(std::uint32_t start) {
  scan_number();
  return token(Symbol::Number, start);
}

Token Lexer::typed(std::uint32_t start) {
  const auto type = text_.substr(start, at_ - start);
  ++at_;
  if (!is_elementary_type(type) && is_digit(peek())) {
    // A time or a date, perhaps: T#1m_2.5s, DT#2024-01-31-12:00:00; or a number with a base, DWORD#16#FF.
    while (at_ < size_ && (is_word(text_[at_]) || text_[at_] == '.' || (text_[at_] == '#' && is_word(peek(1))) ||
                           ((text_[at_] == '-' || text_[at_] == ':') && is_digit(peek(1))))) {
      ++at_;
    }
    return token(Symbol::Typed, start);
  }
  if (peek() == '-' || peek() == '+') {
    ++at_;
  }
  if (is_digit(peek())) {
    scan_number();
  } else {
    while (at_ < size_ && is_word(text_[at_])) {
      ++at_;
    }
  }
  return token(Symbol::Typed, start);
}

Token Lexer::quoted() {
  const auto start = at_;
  const char quote = text_[at_++];
  while (at_ < size_ && text_[at_] != quote && text_[at_] != '\n') {
    at_ += text_[at_] == '$' && at_ + 1 < size_ && text_[at_ + 1] != '\n' ? 2U : 1U;
  }
  if (peek() == quote) {
    ++at_;
  }
  error(error::text_literal, start, at_ - start, "A diagram carries numbers and truth values, not text.",
        "Remove it, or put it in a comment (* … *).");
  return token(Symbol::Refused, start);
}

/// W.%X3, W.%B1: behind the dot.
void Lexer::refuse_part(std::uint32_t start) {
  const std::string_view part = text_.substr(start, at_ - start);
  const bool bit = part.size() > 2 && (part[1] == 'X' || part[1] == 'x') && is_digit(part[2]);
  error(error::refused_access, start, at_ - start, fmt::format("A part of a variable is not written as {} here.", part),
        bit ? fmt::format("Write the number of the bit alone: .{}.", part.substr(2))
            : "Shift and mask instead: SHR(W, 8) AND 16#FF is the upper byte of a WORD.");
}

Token Lexer::address() {
  const auto start = at_++;
  while (at_ < size_ && (is_word(text_[at_]) || (text_[at_] == '.' && is_word(peek(1))) || text_[at_] == '*')) {
    ++at_;
  }
  if (start > 0 && text_[start - 1] == '.') {  // W.%X3 is a part of W, and no address
    refuse_part(start);
    return token(Symbol::Refused, start);
  }
  if (at_ == start + 1) {
    error(error::illegal_character, start, 1, "% stands for no operation.",
          "Write MOD for the remainder of whole numbers; an address such as %IX0.0 is no part of a diagram.");
    return token(Symbol::Refused, start);
  }
  error(error::direct_address, start, at_ - start,
        fmt::format("The address {} binds the diagram to one machine.", text_.substr(start, at_ - start)),
        "Make it a VAR_INPUT or VAR_OUTPUT; addresses stand in the parameter file beside the diagram.");
  return token(Symbol::Refused, start);
}

Token Lexer::sign() {
  const auto start = at_;
  const auto one = [&](Symbol symbol) {
    ++at_;
    return token(symbol, start);
  };
  const auto two = [&](Symbol symbol) {
    at_ += 2;
    return token(symbol, start);
  };
  const char second = peek(1);
  switch (peek()) {
    case '(':
      return one(Symbol::LeftParenthesis);
    case ')':
      return one(Symbol::RightParenthesis);
    case '[':
      return one(Symbol::LeftBracket);
    case ']':
      return one(Symbol::RightBracket);
    case ',':
      return one(Symbol::Comma);
    case ';':
      return one(Symbol::Semicolon);
    case ':':
      return second == '=' ? two(Symbol::Assign) : one(Symbol::Colon);
    case '.':
      return one(Symbol::Dot);
    case '=':
      return second == '>' ? two(Symbol::Arrow) : one(Symbol::Equal);
    case '+':
      return one(Symbol::Plus);
    case '-':
      return one(Symbol::Minus);
    case '*':
      return second == '*' ? two(Symbol::Power) : one(Symbol::Star);
    case '/':
      return one(Symbol::Slash);
    case '<':
      return second == '=' ? two(Symbol::LessEqual) : (second == '>' ? two(Symbol::NotEqual) : one(Symbol::Less));
    case '>':
      return second == '=' ? two(Symbol::GreaterEqual) : one(Symbol::Greater);
    default:
      return one(Symbol::Ampersand);
  }
}

}  // namespace hysteron::language
