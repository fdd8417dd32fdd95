#include "codegen/language/layout.hpp"

#include <algorithm>

#include "codegen/language/syntax.hpp"
#include "support/byte_order_mark.hpp"
#include "support/utf8.hpp"

namespace hysteron::language {
namespace {

/// Signs that stand between two values, or before one.
bool is_operator(const Element& e) {
  switch (e.symbol) {
    case Symbol::Plus:
    case Symbol::Minus:
    case Symbol::Star:
    case Symbol::Slash:
    case Symbol::Power:
    case Symbol::Less:
    case Symbol::LessEqual:
    case Symbol::Greater:
    case Symbol::GreaterEqual:
    case Symbol::Equal:
    case Symbol::NotEqual:
    case Symbol::Ampersand:
      return true;
    default:
      return e.keyword == Keyword::And || e.keyword == Keyword::Or || e.keyword == Keyword::Xor ||
             e.keyword == Keyword::Mod || e.keyword == Keyword::Not;
  }
}

bool is_opening(const Element& e) {
  return e.symbol == Symbol::LeftParenthesis || e.symbol == Symbol::LeftBracket;
}
bool is_closing(const Element& e) {
  return e.symbol == Symbol::RightParenthesis || e.symbol == Symbol::RightBracket;
}

std::string_view without_end_blanks(std::string_view line) {
  const auto last = line.find_last_not_of(" \t\r\f\v");
  return line.substr(0, last == std::string_view::npos ? 0 : last + 1);
}

}  // namespace

std::vector<Element> elements_of(std::string_view text) {
  std::vector<Element> elements;
  Lexer lexer(text, Comments::All, nullptr);
  std::size_t comments = 0;
  Element before{.symbol = Symbol::Semicolon};
  for (bool more = true; more;) {
    const Token token = lexer.next();
    for (; comments < lexer.comments().size(); ++comments) {
      const auto& comment = lexer.comments()[comments];
      elements.push_back({.span = comment.span, .is_comment = true, .is_trailing = comment.trailing});
    }
    Element element{.span = {token.offset, token.length}, .symbol = token.symbol, .keyword = token.keyword};
    const bool value_before = !is_operator(before) && !is_opening(before) && before.symbol != Symbol::Assign &&
                              before.symbol != Symbol::Comma;
    element.is_unary = element.keyword == Keyword::Not || (is_operator(element) && !value_before);
    const bool behind_of =
        before.keyword == Keyword::Control && same_name(text.substr(before.span.offset, before.span.length), "OF");
    element.is_type = (before.symbol == Symbol::Colon || behind_of) && element.symbol == Symbol::Identifier &&
                      is_elementary_type(text.substr(token.offset, token.length));
    element.is_bit = element.symbol == Symbol::Number && text[token.offset] == '.' &&
                     (before.symbol == Symbol::Identifier || before.symbol == Symbol::RightBracket) &&
                     before.span.offset + before.span.length == token.offset;
    element.breaks_after = element.symbol == Symbol::Comma || (is_operator(element) && !element.is_unary);
    elements.push_back(element);
    before = element;
    more = token.symbol != Symbol::End;
  }
  return elements;
}

bool is_spaced(const Element& before, const Element& element) {
  if (is_opening(before) || element.is_bit) {
    return false;
  }
  if (!element.is_comment) {
    if (is_closing(element) || element.symbol == Symbol::Comma || element.symbol == Symbol::Semicolon ||
        element.symbol == Symbol::Dot) {
      return false;
    }
    if (!before.is_comment) {
      if (before.symbol == Symbol::Dot || (before.is_unary && before.keyword != Keyword::Not)) {
        return false;
      }
      if (element.symbol == Symbol::LeftBracket) {  // an index, the bounds of a vector; else a list of values
        return before.symbol != Symbol::Identifier && before.keyword != Keyword::Derived;
      }
      return element.symbol != Symbol::LeftParenthesis || before.symbol != Symbol::Identifier;
    }
  }
  return true;
}

std::string Layout::text_of(const Element& element) const {
  const auto text = source_.substr(element.span.offset, element.span.length);
  return element.keyword != Keyword::None || element.is_type ? upper(text) : std::string(text);
}

void Layout::append(std::string_view text) {
  out_ += text;
  const auto line = text.rfind('\n');
  column_ = line == std::string_view::npos ? column_ + character_count(text) : character_count(text.substr(line + 1));
}

void Layout::new_line(std::size_t indent) {
  if (!out_.empty()) {
    out_ += '\n';
  }
  out_.append(indent, ' ');
  column_ = indent;
}

void Layout::blank_line() {
  if (!out_.empty()) {
    out_ += '\n';
    column_ = 0;
  }
}

/// The lines of a long comment keep their place below its beginning; those that stood left of it go below its text.
void Layout::write_comment(const Element& comment) {
  const auto text = source_.substr(comment.span.offset, comment.span.length);
  auto end = text.find('\n');
  if (end == std::string_view::npos) {
    append(text);
    return;
  }
  const auto line_break = source_.substr(0, comment.span.offset).rfind('\n');
  auto start = line_break == std::string_view::npos ? 0 : line_break + 1;
  if (start == 0 && source_.starts_with(byte_order_mark)) {
    start = byte_order_mark.size();
  }
  const auto old_column = character_count(source_.substr(start, comment.span.offset - start));
  const auto new_column = column_;
  append(without_end_blanks(text.substr(0, end)));
  while (end != std::string_view::npos) {
    const auto next = text.find('\n', end + 1);
    auto line = text.substr(end + 1, next == std::string_view::npos ? next : next - end - 1);
    line = next == std::string_view::npos ? line : without_end_blanks(line);
    const auto blanks = std::min(line.find_first_not_of(' '), line.size());
    append("\n");
    if (!line.empty() && line[blanks] != '\t') {
      constexpr std::size_t text_indent = 3;  // below the text of `(* text`
      line.remove_prefix(blanks);
      append(std::string(new_column + (blanks >= old_column ? blanks - old_column : text_indent), ' '));
    }
    append(line);
    end = next;
  }
}

void Layout::write_element(const std::vector<Element>& elements, std::size_t first, std::size_t i) {
  if (i > first && is_spaced(elements[i - 1], elements[i]) && !out_.ends_with(' ')) {
    append(" ");
  }
  if (elements[i].is_comment) {
    write_comment(elements[i]);
  } else {
    append(text_of(elements[i]));
  }
}

/// Whether [from, end) has room on this line, up to the end of a line inside of a comment.
bool Layout::fits(const std::vector<Element>& elements, std::size_t from, std::size_t end) const {
  std::size_t column = column_;
  for (std::size_t i = from; i < end && column <= line_width; ++i) {
    column += is_spaced(elements[i - 1], elements[i]) ? 1 : 0;
    const auto text = source_.substr(elements[i].span.offset, elements[i].span.length);
    const auto line_end = text.find('\n');
    if (line_end != std::string_view::npos) {
      column += character_count(without_end_blanks(text.substr(0, line_end)));
      break;
    }
    column += character_count(text);
  }
  return column <= line_width;
}

std::size_t Layout::width(const std::vector<Element>& elements, std::size_t first, std::size_t last) {
  std::size_t width = 0;
  for (std::size_t i = first; i < last; ++i) {
    width += elements[i].span.length + (i > first && is_spaced(elements[i - 1], elements[i]) ? 1U : 0U);
  }
  return width;
}

void Layout::write(const std::vector<Element>& elements, std::size_t first, std::size_t last, bool has_arguments) {
  constexpr std::size_t deepest_column = 60;
  constexpr std::size_t step = 4;
  auto argument_column = column_ + step;
  std::size_t depth = 0;
  bool is_broken_inside = false;  // the argument at hand
  const auto enter = [&](const Element& element) {
    depth += is_opening(element) ? 1 : 0;
    depth -= is_closing(element) && depth > 0 ? 1 : 0;
  };
  const auto ends_argument = [&](const Element& element) {
    return has_arguments && depth == 1 && element.symbol == Symbol::Comma;
  };
  for (std::size_t i = first; i < last; ++i) {
    const bool behind_argument = i > first && ends_argument(elements[i - 1]);
    if (i > first && elements[i - 1].breaks_after) {
      // What would best stay on one line: the whole argument, else up to the next sign or comma.
      const auto outside = depth;
      auto end = i;
      while (end < last && !(behind_argument ? ends_argument(elements[end]) : elements[end].breaks_after)) {
        enter(elements[end++]);
      }
      depth = outside;
      const bool breaks = (behind_argument && is_broken_inside) || !fits(elements, i, std::min(end + 1, last));
      is_broken_inside = !behind_argument && (breaks || is_broken_inside);
      if (breaks) {
        new_line(argument_column + (has_arguments && !behind_argument ? step : 0));
      }
    }
    write_element(elements, first, i);
    enter(elements[i]);
    if (has_arguments && depth == 1 && is_opening(elements[i]) && column_ <= deepest_column) {
      argument_column = column_;
    }
  }
}

}  // namespace hysteron::language
