// Layout: tokens and comments of one item written out with the house's spacing, wrapped at the width of a line.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "codegen/language/lexer.hpp"
#include "codegen/language/token.hpp"

namespace hysteron::language {

inline constexpr std::size_t line_width = 120;

/// A token or a comment of the source.
struct Element {
  Span span{};
  Symbol symbol = Symbol::End;
  Keyword keyword = Keyword::None;
  bool is_comment = false;
  bool is_trailing = false;   ///< a comment on the line of the token before it
  bool is_type = false;       ///< the name of an elementary type
  bool is_unary = false;      ///< a sign before a value
  bool is_bit = false;        ///< of a WORD: the .3 of W.3, X[0].3 and I.PIN.3
  bool breaks_after = false;  ///< a line may end behind it
};

/// All elements of a text without syntax errors; the last is Symbol::End.
std::vector<Element> elements_of(std::string_view text);

/// Writes elements into a text and knows its column.
class Layout {
 public:
  explicit Layout(std::string_view source) : source_(source) {}

  /// Elements [first, last) from the present column on. A line that is too long is broken between the arguments of
  /// the outermost parentheses, which then stand below each other, if it `has_arguments`; else, and inside of an
  /// argument, behind signs and commas.
  void write(const std::vector<Element>& elements, std::size_t first, std::size_t last, bool has_arguments);

  void write_comment(const Element& comment);
  void write_spaces(std::size_t count) { append(std::string(count, ' ')); }
  void new_line(std::size_t indent);
  void blank_line();

  /// The width of [first, last) on one line, where there is no comment in it.
  [[nodiscard]] static std::size_t width(const std::vector<Element>& elements, std::size_t first, std::size_t last);
  [[nodiscard]] std::size_t column() const { return column_; }
  [[nodiscard]] std::string take() { return std::move(out_); }

 private:
  void append(std::string_view text);
  void write_element(const std::vector<Element>& elements, std::size_t first, std::size_t i);
  [[nodiscard]] std::string text_of(const Element& element) const;
  [[nodiscard]] bool fits(const std::vector<Element>& elements, std::size_t from, std::size_t end) const;

  std::string_view source_;
  std::string out_;
  std::size_t column_ = 0;
};

/// Whether a space stands between two neighbours.
bool is_spaced(const Element& before, const Element& element);

}  // namespace hysteron::language
