// The formatter: works on the tokens of a text that is known to be right, so that nothing written is lost, and
// numbers, names and parentheses stay as they were.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "codegen/language/layout.hpp"
#include "codegen/language/syntax.hpp"

namespace hysteron::language {
namespace {

enum class Part : std::uint8_t { Head, Opening, Declaration, Closing, Statement, End, FileEnd };

/// One line of the house's layout, with the comments that belong to it: elements [leading, first) stand above it,
/// [first, last) are the line itself, [last, behind) stand at its end. For the head of a block, [behind, below)
/// stand below it, since they speak of the block.
struct Item {
  Part part{};
  std::size_t leading = 0;
  std::size_t first = 0;
  std::size_t last = 0;
  std::size_t behind = 0;
  std::size_t below = 0;
};

class Formatter {
 public:
  Formatter(std::string_view text, const StatementOrders& orders)
      : text_(text), orders_(orders), elements_(elements_of(text)), layout_(text) {
    read_items();
  }

  std::string format() {
    std::size_t i = 0;
    for (std::size_t block = 0; items_[i].part == Part::Head; ++block) {
      i = write_block(i, block);
    }
    write_comments(items_[i].leading, items_[i].first, 0);
    return layout_.take() + "\n";
  }

 private:
  void read_items() {
    bool in_section = false;
    for (std::size_t at = 0; items_.empty() || items_.back().part != Part::FileEnd;) {
      Item item{.leading = at};
      item.first = skip_comments(at);
      item.last = item.first + 1;
      const auto& start = elements_[item.first];
      switch (start.keyword) {
        case Keyword::FunctionBlock:
          item.part = Part::Head;
          item.last = skip_comments(item.last) + 1;
          break;
        case Keyword::EndFunctionBlock:
          item.part = Part::End;
          break;
        case Keyword::EndVar:
          item.part = Part::Closing;
          in_section = false;
          break;
        case Keyword::Var:
        case Keyword::VarInput:
        case Keyword::VarOutput:
          item.part = Part::Opening;
          in_section = true;
          if (const auto next = skip_comments(item.last); elements_[next].keyword == Keyword::Constant) {
            item.last = next + 1;
          }
          break;
        default:
          item.part = start.symbol == Symbol::End ? Part::FileEnd : (in_section ? Part::Declaration : Part::Statement);
          if (item.part != Part::FileEnd) {
            while (elements_[item.last - 1].symbol != Symbol::Semicolon) {
              ++item.last;
            }
          }
      }
      item.behind = item.last;
      while (item.behind < elements_.size() && elements_[item.behind].is_trailing) {
        ++item.behind;
      }
      item.below = item.part == Part::Head ? skip_comments(item.behind) : item.behind;
      at = item.below;
      items_.push_back(item);
    }
  }

  [[nodiscard]] std::size_t skip_comments(std::size_t i) const {
    while (i < elements_.size() && elements_[i].is_comment) {
      ++i;
    }
    return i;
  }

  /// Whether the source has a blank line before an element.
  [[nodiscard]] bool has_blank_line_before(std::size_t i) const {
    const auto begin = i == 0 ? 0 : elements_[i - 1].span.offset + elements_[i - 1].span.length;
    const auto between = text_.substr(begin, elements_[i].span.offset - begin);
    return std::count(between.begin(), between.end(), '\n') > 1;
  }

  void start_line(std::size_t element, std::size_t indent) {
    if (gap_ == Gap::Forced || (gap_ == Gap::AsWritten && has_blank_line_before(element))) {
      layout_.blank_line();
    }
    layout_.new_line(indent);
    gap_ = Gap::AsWritten;
  }

  /// Comments that have lines of their own.
  void write_comments(std::size_t first, std::size_t last, std::size_t indent) {
    for (std::size_t i = first; i < last; ++i) {
      start_line(i, indent);
      layout_.write_comment(elements_[i]);
    }
  }

  /// Comments at the end of a line, from a column on.
  void write_trailing(const Item& item, std::size_t column) {
    for (std::size_t i = item.last; i < item.behind; ++i) {
      constexpr std::size_t distance = 2;
      layout_.write_spaces(i > item.last ? 1 : std::max(distance, column - std::min(column, layout_.column())));
      layout_.write_comment(elements_[i]);
    }
  }

  void write_line(const Item& item, std::size_t indent) {
    start_line(item.first, indent);
    const bool is_call =
        elements_[item.first + 1 < item.last ? item.first + 1 : item.first].symbol == Symbol::LeftParenthesis;
    layout_.write(elements_, item.first, item.last, is_call);
    write_trailing(item, 0);
  }

  std::size_t write_block(std::size_t i, std::size_t block) {
    write_comments(items_[i].leading, items_[i].first, 0);
    write_line(items_[i], 0);
    gap_ = Gap::Forbidden;
    write_comments(items_[i].behind, items_[i].below, 2);
    ++i;
    while (items_[i].part == Part::Opening) {
      i = write_section(i);
    }
    const auto first = i;
    while (items_[i].part == Part::Statement) {
      ++i;
    }
    write_statements(first, order_of(block, i - first));
    write_comments(items_[i].leading, items_[i].first, 2);
    gap_ = Gap::Forbidden;
    write_line(items_[i], 0);
    gap_ = Gap::Forced;
    return i + 1;
  }

  void write_statements(std::size_t first, const std::vector<std::uint32_t>& order) {
    const bool below_head = gap_ == Gap::Forbidden;
    for (std::size_t i = 0; i < order.size(); ++i) {
      const auto& item = items_[first + order[i]];
      if (i == 0) {
        gap_ = below_head ? Gap::Forbidden : Gap::Forced;
      } else if (order[i] == 0) {
        gap_ = Gap::Forbidden;  // what the source has before its first statement is the gap below the declarations
      }
      write_comments(item.leading, item.first, 2);
      write_line(item, 2);
    }
  }

  std::size_t write_section(std::size_t i) {
    write_comments(items_[i].leading, items_[i].first, 2);
    write_line(items_[i], 2);
    gap_ = Gap::Forbidden;
    const auto first = ++i;
    while (items_[i].part == Part::Declaration) {
      ++i;
    }
    const auto columns = columns_of(first, i);
    for (auto at = first; at < i; ++at) {
      write_comments(items_[at].leading, items_[at].first, declaration_indent);
      write_declaration(items_[at], columns);
    }
    write_comments(items_[i].leading, items_[i].first, declaration_indent);
    gap_ = Gap::Forbidden;
    write_line(items_[i], 2);
    return i + 1;
  }

  /// Where the parts of a declaration begin: `names : type := value;`
  struct Declared {
    std::size_t colon = 0;
    std::size_t value = 0;    ///< the sign `:=`, or the semicolon where there is no value
    bool is_aligned = false;  ///< not with a comment inside, nor with names or types that would push all others aside
    std::size_t names_width = 0;
    std::size_t type_width = 0;
    std::size_t value_width = 0;
    [[nodiscard]] bool has_value() const { return value_width > 1; }
  };

  struct Columns {
    std::size_t names = 0;
    std::size_t type = 0;
    std::size_t comment = 0;
  };

  [[nodiscard]] Declared declared(const Item& item) const {
    constexpr std::size_t widest = 40;
    Declared parts{.colon = item.first};
    while (elements_[parts.colon].symbol != Symbol::Colon) {
      ++parts.colon;
    }
    parts.value = parts.colon;
    while (elements_[parts.value].symbol != Symbol::Assign && elements_[parts.value].symbol != Symbol::Semicolon) {
      ++parts.value;
    }
    const auto at = [&](std::size_t i) { return elements_.begin() + static_cast<std::ptrdiff_t>(i); };
    parts.is_aligned = std::none_of(at(item.first), at(item.last), [](const Element& e) { return e.is_comment; });
    if (parts.is_aligned) {
      parts.names_width = Layout::width(elements_, item.first, parts.colon);
      parts.type_width = Layout::width(elements_, parts.colon + 1, parts.value);
      parts.value_width = Layout::width(elements_, parts.value, item.last);
      parts.is_aligned = parts.names_width <= widest && parts.type_width <= widest;
    }
    return parts;
  }

  /// The width of a declaration with its columns aligned.
  [[nodiscard]] static std::size_t width_of(const Declared& parts, const Columns& columns) {
    return declaration_indent + columns.names + 3 +
           (parts.has_value() ? columns.type + 1 + parts.value_width : parts.type_width + 1);
  }

  [[nodiscard]] Columns columns_of(std::size_t first, std::size_t last) const {
    Columns columns;
    for (auto i = first; i < last; ++i) {
      if (const auto parts = declared(items_[i]); parts.is_aligned) {
        columns.names = std::max(columns.names, parts.names_width);
        columns.type = std::max(columns.type, parts.has_value() ? parts.type_width : 0);
      }
    }
    for (auto i = first; i < last; ++i) {
      constexpr std::size_t widest = 80;
      const auto parts = declared(items_[i]);
      const auto width = width_of(parts, columns);
      if (parts.is_aligned && items_[i].behind > items_[i].last && width <= widest) {
        columns.comment = std::max(columns.comment, width + 2);
      }
    }
    return columns;
  }

  void write_declaration(const Item& item, const Columns& columns) {
    start_line(item.first, declaration_indent);
    const auto parts = declared(item);
    if (!parts.is_aligned) {
      layout_.write(elements_, item.first, item.last, true);
      write_trailing(item, 0);
      return;
    }
    layout_.write(elements_, item.first, parts.colon, false);
    layout_.write_spaces(columns.names - parts.names_width + 1);
    layout_.write(elements_, parts.colon, parts.value, false);
    if (parts.has_value()) {
      layout_.write_spaces(columns.type - parts.type_width + 1);
    }
    layout_.write(elements_, parts.value, item.last, true);
    write_trailing(item, columns.comment);
  }

  [[nodiscard]] std::vector<std::uint32_t> order_of(std::size_t block, std::size_t count) const {
    std::vector<std::uint32_t> natural(count);
    std::iota(natural.begin(), natural.end(), 0U);
    if (block >= orders_.size() || orders_[block].empty()) {
      return natural;
    }
    const auto& order = orders_[block];
    std::vector<bool> seen(count);
    for (const auto index : order) {
      if (index >= count || seen[index]) {
        throw std::invalid_argument("the order of the statements names one twice, or one that is not there");
      }
      seen[index] = true;
    }
    if (order.size() != count) {
      throw std::invalid_argument("the order of the statements leaves some out");
    }
    return order;
  }

  static constexpr std::size_t declaration_indent = 4;

  std::string_view text_;
  const StatementOrders& orders_;
  std::vector<Element> elements_;
  std::vector<Item> items_;
  Layout layout_;

  /// What comes before the next line.
  enum class Gap : std::uint8_t { AsWritten, Forbidden, Forced };
  Gap gap_ = Gap::Forbidden;
};

/// The text with the line ends of the source: those of its first line.
std::string with_line_ends_of(std::string_view source, std::string text) {
  const auto end = source.find('\n');
  if (end == std::string_view::npos || end == 0 || source[end - 1] != '\r') {
    return text;
  }
  std::string result;
  result.reserve(text.size() + text.size() / 16);
  for (const char c : text) {
    result += c == '\n' ? "\r\n" : std::string_view(&c, 1);
  }
  return result;
}

}  // namespace

std::string format(const SourceFile& file, const StatementOrders& orders) {
  if (!file.valid || file.bodies) {  // a body has a layout of its own
    return file.text ? *file.text : std::string();
  }
  return with_line_ends_of(*file.text, Formatter(*file.text, orders).format());
}

}  // namespace hysteron::language
