#include "records/text/layout.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <span>
#include <string_view>
#include <utility>

#include "records/text/cell_value.hpp"
#include "records/text/channel_head.hpp"
#include "records/text/keyed_head.hpp"
#include "records/text/names_above.hpp"
#include "records/text/row_block.hpp"
#include "records/text/scale_row.hpp"
#include "records/text/unit_text.hpp"
#include "records/time/time_unit.hpp"
#include "support/errors.hpp"
#include "support/names.hpp"
#include "support/trimmed.hpp"

namespace hysteron::records {
namespace {

/// Lines in which the table is looked for. Heads of tools have some hundred at most.
constexpr std::size_t head_lines = 800;

/// In the order of preference between equals: a comma may be a decimal mark, and a blank may be anything.
constexpr std::array separators{';', '\t', '|', ',', ' '};

/// The line below the names of a table for people: |---|---|, ---+---.
bool is_rule(std::string_view line) {
  return line.find("---") != std::string_view::npos && line.find_first_not_of("-|+=: \t\r") == std::string_view::npos;
}

/// `XOrg:,0.0` and `YUnits:,Volt`: one of two cells, of which the first ends with a colon, is no name of a column; nor
/// is one of `Range=`.
bool is_setting(const std::vector<Cell>& cells) {
  return cells.front().text.ends_with('=') || (cells.size() <= 2 && cells.front().text.ends_with(':'));
}

/// `f8,f4,f4` and `REAL;LREAL;BOOL` below the names.
bool states_types(const std::vector<Cell>& cells) {
  return cells.size() > 1 && std::ranges::all_of(cells, [](const Cell& cell) { return is_number_type(cell.text); });
}

/// Without what cannot be seen in it: the line ends of a name over several lines, blanks of other widths, and the
/// quotes of TIA Portal, "DB".u.
std::string plain_name(std::string_view cell) {
  std::string text(cell);
  std::ranges::replace(text, '\v', ' ');
  for (const std::string_view unseen : {"\xC2\xA0", "\xE2\x80\x8B", "\xEF\xBB\xBF"}) {
    for (std::size_t at = 0; (at = text.find(unseen, at)) != std::string::npos;) {
      text.replace(at, unseen.size(), unseen.size() == 2 ? " " : "");
    }
  }
  if (std::ranges::count(text, '"') % 2 == 0) {
    std::erase(text, '"');
  }
  return std::string(trimmed(text));
}

/// Looks for names above the rows.
class HeadReader {
 public:
  HeadReader(const SourceText& source, const std::vector<Line>& head, const RowBlock& block, TextLayout& layout)
      : source_(source),
        head_(head),
        values_(block.values),
        cells_in_row_(block.values.size()),
        layout_(layout),
        first_row_(block.first) {}

  void read() {
    layout_.stated = stated_rate(head_, first_row_);
    if (const auto channels = channel_head(head_, first_row_, cells_in_row_, layout_.separator)) {
      for (const ChannelHead::Channel& channel : channels->channels) {
        layout_.columns.push_back({.name = "t", .unit = channels->time_unit, .is_time = true});
        layout_.columns.push_back({.name = channel.name, .unit = channel.unit});
      }
      layout_.notes.insert(layout_.notes.end(), channels->notes.begin(), channels->notes.end());
      return;
    }
    if (auto keyed = keyed_head(head_, first_row_, values_, layout_.separator)) {
      layout_.columns = std::move(keyed->columns);
      layout_.cells = layout_.columns.size();
      layout_.notes.insert(layout_.notes.end(), keyed->notes.begin(), keyed->notes.end());
      layout_.may_end_with_remark = true;  // of LabChart
      return;
    }
    take_row_with_remark();
    std::vector<HeadLine> above = lines_above(head_, first_row_, layout_.separator);
    if (above.size() > 1) {
      std::erase_if(above, [](const HeadLine& one) { return states_types(one.cells); });
    }
    const std::vector<HeadLine> scales = take_scales(above);
    pass_over_marks(above);
    if (above.empty()) {
      refuse_transposed();
      take_names_of_comment();
      return;
    }
    if (above.size() > 1 && layout_.separator == ',' &&
        (layout_.counted = counted_time(head_[above[1].line].text, head_[above[0].line].text))) {
      take_names(above[1].cells, above[1].line);
      take_units(above[0].cells);
      layout_.columns.front() = {.name = "time", .unit = "s", .cell = 0};
      take_labels(above[1].line);
      return;
    }
    const auto words = static_cast<std::size_t>(std::ranges::find_if_not(above,
                                                                         [&](const HeadLine& one) {
                                                                           return fits(one.cells) &&
                                                                                  begins_with_text(one.cells) &&
                                                                                  !is_setting(one.cells);
                                                                         }) -
                                                above.begin());
    if (words == 0) {
      refuse_transposed();
      refuse_rows_of_another_shape(above.front().cells, above.front().line);
      take_names_of_comment();
      return;
    }
    const std::size_t names = row_of_names(std::span(above).first(words));
    take_names(above[names].cells, above[names].line);
    for (std::size_t i = names; i-- > 0;) {
      if (states_units(above[i].cells)) {
        take_units(above[i].cells);
      } else if (is_name_of_index(above[i].cells)) {
        layout_.columns.front().name = std::string(above[i].cells.front().text);
      }
    }
    take_labels(above[names].line);
    for (const HeadLine& one : scales) {
      if (one.line > above[names].line) {  // those above the names are among the labels
        tell_scales(one.cells);
      }
    }
  }

 private:
  /// A row may end with a separator, lack the remark that the head announces, or begin with its number (R).
  [[nodiscard]] bool fits(const std::vector<Cell>& cells) const {
    const std::size_t n = cells.size();
    return n == cells_in_row_ || n + 1 == cells_in_row_ ||
           (n == cells_in_row_ + 1 && is_one_of(cells.back().text, {"", "comment"}));
  }

  /// Takes rows of factors out of the head: `Scale;1;0.001` holds no names.
  [[nodiscard]] static std::vector<HeadLine> take_scales(std::vector<HeadLine>& above) {
    std::vector<HeadLine> scales;
    std::erase_if(above, [&](const HeadLine& one) {
      const bool found =
          is_key_of_scale(one.cells.front().text) &&
          std::ranges::any_of(one.cells, [](const Cell& cell) { return is_value(cell_value(cell.text).kind); });
      if (found) {
        scales.push_back(one);
      }
      return found;
    });
    return scales;
  }

  /// Factors by column, which are left aside.
  void tell_scales(const std::vector<Cell>& cells) {
    for (std::size_t c = 1; c < std::min(cells.size(), cells_in_row_); ++c) {
      if (auto note = note_of_scale(cells.front().text, cells[c].text, layout_.columns[c].name)) {
        layout_.notes.push_back(std::move(*note));
      }
    }
  }

  /// Marks of sections, [data] say, stand between the names and the rows; so does the name of a
  /// run of LTspice. A line of names between other separators than the rows have is cut at its own.
  void pass_over_marks(std::vector<HeadLine>& above) const {
    const auto is_names = [&](const std::vector<Cell>& cells) {
      return cells.size() == cells_in_row_ && begins_with_text(cells) && !is_setting(cells);
    };
    const auto names = std::ranges::find_if(above, [&](const HeadLine& one) { return is_names(one.cells); });
    const bool marks_alone = std::all_of(
        above.begin(), names, [](const HeadLine& one) { return one.cells.size() == 1 && begins_with_text(one.cells); });
    if (names != above.end() && names != above.begin() && marks_alone) {
      above.erase(above.begin(), names);
    } else if (!above.empty() && above.front().cells.size() == 1 && cells_in_row_ > 1) {
      std::vector<Cell> cells;
      for (const char other : {',', ';', '\t'}) {
        cut_line(head_[above.front().line].text, other, cells);
        if (other != layout_.separator && is_names(cells)) {
          above.front().cells = cells;
        }
      }
    }
  }

  /// LabVIEW puts a remark behind some rows: `0.000 0.1 0.3 begin` below a head that ends with Comment.
  void take_row_with_remark() {
    const std::vector<HeadLine> above = lines_above(head_, first_row_, layout_.separator);
    const auto has_remark = [&](const std::vector<Cell>& cells) {
      return cells.size() == cells_in_row_ + 1 && is_one_of(cells.back().text, {"comment"});
    };
    const bool is_row = !above.empty() && !begins_with_text(above.front().cells);
    const bool announced = above.size() > (is_row ? 1U : 0U) && has_remark(above[is_row ? 1 : 0].cells);
    layout_.may_end_with_remark = announced;
    if (announced && is_row && above.front().cells.size() == cells_in_row_ + 1) {
      first_row_ = above.front().line;
      layout_.first_row = head_[first_row_].offset;
    }
  }

  /// A row right above the rows that has other cells is no head: to pass over it would lose a sample, or its names.
  void refuse_rows_of_another_shape(const std::vector<Cell>& cells, std::size_t line) const {
    const bool is_row = !begins_with_text(cells);
    const bool is_names =
        !is_row && cells.size() > 1 && !is_setting(cells) && std::ranges::none_of(cells, [](const Cell& cell) {
          return cell.text.empty() || is_value(cell_value(cell.text).kind);
        });
    if (!is_row && !is_names) {
      return;
    }
    const bool decimal_commas = layout_.separator == ',' && 2 * cells.size() == cells_in_row_;
    const std::string_view text = head_[line].text;
    throw InputError(
        error::ragged_row, source_.place_of(source_.line_at(layout_.first_row)),
        cells.size() == cells_in_row_
            ? fmt::format("\"{}\" stands above the rows: it holds no names, and is no row like them.",
                          trimmed(text).substr(0, 40))
            : fmt::format("The row has {} cells where the line above has {}.", cells_in_row_, cells.size()),
        decimal_commas ? std::string("write decimal points, or separate the columns by semicolons.")
        : is_names     ? std::string("give every column a name, and a number in every row.")
                       : fmt::format("if the lines above are no part of the record, leave them out: --skip {}.",
                                     source_.place_of(head_[line]).line));
  }

  /// `t,0,0.001,0.002` above `u,1,2,3`: the signals lie on their side.
  void refuse_transposed() const {
    constexpr std::size_t fewest_samples = 8;
    std::vector<Cell> cells;
    std::size_t rows = 0;
    for (std::size_t i = first_row_; i < head_.size() && rows <= cells_in_row_; ++i) {
      if (is_blank(head_[i].text, layout_.separator) || is_comment(head_[i].text, layout_.separator)) {
        continue;
      }
      cut_line(head_[i].text, layout_.separator, cells);
      ++rows;
      if (cells.size() != cells_in_row_ || !begins_with_text(cells) || !is_value(cell_value(cells.back().text).kind)) {
        return;
      }
    }
    if (rows == 0 || cells_in_row_ <= fewest_samples || 4 * rows > cells_in_row_) {
      return;
    }
    cut_line(head_[first_row_].text, layout_.separator, cells);
    throw InputError(error::missing_header, source_.place_of(head_[first_row_]),
                     fmt::format("Each row of the file is a signal: the first is {}, with {} numbers beside it.",
                                 cells.front().text, cells_in_row_ - 1),
                     "turn rows into columns: in Python, pandas.read_csv(\"log.csv\", header=None, index_col=0).T."
                     "to_csv(\"turned.csv\", index=False).");
  }

  void take_names(const std::vector<Cell>& cells, std::size_t line) {
    layout_.names = head_[line].offset;
    layout_.columns.assign(cells_in_row_, {});
    const std::size_t shift =
        cells.size() + 1 == cells_in_row_ && !ends_empty() ? shift_by_number(line, cells.size()) : 0;
    for (std::size_t c = 0; c < std::min(cells.size(), cells_in_row_); ++c) {
      HeaderName found = split_header(plain_name(cells[c].text));
      found.unit = is_number_type(found.unit) ? std::string() : std::move(found.unit);  // u(REAL) of Omron
      layout_.columns[c + shift] = {.name = std::move(found.name), .unit = unit_of_word(found.unit), .cell = c};
    }
  }

  /// Whether the first row ends with a separator.
  [[nodiscard]] bool ends_empty() const {
    std::vector<Cell> cells;
    cut_line(head_[first_row_].text, layout_.separator, cells);
    return cells.back().text.empty();
  }

  /// R writes the number of each row before it, and no name for it. A row that begins otherwise lacks a name.
  [[nodiscard]] std::size_t shift_by_number(std::size_t line, std::size_t names) {
    std::vector<Cell> cells;
    double before = 0.0;
    for (std::size_t i = first_row_; i < std::min(first_row_ + 3, head_.size()); ++i) {
      cut_line(head_[i].text, layout_.separator, cells);
      const CellValue number = cells.empty() ? CellValue{} : cell_value(cells.front().text);
      const bool counts = number.kind == CellKind::Number && (i == first_row_ || number.number == before + 1.0);
      if (!counts) {
        throw InputError(error::ragged_row, source_.place_of(head_[first_row_]),
                         fmt::format("The row has {} cells where the {} names in line {} are for one less.",
                                     cells_in_row_, names, source_.place_of(head_[line]).line),
                         "give every column a name, and a number in every row.");
      }
      before = number.number;
    }
    layout_.notes.emplace_back("each row begins with its number, which has no name");
    return 1;
  }

  void take_units(const std::vector<Cell>& cells) {
    for (std::size_t c = 0; c < std::min(cells.size(), cells_in_row_); ++c) {
      if (layout_.columns[c].unit.empty() && cells[c].text != "-" && !(c == 0 && is_key_of_units(cells[c].text))) {
        layout_.columns[c].unit = unit_of_word(without_unit_key(cells[c].text));
      }
    }
  }

  /// `# t, u, y` right above the numbers, as NumPy writes it.
  void take_names_of_comment() {
    for (std::size_t line = first_row_; line > 0;) {
      std::string_view text = head_[--line].text;
      if (is_blank(text, layout_.separator) || is_rule(text)) {
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
        layout_.notes.emplace_back("the names stand in a remark above the numbers");
      }
      return;
    }
  }

  /// `s,mV,um` above the names: units in all cells, that of the time or one that no name has.
  [[nodiscard]] bool are_units(const std::vector<Cell>& cells) const {
    bool sure = false;
    for (std::size_t c = 0; c < cells.size(); ++c) {
      const std::string unit = unit_of_word(cells[c].text);
      if (unit.empty() || unit == "-" || (c == 0 && is_key_of_units(unit))) {
        continue;
      }
      const bool of_time = time_name(layout_.columns[c].name) && time_unit(unit);
      if (!of_time && !is_known_unit(unit)) {
        return false;
      }
      sure = sure || of_time || unit.size() > 1;
    }
    return sure;
  }

  /// What the head says of the columns elsewhere: names that the user gave to channels, and units, in the order of the
  /// columns; where each channel has times of its own, in the order of the channels.
  void take_labels(std::size_t line) {
    std::vector<std::size_t> channels;
    for (std::size_t c = 1; c < cells_in_row_; ++c) {
      if (!time_name(layout_.columns[c].name)) {
        channels.push_back(c);
      }
    }
    const auto times = std::ranges::count_if(
        layout_.columns, [](const TextLayout::Name& one) { return time_name(one.name).has_value(); });
    const bool own_times = channels.size() + 1 < cells_in_row_ && times > 1;
    std::vector<Cell> cells;
    while (line > 0) {
      const std::string_view text = head_[--line].text;
      take_unit_of_all(text, channels);
      if (is_blank(text, layout_.separator) || is_comment(text, layout_.separator)) {
        continue;
      }
      cut_line(text, layout_.separator, cells);
      const bool labels = is_one_of(cells.front().text,
                                    {"label", "labels", "channel name", "channel names", "tracename", "trace name"});
      const bool all = cells.size() == cells_in_row_ && are_units(cells);
      const bool keyed = is_key_of_units(cells.front().text);
      const bool units = is_one_of(cells.front().text, {"vertical units", "y_unit_label", "vunit"}) || keyed || all;
      if ((all || (keyed && cells.size() == cells_in_row_)) &&
          !own_times) {  // one for each column, the time among them
        take_units(cells);
        continue;
      }
      for (std::size_t k = 0; (labels || units) && k < channels.size(); ++k) {
        TextLayout::Name& column = layout_.columns[channels[k]];
        const std::size_t cell = own_times ? k + 1 : channels[k];
        const std::string_view said = cell < cells.size() ? cells[cell].text : std::string_view();
        if (labels && !said.empty()) {
          layout_.notes.push_back(fmt::format("column {} is called {}, by its label", column.name, said));
          column.name = said;
        } else if (units && column.unit.empty()) {
          column.unit = unit_of_word(said);
        }
      }
      if (cells.size() == cells_in_row_ && !own_times) {
        tell_scales(cells);
      }
    }
  }

  /// `Units:(mV),` of OWON and `#UNITS:mV` of Hantek: one unit for all channels that have none.
  void take_unit_of_all(std::string_view line, const std::vector<std::size_t>& channels) {
    const std::string_view text = trimmed(line, " \t#%/\";,|");
    const std::string unit = unit_of_word(without_unit_key(text));
    if (without_unit_key(text).size() == text.size() || !is_known_unit(unit)) {
      return;
    }
    bool any = false;
    for (const std::size_t c : channels) {
      any = any || layout_.columns[c].unit.empty();
      layout_.columns[c].unit = layout_.columns[c].unit.empty() ? unit : layout_.columns[c].unit;
    }
    if (any) {
      layout_.notes.push_back(fmt::format("the unit of the channels is {}, by \"{}\" above the rows", unit, text));
    }
  }

  const SourceText& source_;
  const std::vector<Line>& head_;
  const std::vector<bool>& values_;  ///< which cells of a row hold numbers
  std::size_t cells_in_row_;
  TextLayout& layout_;
  std::size_t first_row_;
};

/// u:1.0,y:3.0: each row says the names.
void take_names_of_cells(const std::vector<Cell>& cells, TextLayout& layout) {
  std::vector<TextLayout::Name> names;
  names.reserve(cells.size());
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
         (text.front() == ';' && separator != ';') || is_rule(text);
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
  RowBlock best;
  std::size_t most = 0;
  for (const char separator : separators) {
    if (stated && separator != *stated) {
      continue;
    }
    RowBlock found = longest_block(head, separator);
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
