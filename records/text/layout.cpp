#include "records/text/layout.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "records/text/cell_value.hpp"
#include "records/text/channel_head.hpp"
#include "records/time/time_unit.hpp"
#include "support/errors.hpp"
#include "support/names.hpp"

namespace hysteron::records {
namespace {

/// Lines in which the table is looked for. Heads of tools have some hundred at most.
constexpr std::size_t head_lines = 800;

/// In the order of preference between equals: a comma may be a decimal mark, and a blank may be anything.
constexpr std::array separators{';', '\t', '|', ',', ' '};

/// A run of lines of the same shape.
struct Block {
  std::size_t first = 0;  ///< its line in the head
  std::size_t rows = 0;
  std::vector<bool> values{};  ///< by cell: whether the first line has a value there
  [[nodiscard]] std::size_t score() const { return rows * static_cast<std::size_t>(std::ranges::count(values, true)); }
  /// As many cells, and at least half of the values: a cell that is faulty ends no table. A line that begins with a
  /// word ends before those that begin with a number: "Sample Interval,0.001,0.001" is no row.
  [[nodiscard]] bool goes_on_with(const std::vector<bool>& next) const {
    if (rows == 0 || next.size() != values.size() || (next.front() && !values.front())) {
      return false;
    }
    std::size_t kept = 0;
    std::size_t had = 0;
    for (std::size_t c = 0; c < values.size(); ++c) {
      had += values[c] ? 1 : 0;
      kept += values[c] && next[c] ? 1 : 0;
    }
    return 2 * kept >= had && kept > 0;
  }
};

/// Which cells hold a value.
std::vector<bool> values_of(const std::vector<Cell>& cells) {
  std::vector<bool> values;
  values.reserve(cells.size());
  for (const Cell& cell : cells) {
    values.push_back(is_value(cell_value(cell.text).kind));
  }
  return values;
}

Block longest_block(const std::vector<Line>& head, char separator) {
  Block best;
  Block now;
  std::vector<Cell> cells;
  for (std::size_t i = 0; i < head.size(); ++i) {
    if (is_blank(head[i].text, separator) || is_comment(head[i].text, separator)) {
      continue;
    }
    cut_line(head[i].text, separator, cells);
    std::vector<bool> values = values_of(cells);
    if (now.goes_on_with(values)) {
      ++now.rows;
    } else {
      best = now.score() > best.score() ? now : best;
      const bool any = std::ranges::find(values, true) != values.end();
      now = any ? Block{.first = i, .rows = 1, .values = std::move(values)} : Block{};
    }
  }
  return now.score() > best.score() ? now : best;
}

bool begins_with_text(const std::vector<Cell>& cells) {
  const auto first = std::ranges::find_if(cells, [](const Cell& cell) { return !cell.text.empty(); });
  return first != cells.end() && !is_value(cell_value(first->text).kind);
}

/// Whether the nearest line above a block that is neither blank nor a remark has words in as many cells.
bool has_names_above(const std::vector<Line>& head, const Block& block, char separator) {
  std::vector<Cell> cells;
  for (std::size_t i = block.first; block.rows > 0 && block.values.size() > 1 && i > 0;) {
    const std::string_view line = head[--i].text;
    if (!is_blank(line, separator) && !is_comment(line, separator)) {
      cut_line(line, separator, cells);
      return cells.size() == block.values.size() && begins_with_text(cells);
    }
  }
  return false;
}

/// Rows of the same shape above the longest run are rows too: what parts them is reported, not passed over.
void take_earlier_rows(const std::vector<Line>& head, char separator, Block& block) {
  std::vector<Cell> cells;
  for (std::size_t i = 0; i < block.first; ++i) {
    if (is_blank(head[i].text, separator) || is_comment(head[i].text, separator)) {
      continue;
    }
    cut_line(head[i].text, separator, cells);
    const std::vector<bool> values = values_of(cells);
    if (!values.empty() && values.front() == block.values.front() && block.goes_on_with(values)) {
      block.first = i;
      return;
    }
  }
}

std::string_view without_brackets(std::string_view text) {
  const bool bracketed =
      text.size() >= 2 && ((text.front() == '[' && text.back() == ']') || (text.front() == '(' && text.back() == ')'));
  return bracketed ? text.substr(1, text.size() - 2) : text;
}

/// Units as oscilloscopes write them in words.
std::string unit_of_word(std::string_view text) {
  text = without_brackets(text);
  struct Word {
    std::string_view word, unit;
  };
  constexpr auto words = std::to_array<Word>({{"Volt", "V"},
                                              {"Volts", "V"},
                                              {"Ampere", "A"},
                                              {"Amperes", "A"},
                                              {"Amps", "A"},
                                              {"Watt", "W"},
                                              {"Degree", "deg"}});
  const auto found = std::ranges::find_if(words, [&](const Word& one) { return equal_ignoring_case(one.word, text); });
  return std::string(found == words.end() ? text : found->unit);
}

/// Whether a row states units: one cell is a unit of time or all are in brackets, and none is the name of a time.
bool is_row_of_units(const std::vector<Cell>& cells) {
  bool time = false;
  bool bracketed = true;
  for (const Cell& cell : cells) {
    if (cell.text.empty() || cell.text == "-") {
      continue;
    }
    const std::string_view bare = without_brackets(cell.text);
    if (is_value(cell_value(cell.text).kind) || bare.size() > 16) {
      return false;
    }
    time = time || time_unit(bare).has_value();
    bracketed = bracketed && bare.size() != cell.text.size();
  }
  return time || (bracketed && !cells.empty() && !cells.front().text.empty());
}

/// Looks for names above the rows.
class HeadReader {
 public:
  HeadReader(const SourceText& source, const std::vector<Line>& head, const Block& block, TextLayout& layout)
      : source_(source),
        head_(head),
        cells_in_row_(block.values.size()),
        layout_(layout),
        at_(block.first),
        first_row_(block.first) {}

  void read() {
    if (const auto channels = channel_head(head_, first_row_, cells_in_row_, layout_.separator)) {
      for (const std::string& name : channels->names) {
        layout_.columns.push_back({.name = "t", .unit = channels->time_unit});
        layout_.columns.push_back({.name = name});
      }
      return;
    }
    std::vector<Cell> cells;
    if (!step_up(cells)) {
      take_names_of_comment();
      return;
    }
    std::vector<Cell> above;
    const std::size_t lower = at_;
    if (lower > 0 && layout_.separator == ',' &&
        (layout_.counted = counted_time(head_[lower - 1].text, head_[lower].text))) {
      step_up(above);
      take_names(above, at_);
      take_units(cells);
      layout_.columns.front() = {.name = "time", .unit = "s", .cell = 0};
    } else if (fits(cells) && is_row_of_units(cells) && step_up(above) && fits(above) && begins_with_text(above)) {
      take_names(above, at_);
      take_units(cells);
    } else if (fits(cells) && begins_with_text(cells)) {
      at_ = lower;
      take_names(cells, lower);
    } else {
      refuse_rows_of_another_shape(cells, lower);
      take_names_of_comment();
      return;
    }
    take_labels();
  }

 private:
  /// The next line above that is neither blank nor a remark.
  bool step_up(std::vector<Cell>& cells) {
    while (at_ > 0) {
      const Line& line = head_[--at_];
      if (!is_blank(line.text, layout_.separator) && !is_comment(line.text, layout_.separator)) {
        cut_line(line.text, layout_.separator, cells);
        return true;
      }
    }
    return false;
  }

  /// A row may end with a separator, or lack the remark that the head announces.
  [[nodiscard]] bool fits(const std::vector<Cell>& cells) const {
    const std::size_t n = cells.size();
    return n == cells_in_row_ || n + 1 == cells_in_row_ ||
           (n == cells_in_row_ + 1 && is_one_of(cells.back().text, {"", "comment"}));
  }

  /// A row right above the rows that has other cells is no head: to pass over it would lose a sample, or its names.
  void refuse_rows_of_another_shape(const std::vector<Cell>& cells, std::size_t line) const {
    const bool is_row = !begins_with_text(cells);
    const bool is_names = !is_row && cells.size() > 1 && std::ranges::none_of(cells, [](const Cell& cell) {
      return cell.text.empty() || is_value(cell_value(cell.text).kind);
    });
    if (!is_row && !is_names) {
      return;
    }
    const bool decimal_commas = layout_.separator == ',' && 2 * cells.size() == cells_in_row_;
    throw InputError(error::ragged_row, source_.place_of(source_.line_at(layout_.first_row)),
                     fmt::format("The row has {} cells where the line above has {}.", cells_in_row_, cells.size()),
                     decimal_commas ? std::string("write decimal points, or separate the columns by semicolons.")
                     : is_names
                         ? std::string("give every column a name, and a number in every row.")
                         : fmt::format("if the lines above are no part of the record, leave them out: --skip {}.",
                                       source_.place_of(head_[line]).line));
  }

  void take_names(const std::vector<Cell>& cells, std::size_t line) {
    layout_.names = head_[line].offset;
    layout_.columns.assign(cells_in_row_, {});
    for (std::size_t c = 0; c < std::min(cells.size(), cells_in_row_); ++c) {
      HeaderName found = split_header(cells[c].text);
      layout_.columns[c] = {.name = std::move(found.name), .unit = unit_of_word(found.unit), .cell = c};
    }
  }

  void take_units(const std::vector<Cell>& cells) {
    for (std::size_t c = 0; c < std::min(cells.size(), cells_in_row_); ++c) {
      if (layout_.columns[c].unit.empty() && cells[c].text != "-") {
        layout_.columns[c].unit = unit_of_word(cells[c].text);
      }
    }
  }

  /// `# t, u, y` right above the numbers, as NumPy writes it.
  void take_names_of_comment() {
    for (std::size_t line = first_row_; line > 0;) {
      std::string_view text = head_[--line].text;
      if (is_blank(text, layout_.separator)) {
        continue;
      }
      if (!is_comment(text, layout_.separator)) {
        return;
      }
      text.remove_prefix(std::min(text.find_first_not_of(" \t#%/;"), text.size()));
      std::vector<Cell> cells;
      cut_line(text, layout_.separator, cells);
      if (cells.size() != cells_in_row_) {
        cut_line(text, text.find(',') != std::string_view::npos ? ',' : ' ', cells);
      }
      if (cells.size() == cells_in_row_ && begins_with_text(cells)) {
        take_names(cells, line);
        layout_.notes.push_back("the names stand in a remark above the numbers");
      }
      return;
    }
  }

  /// What the head says of the columns elsewhere: names that the user gave to channels, and units.
  void take_labels() {
    std::vector<Cell> cells;
    while (step_up(cells)) {
      if (cells.size() < cells_in_row_ || begins_with_text(cells) == false) {
        continue;
      }
      const bool labels = is_one_of(cells.front().text, {"label", "labels", "channel name", "channel names"});
      const bool units = is_one_of(cells.front().text, {"vertical units", "units", "unit", "y_unit_label", "einheit"});
      for (std::size_t c = 1; (labels || units) && c < cells_in_row_; ++c) {
        TextLayout::Name& column = layout_.columns[c];
        if (labels && !cells[c].text.empty()) {
          layout_.notes.push_back(fmt::format("column {} is called {}, by its label", column.name, cells[c].text));
          column.name = cells[c].text;
        } else if (units && column.unit.empty()) {
          column.unit = unit_of_word(cells[c].text);
        }
      }
    }
  }

  const SourceText& source_;
  const std::vector<Line>& head_;
  std::size_t cells_in_row_;
  TextLayout& layout_;
  std::size_t at_;
  std::size_t first_row_;
};

/// u:1.0,y:3.0: each row says the names.
void take_names_of_cells(const std::vector<Cell>& cells, TextLayout& layout) {
  std::vector<TextLayout::Name> names;
  for (const Cell& cell : cells) {
    names.push_back({.name = std::string(cell_value(cell.text).label)});
  }
  if (std::ranges::any_of(names, [](const TextLayout::Name& one) { return !one.name.empty(); })) {
    layout.columns = std::move(names);
  }
}

}  // namespace

bool is_comment(std::string_view line, char separator) {
  const auto first = line.find_first_not_of(" \t");
  if (first == std::string_view::npos) {
    return false;
  }
  const std::string_view text = line.substr(first);
  return text.front() == '#' || text.front() == '%' || text.starts_with("//") ||
         (text.front() == ';' && separator != ';');
}

TextLayout layout_of(const SourceText& source, std::size_t skip) {
  std::vector<Line> head;
  std::optional<char> stated;
  for (std::size_t at = 0; at < source.text.size() && head.size() < head_lines;) {
    Line line = source.line_at(at);
    at = line.next;
    if (skip > 0) {
      --skip;
      continue;
    }
    if (head.empty() && line.text.size() <= 5 && equal_ignoring_case(line.text.substr(0, 4), "sep=")) {
      stated = line.text.size() == 5 ? line.text.back() : '\t';
      continue;
    }
    head.push_back(line);
  }
  TextLayout layout;
  Block best;
  std::size_t most = 0;
  for (const char separator : separators) {
    if (stated && separator != *stated) {
      continue;
    }
    Block found = longest_block(head, separator);
    // Names of as many cells are worth as much as the rows: `0,1` below `t,u` is no decimal comma.
    const std::size_t score = found.score() * (has_names_above(head, found, separator) ? 2 : 1);
    if (score > most) {
      most = score;
      best = std::move(found);
      layout.separator = separator;
    }
  }
  if (best.rows == 0) {
    throw InputError(error::record_too_short, {.file = source.file}, "The file holds no row of numbers.",
                     "write a row of names, such as t,u,y, and one row of numbers for each sample.");
  }
  take_earlier_rows(head, layout.separator, best);
  layout.first_row = head[best.first].offset;
  layout.cells = best.values.size();
  HeadReader(source, head, best, layout).read();
  if (layout.columns.empty()) {
    std::vector<Cell> cells;
    cut_line(head[best.first].text, layout.separator, cells);
    take_names_of_cells(cells, layout);
  }
  return layout;
}

}  // namespace hysteron::records
