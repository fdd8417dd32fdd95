#include "records/text/text_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string_view>
#include <utility>

#include "records/text/bracketed_rows.hpp"
#include "records/text/cell_mend.hpp"
#include "records/text/decimal_marks.hpp"
#include "records/text/encoding.hpp"
#include "records/text/layout.hpp"
#include "records/text/log_line.hpp"
#include "records/text/long_table.hpp"
#include "records/text/unit_column.hpp"
#include "records/time/time_unit.hpp"
#include "support/counted.hpp"
#include "support/errors.hpp"
#include "support/names.hpp"
#include "support/numbers.hpp"

namespace hysteron::records {
namespace {

/// More errors than these are not shown: a file of the wrong kind has one in every row.
constexpr std::size_t most_errors = 10;

class Reader {
 public:
  Reader(const std::string& file, std::string bytes, const ReadOptions& options) : options_(options) {
    DecodedText text = decoded(file, std::move(bytes));
    if (!text.encoding.empty()) {
      table_.notes.push_back("the text is " + text.encoding);
    }
    if (text.empty_bytes > 0) {
      table_.notes.push_back(
          fmt::format("the last {} of the file were laid out and not written", counted(text.empty_bytes, "byte")));
    }
    if (clear_brackets(text.text)) {
      table_.notes.emplace_back("each row stands in brackets");
    }
    source_ = std::make_shared<SourceText>(SourceText{.file = file, .text = std::move(text.text)});
    if (auto log = table_of_log(source_->text, options.skip)) {
      source_->text = std::move(log->text);
      layout_ = std::move(log->layout);
    } else {
      layout_ = layout_of(*source_, options.skip);
    }
    marks_ = DecimalMarks(*source_, diagnostics_, layout_.cells);
    source_->separator = layout_.separator;
    names_ = layout_.names ? source_->line_at(*layout_.names).text : std::string_view();
    table_.notes.insert(table_.notes.end(), layout_.notes.begin(), layout_.notes.end());
  }

  Table read() {
    name_columns();
    read_rows();
    stop_on_errors();
    if (!options_.decimal) {
      marks_.doubt_points(table_, layout_.separator);
    }
    count_time();
    table_.rows = source_->rows.size();
    if (table_.rows < 2) {
      throw InputError(
          error::record_too_short, table_.place,
          fmt::format("The record has {}; the sample time needs two.", table_.rows == 0 ? "no rows" : "one row"),
          "record at least two rows.");
    }
    for (std::size_t i = 0; i < table_.columns.size(); ++i) {
      table_.columns[i].has_values = seen_[i];
      tell_words(i);
    }
    take_units_beside(table_);
    table_.stated = layout_.stated;
    table_.source = std::move(source_);
    return widened(std::move(table_));
  }

 private:
  void stop_on_errors() const {
    if (diagnostics_.has_errors()) {
      throw InputError(diagnostics_);
    }
  }

  // ---- names ------------------------------------------------------------------------------------------------------

  void name_columns() {
    const Line line = source_->line_at(layout_.names.value_or(layout_.first_row));
    table_.place = source_->place_of(line);
    std::vector<Cell> cells;
    cut_line(line.text, layout_.separator, cells);
    for (std::size_t c = 0; c < layout_.cells; ++c) {
      TableColumn column;
      if (c < layout_.columns.size()) {
        column.name = layout_.columns[c].name;
        column.unit = layout_.columns[c].unit;
        column.is_time = layout_.columns[c].is_time;
        const std::size_t cell = layout_.columns[c].cell;
        column.place = cell < cells.size() ? source_->place_of(line, cells[cell]) : table_.place;
      }
      if (column.name.empty()) {
        column.name = std::to_string(c + 1);
        column.is_named = false;
      }
      if (std::ranges::any_of(column.name + column.unit,
                              [](char one) { return one == '"' || (one >= 0 && one < ' ') || one == '\x7F'; })) {
        diagnostics_.error(error::missing_header, column.place,
                           "The name of the column holds a quote or a control character.",
                           "use letters, digits and _ in the names of columns, as a diagram does.");
      }
      const std::optional<TimeName> time = time_name(without_number(column.name));
      const bool names_next = c + 1 < layout_.columns.size() && is_time_of(column.name, layout_.columns[c + 1].name);
      const bool may_be_time = layout_.columns.empty() || time || names_next || time_unit(column.unit) ||
                               (!options_.time.empty() && (equal_ignoring_case(column.name, options_.time) ||
                                                           options_.time == std::to_string(c + 1)));
      keeps_stamps_.push_back(may_be_time || time_unit(last_word(column.name)).has_value());
      table_.columns.push_back(std::move(column));
    }
    stop_on_errors();
    seen_.resize(layout_.cells);
    first_cells_.resize(layout_.cells);
  }

  // ---- rows -------------------------------------------------------------------------------------------------------

  void read_rows() {
    const auto rest = std::string_view(source_->text).substr(layout_.first_row);
    const auto rows = static_cast<std::size_t>(std::ranges::count(rest, '\n')) + 1;
    for (TableColumn& column : table_.columns) {
      column.values.reserve(rows);
    }
    source_->rows.reserve(rows);
    for (std::size_t at = layout_.first_row; at < source_->text.size() && diagnostics_.all().size() < most_errors &&
                                             !(options_.last_row && row_ >= *options_.last_row);) {
      const Line line = source_->line_at(at);
      at = line.next;
      if (is_blank(line.text, layout_.separator)) {
        blank_ = blank_ ? blank_ : line;
      } else if (!is_comment(line.text, layout_.separator)) {
        read_row(line);
      } else {
        remarked_rows_ += is_row_in_remark(line) ? 1 : 0;
      }
    }
    // What prints a line feed too many leaves an empty line behind each row.
    if (row_ > 2 && blanks_ + 1 == row_) {
      table_.notes.emplace_back("there is an empty line between all rows, which is left out");
    } else {
      diagnostics_.add_all(told_blanks_);
    }
    if (remarked_rows_ > 0) {
      table_.notes.push_back(fmt::format("{} between the rows {} a remark, with as many numbers, and {} left out",
                                         counted(remarked_rows_, "line"), remarked_rows_ == 1 ? "is" : "are",
                                         remarked_rows_ == 1 ? "was" : "were"));
    }
    if (repeated_names_ > 0) {
      table_.notes.push_back(fmt::format("the row of names stands {} more between the rows, and was passed over",
                                         counted(repeated_names_, "time")));
    }
    if (stray_ && stray_->text != "\x1A") {  // the end of a file of DOS
      table_.notes.push_back(
          fmt::format("the end of the file, from \"{}\" on, is no part of the record", stray_->text.substr(0, 40)));
    }
  }

  void read_row(const Line& line) {
    cut_line(line.text, layout_.separator, cells_);
    const bool ends_with_separator = cells_.size() == layout_.cells + 1 && cells_.back().text.empty();
    const bool lacks_last_empty = cells_.size() + 1 == layout_.cells && !seen_.back();
    const bool ends_with_remark = cells_.size() == layout_.cells + 1 && layout_.may_end_with_remark;
    if (ends_with_separator || ends_with_remark) {
      cells_.pop_back();
    } else if (lacks_last_empty) {
      cells_.push_back({.offset = line.text.size()});
    }
    const bool any_value =
        std::ranges::any_of(cells_, [&](const Cell& cell) { return is_value(cell_value(cell.text).kind); });
    if (repeats_names(line)) {  // and what stands above them: each part of a record has its head
      ++repeated_names_;
      stray_.reset();
      blank_.reset();
      return;
    }
    // A summary below the record, "Mean,0.1,0.3", is none of its rows.
    const bool summary = (blank_ || stray_) && !begins_with_value() && table_.columns.front().kind != CellKind::Text &&
                         seen_.front() && !is_missing(cells_.front().text);
    if (!any_value || summary || (cells_.size() < layout_.cells && !begins_with_value())) {
      stray_ = stray_ ? stray_ : line;
      return;
    }
    if (stray_ && row_ + 1 > options_.first_row) {
      refuse_stray(line);
    }
    stray_.reset();
    if (blank_) {
      ++blanks_;
      if (told_blanks_.all().size() < most_errors) {
        told_blanks_.error(error::ragged_row, source_->place_of(*blank_),
                           "There is a blank row between rows of numbers.",
                           row_ < 2 ? std::string("remove the row, if no sample is missing there.")
                                    : fmt::format("remove the row, if no sample is missing there; where a second table "
                                                  "begins, read the first alone: --rows 1..{}.",
                                                  row_));
      }
      blank_.reset();
    }
    if (cells_.size() != layout_.cells) {
      refuse_ragged(line);
      return;
    }
    ++row_;
    if (row_ < options_.first_row || (options_.last_row && row_ > *options_.last_row)) {
      return;
    }
    source_->rows.push_back(line.offset);
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      take_cell(line, cells_[i], i);
    }
  }

  /// `# 0.001,2,4`: a row that somebody has taken out, which leaves a gap where nothing but a rate tells the times.
  [[nodiscard]] bool is_row_in_remark(const Line& line) {
    const auto begin = line.text.find_first_not_of(" \t#%/;");
    if (begin == std::string_view::npos || row_ == 0) {
      return false;
    }
    cut_line(line.text.substr(begin), layout_.separator, cells_);
    return cells_.size() > 1 && cells_.size() == layout_.cells &&
           std::ranges::all_of(cells_, [](const Cell& cell) { return is_value(cell_value(cell.text).kind); });
  }

  [[nodiscard]] bool begins_with_value() const {
    return !cells_.empty() && is_value(cell_value(cells_.front().text).kind);
  }

  static bool is_missing(std::string_view text) { return text.empty() || says_missing(text); }

  /// Exports that were put one behind the other repeat the row of names.
  [[nodiscard]] bool repeats_names(const Line& line) const {
    return row_ > 0 && !names_.empty() && line.text == names_;
  }

  void refuse_stray(const Line& line) {
    diagnostics_.error(error::ragged_row, source_->place_of(*stray_),
                       fmt::format("\"{}\" stands between rows of numbers.", stray_->text.substr(0, 40)),
                       fmt::format("read one part alone: --rows 1..{} ends before it.", row_),
                       {{.place = source_->place_of(line), .text = "the numbers go on here"}});
    stray_.reset();
  }

  void refuse_ragged(const Line& line) {
    const std::size_t named = layout_.columns.empty() ? layout_.cells : layout_.columns.size();
    const bool decimal_commas = layout_.separator == ',' && cells_.size() == 2 * named;
    diagnostics_.error(
        error::ragged_row, source_->place_of(line),
        fmt::format("The row has {} where {} {}.", counted(cells_.size(), "cell"),
                    layout_.names ? "the header names" : "the first row has",
                    counted(named, layout_.names ? "column" : "cell")),
        decimal_commas ? "write decimal points, or separate the columns by semicolons." : mend_of_ragged(line));
  }

  /// A record that was cut while it was written ends with a part of a row.
  [[nodiscard]] std::string mend_of_ragged(const Line& line) const {
    const bool last =
        std::string_view(source_->text).find_first_not_of(" \t\r\n\x1A", line.next) == std::string_view::npos;
    if (last && row_ > 1 && cells_.size() < layout_.cells) {
      return fmt::format("if the end of the record is cut, read the rows before it: --rows 1..{}.", row_);
    }
    const std::string first_part =
        row_ > 1 ? fmt::format("; or read the rows before it: --rows 1..{}", row_) : std::string();
    return "write one number for each column of the header, and no separator at the end" + first_part + ".";
  }

  // ---- cells ------------------------------------------------------------------------------------------------------

  void take_cell(const Line& line, const Cell& cell, std::size_t index) {
    TableColumn& column = table_.columns[index];
    const CellValue value = options_.decimal ? number_with_mark(cell.text, *options_.decimal) : cell_value(cell.text);
    if (!seen_[index] && value.kind != CellKind::Empty && !says_missing(cell.text)) {
      seen_[index] = true;
      const bool holds_numbers =
          value.kind == CellKind::NotFinite || value.kind == CellKind::OutOfRange || value.kind == CellKind::TwoMarks;
      column.kind = holds_numbers ? CellKind::Number : value.kind;
      if (column.unit.empty()) {
        column.unit = value.unit;
      }
      first_cells_[index] = std::pair(line, cell);
    }
    const bool is_time =
        column.kind == CellKind::DateTime || column.kind == CellKind::Date || column.kind == CellKind::Clock;
    const bool same = value.kind == column.kind;
    if (!is_time) {
      column.values.push_back(same ? value.number : 0.0);
    }
    if (is_time || keeps_stamps_[index]) {
      column.stamps.push_back(value.stamp);
      if (same && !value.digits.empty()) {
        take_digits(column.resolution, value, is_time);
      }
      if (same && value.is_ambiguous && !column.ambiguity) {
        column.ambiguity = std::string(cell.text);
      }
    }
    if (column.kind == CellKind::Text && (names_signals(column.name) || names_units(column.name))) {
      take_word(column, cell.text);
    }
    if (!same) {
      fault(column, line, cell, value);
      return;
    }
    if (value.kind == CellKind::Number) {
      marks_.see(line, cell, value, index);
      if (!value.unit.empty() && value.unit != column.unit && !column.fault) {
        column.fault = Diagnostic{.number = error::text_for_number,
                                  .place = source_->place_of(line, cell),
                                  .cause = fmt::format("{} is in {}, but column {} is in {}.", cell.text, value.unit,
                                                       column.name, column.unit),
                                  .mend = "record one unit in each column."};
      }
    }
  }

  static void take_digits(PrintedResolution& resolution, const CellValue& value, bool is_time) {
    std::string text(value.digits);
    std::ranges::replace(text, ',', '.');
    resolution.take(is_time ? value.digits == "0" ? "1" : "0." + text : text);
  }

  /// Of a column of counts, the times.
  void count_time() {
    if (!layout_.counted) {
      return;
    }
    TableColumn& column = table_.columns.front();
    for (std::size_t k = 0; k < column.values.size(); ++k) {
      column.values[k] = layout_.counted->start + layout_.counted->increment * column.values[k];
      column.stamps[k] = {.fraction = column.values[k]};
    }
    column.resolution = {};
    column.resolution.take(number_text(layout_.counted->increment));
    table_.notes.push_back(fmt::format("the time is counted from {} s in steps of {} s",
                                       number_text(layout_.counted->start), number_text(layout_.counted->increment)));
  }

  /// What a column of words begins with, for those who ask for it.
  void tell_words(std::size_t index) {
    TableColumn& column = table_.columns[index];
    if (column.kind == CellKind::Text && !column.fault && first_cells_[index]) {
      const auto& [line, cell] = *first_cells_[index];
      column.fault =
          Diagnostic{.number = error::text_for_number,
                     .place = column.place,
                     .cause = fmt::format("Column {} holds no numbers: it begins with \"{}\".", column.name, cell.text),
                     .mend = mend_by_number(cell.text).value_or(std::string(another_column))};
    }
  }

  /// Numbers words in the order in which they come.
  static void take_word(TableColumn& column, std::string_view word) {
    const auto known = std::ranges::find(column.dictionary, word);
    column.words.push_back(static_cast<std::uint32_t>(known - column.dictionary.begin()));
    if (known == column.dictionary.end()) {
      column.dictionary.emplace_back(word);
    }
  }

  void fault(TableColumn& column, const Line& line, const Cell& cell, const CellValue& value) {
    const bool missing = value.kind == CellKind::Empty || value.kind == CellKind::NotFinite || says_missing(cell.text);
    if (missing) {
      column.missing.push_back(source_->rows.size() - 1);
    }
    column.is_gappy = missing && (!column.fault || column.is_gappy);
    if (column.fault) {
      return;
    }
    const std::string cut = row_ > 2 ? fmt::format("read the rows before it: --rows 1..{}", row_ - 1)
                                     : fmt::format("read the rows behind it: --rows {}..", row_ + 1);
    const std::string bridged =
        cut + "; where the signal has a rate of its own, bring it to the others: --resample hold, or linear.";
    Diagnostic found{.place = source_->place_of(line, cell)};
    switch (value.kind) {
      case CellKind::NotFinite:
        found.number = error::number_not_finite;
        found.cause = fmt::format("Column {} holds {}, which is no finite number.", column.name, cell.text);
        found.mend = cut + ", or record the signal again.";
        break;
      case CellKind::OutOfRange:
        found.number = error::number_not_finite;
        found.cause = fmt::format("{} in column {} is beyond the range of LREAL.", cell.text, column.name);
        found.mend = "scale the signal to a unit in which its numbers are of moderate size.";
        break;
      case CellKind::TwoMarks:
        found.number = error::ambiguous_decimal_mark;
        found.cause = options_.decimal ? fmt::format("{} in column {} has another decimal mark than --decimal states.",
                                                     cell.text, column.name)
                                       : fmt::format("{} has more than one decimal mark.", cell.text);
        found.mend = options_.decimal ? "write numbers without separators between thousands."
                     : cell.text.rfind(',') < cell.text.rfind('.')
                         ? "if commas separate thousands, say --decimal point."
                         : "if points separate thousands, say --decimal comma.";
        break;
      case CellKind::Empty:
        found.number = error::text_for_number;
        found.cause = fmt::format("Column {} has no number in this row.", column.name);
        found.mend = bridged;
        break;
      case CellKind::Number: {  // the column began with something else
        const auto& [first_line, first_cell] = *first_cells_[static_cast<std::size_t>(&column - table_.columns.data())];
        found.number = error::text_for_number;
        found.place = source_->place_of(first_line, first_cell);
        found.cause = fmt::format("Column {} begins with \"{}\", which is no number.", column.name, first_cell.text);
        found.mend = fmt::format("read the rows behind it: --rows {}..; a minus is written as -.", row_);
        break;
      }
      default:
        found.number = error::text_for_number;
        found.cause = missing
                          ? fmt::format("Column {} holds \"{}\" here: no value was measured.", column.name, cell.text)
                          : fmt::format("\"{}\" in column {} is no number.", cell.text, column.name);
        found.mend =
            missing
                ? bridged
                : mend_by_number(cell.text).value_or("write a number, such as 1.25e-3, or record the signal again.");
        if (!missing && row_ > 2 && &column == &table_.columns.front()) {  // a summary below the record
          found.mend += fmt::format(" If the record ends above, read it so: --rows 1..{}.", row_ - 1);
        }
    }
    column.fault = std::move(found);
  }

  const ReadOptions& options_;
  Table table_;
  std::shared_ptr<SourceText> source_;
  TextLayout layout_;
  Diagnostics diagnostics_;
  std::vector<Cell> cells_;
  std::vector<bool> keeps_stamps_;
  std::vector<bool> seen_;  ///< by column: whether a cell has told what it holds
  std::size_t row_ = 0;     ///< of numbers, from 1 on, those that are left out among them
  std::vector<std::optional<std::pair<Line, Cell>>> first_cells_;  ///< by column: the cell that has told it
  std::optional<Line> blank_;
  std::size_t blanks_ = 0;  ///< blank rows between rows of numbers
  Diagnostics told_blanks_;
  std::string_view names_{};  ///< the row of names; empty where there is none
  std::size_t repeated_names_ = 0;
  std::size_t remarked_rows_ = 0;
  std::optional<Line> stray_;  ///< text behind the rows: the end of the file, unless rows follow
  DecimalMarks marks_;
};

}  // namespace

Table read_text(const std::string& file, std::string bytes, const ReadOptions& options) {
  return Reader(file, std::move(bytes), options).read();
}

}  // namespace hysteron::records
