#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <utility>

#include "records/csv.hpp"
#include "records/csv_line.hpp"
#include "records/source_text.hpp"
#include "records/time_grid.hpp"
#include "support/errors.hpp"
#include "support/names.hpp"
#include "support/numbers.hpp"
#include "support/text_file.hpp"
#include "support/utf8.hpp"

namespace hysteron::records {
namespace {

/// More errors than these are not shown: a file of the wrong kind has one in every cell.
constexpr std::size_t most_errors = 10;

bool is_comment(std::string_view line) {
  const auto first = line.find_first_not_of(" \t");
  return first != std::string_view::npos && line[first] == '#';
}

/// Reads one text into one record. Errors are collected; finish() throws them.
class Reader {
 public:
  Reader(const std::string& file, std::string text) : source_{.file = file, .text = std::move(text)} {}

  Record read() {
    check_encoding();
    read_header();
    read_rows();
    stop_on_errors();
    return make_record();
  }

 private:
  void stop_on_errors() const {
    if (diagnostics_.has_errors()) {
      throw InputError(diagnostics_);
    }
  }

  [[nodiscard]] bool enough_errors() const { return diagnostics_.all().size() >= most_errors; }

  // ---- bytes ------------------------------------------------------------------------------------------------------

  void check_encoding() {
    const std::string_view text = source_.text;
    if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF")) {
      throw InputError(error::not_text, {.file = source_.file}, "The file is UTF-16, not UTF-8.",
                       "save it as UTF-8; spreadsheets call that \"CSV UTF-8\".");
    }
    const auto bad = std::min(first_invalid_utf8(text), text.find('\0'));
    if (bad != std::string_view::npos) {
      const auto begin = bad == 0 ? 0 : text.rfind('\n', bad - 1) + 1;  // npos + 1 is 0
      const Line line = source_.line_at(begin);
      throw InputError(
          error::not_text, source_.place_of(line, {.text = text.substr(bad, 1), .offset = bad - begin}),
          fmt::format("The byte 16#{:02X} belongs to no text in UTF-8.", static_cast<unsigned char>(text[bad])),
          "save the file as UTF-8, or write the header without accents, µ and °.");
    }
    if (text.starts_with("\xEF\xBB\xBF")) {
      source_.text.erase(0, 3);
    }
  }

  // ---- header -----------------------------------------------------------------------------------------------------

  void read_header() {
    bool comments = false;
    do {
      header_ = source_.line_at(header_.next);
      comments = comments || is_comment(header_.text);
    } while (header_.next < source_.text.size() && (is_blank(header_.text, ',') || is_comment(header_.text)));
    if (is_blank(header_.text, ',') || is_comment(header_.text)) {
      throw InputError(error::record_too_short, {.file = source_.file}, "The file holds no header and no rows.",
                       "write a header row, such as t,u,y, and one row of numbers for each sample.");
    }
    source_.header = header_.offset;
    source_.separator = separator_of(header_.text);
    cut_line(header_.text, source_.separator, cells_);
    for (const Cell& cell : cells_) {
      take_name(cell, comments);
    }
    stop_on_errors();
    if (!has_time_) {
      const auto time_like = std::find_if(columns_.begin(), columns_.end(), [](const Column& column) {
        return equal_ignoring_case(column.name, "time") || equal_ignoring_case(column.name, "time_s") ||
               equal_ignoring_case(column.name, "timestamp");
      });
      std::string mend = "add the time in seconds as a column t; separate columns by commas, semicolons or tabs.";
      if (time_like != columns_.end()) {
        mend = fmt::format("give the column {} the name t, with the time in seconds.", time_like->name);
      }
      throw InputError(error::missing_column, source_.place_of(header_), "There is no column t.", mend);
    }
  }

  void take_name(const Cell& cell, bool after_comments) {
    const auto place = source_.place_of(header_, cell);
    auto [name, unit] = split_header(cell.text);
    std::string as_number(cell.text);
    std::replace(as_number.begin(), as_number.end(), ',', '.');
    if (name.empty() || parse_number(as_number).status != NumberStatus::NotANumber) {
      const auto number = cells_.size() == 1 ? std::string() : fmt::format(" {}", &cell - cells_.data() + 1);
      diagnostics_.error(error::missing_header, place,
                         name.empty() ? fmt::format("Column{} has no name.", number)
                                      : fmt::format("The first row names the columns, but {} is a number.", cell.text),
                         name.empty()     ? "give every column a name, and end no line with a separator."
                         : after_comments ? "write the names above the numbers; a line that begins with # is a comment."
                                          : "write a header row above the numbers, such as t,u,y.");
      return;
    }
    if (std::any_of(cell.text.begin(), cell.text.end(),
                    [](char c) { return c == '"' || (c >= 0 && c < ' ') || c == '\x7F'; })) {
      diagnostics_.error(error::missing_header, place, "The name of the column holds a quote or a control character.",
                         "use letters, digits and _ in the names of columns, as a diagram does.");
      return;
    }
    if (equal_ignoring_case(name, "t")) {
      if (!unit.empty() && unit != "s") {
        diagnostics_.error(error::time_unit, place, fmt::format("The time is given in {}, not in seconds.", unit),
                           "convert the column to seconds and name it t or t [s].");
      }
      if (!has_time_) {
        has_time_ = true;
        time_column_ = columns_.size();
        columns_.push_back({.name = std::move(name), .unit = std::move(unit)});
        return;
      }
    }
    for (const Column& other : columns_) {
      if (equal_ignoring_case(other.name, name)) {
        diagnostics_.error(error::duplicate_column, place, fmt::format("There are two columns {}.", name),
                           "give each column a name of its own; case makes no difference.");
        return;
      }
    }
    columns_.push_back({.name = std::move(name), .unit = std::move(unit)});
  }

  // ---- rows -------------------------------------------------------------------------------------------------------

  void read_rows() {
    const auto rest = std::string_view(source_.text).substr(header_.next);
    const auto rows = static_cast<std::size_t>(std::count(rest.begin(), rest.end(), '\n')) + 1;
    for (Column& column : columns_) {
      column.values.reserve(rows);
    }
    source_.rows.reserve(rows);
    std::optional<Line> blank;
    for (std::size_t at = header_.next; at < source_.text.size() && !enough_errors();) {
      const Line line = source_.line_at(at);
      at = line.next;
      if (is_comment(line.text)) {
        continue;
      }
      if (is_blank(line.text, source_.separator)) {
        blank = blank ? blank : line;
        continue;
      }
      if (blank) {
        diagnostics_.error(error::ragged_row, source_.place_of(*blank), "There is a blank row between rows of numbers.",
                           "remove the row, if no sample is missing there.");
        blank.reset();
      }
      read_row(line);
    }
    stop_on_errors();
    if (source_.rows.size() < 2) {
      throw InputError(
          error::record_too_short, source_.place_of(header_),
          fmt::format("The record has {}; the sample time needs two.", source_.rows.empty() ? "no rows" : "one row"),
          "record at least two rows.");
    }
  }

  void read_row(const Line& line) {
    cut_line(line.text, source_.separator, cells_);
    if (cells_.size() != columns_.size()) {
      const bool decimal_commas = source_.separator == ',' && cells_.size() == 2 * columns_.size();
      diagnostics_.error(error::ragged_row, source_.place_of(line),
                         fmt::format("The row has {} where the header names {}.", counted(cells_.size(), "cell"),
                                     counted(columns_.size(), "column")),
                         decimal_commas
                             ? "write decimal points, or separate the columns by semicolons."
                             : "write one number for each column of the header, and no separator at the end.");
      return;
    }
    source_.rows.push_back(line.offset);
    for (std::size_t i = 0; i < cells_.size(); ++i) {
      columns_[i].values.push_back(number_in(line, cells_[i], columns_[i].name, i == time_column_));
    }
  }

  double number_in(const Line& line, const Cell& cell, const std::string& column, bool is_time) {
    std::string_view text = cell.text;
    const auto comma = text.find(',');
    const bool has_comma = comma != std::string_view::npos;
    if (has_comma &&
        (text.find(',', comma + 1) != std::string_view::npos || text.find('.') != std::string_view::npos)) {
      if (std::all_of(text.begin(), text.end(),
                      [](char c) { return std::string_view("0123456789.,+-").find(c) != std::string_view::npos; })) {
        diagnostics_.error(error::ambiguous_decimal_mark, source_.place_of(line, cell),
                           fmt::format("{} has more than one decimal mark.", text),
                           "write numbers without separators between thousands.");
        return 0.0;
      }
    }
    if (has_comma) {
      // A decimal comma. The text is short: it fits the buffer or is no number that a logger writes.
      if (text.size() > point_.size()) {
        refuse_number(line, cell, column, NumberStatus::NotANumber);
        return 0.0;
      }
      std::copy(text.begin(), text.end(), point_.begin());
      point_[comma] = '.';
      text = {point_.data(), text.size()};
    }
    const ParsedNumber number = parse_number(text);
    if (number.status != NumberStatus::Finite) {
      refuse_number(line, cell, column, number.status);
      return 0.0;
    }
    if (has_comma || text.find('.') != std::string_view::npos) {
      check_decimal_mark(line, cell, has_comma);
    }
    if (is_time) {
      resolution_.take(text);
    }
    return number.value;
  }

  /// One file has one decimal mark: where both are found, one of them separates thousands.
  void check_decimal_mark(const Line& line, const Cell& cell, bool comma) {
    auto& seen = comma ? comma_seen_ : point_seen_;
    const auto& other = comma ? point_seen_ : comma_seen_;
    if (seen) {
      return;
    }
    seen = std::pair(line, cell);
    if (other) {
      diagnostics_.error(error::ambiguous_decimal_mark, source_.place_of(line, cell),
                         fmt::format("{} has a decimal {}, an earlier number has a decimal {}.", cell.text,
                                     comma ? "comma" : "point", comma ? "point" : "comma"),
                         "write all numbers with the same decimal mark, and without separators between thousands.",
                         {{.place = source_.place_of(other->first, other->second), .text = "the earlier number"}});
    }
  }

  void refuse_number(const Line& line, const Cell& cell, const std::string& column, NumberStatus status) {
    const Place place = source_.place_of(line, cell);
    switch (status) {
      case NumberStatus::NotFinite:
        diagnostics_.error(error::number_not_finite, place,
                           fmt::format("Column {} holds {}, which is no finite number.", column, cell.text),
                           "cut the record before this row, or record the signal again.");
        break;
      case NumberStatus::OutOfRange:
        diagnostics_.error(error::number_not_finite, place,
                           fmt::format("{} in column {} is beyond the range of LREAL.", cell.text, column),
                           "scale the signal to a unit in which its numbers are of moderate size.");
        break;
      default:
        diagnostics_.error(error::text_for_number, place,
                           cell.text.empty() ? fmt::format("Column {} has no number in this row.", column)
                                             : fmt::format("\"{}\" in column {} is no number.", cell.text, column),
                           cell.text.empty() ? "write the number that was measured, or cut the record here."
                                             : "write a number, such as 1.25e-3, or remove the column.");
    }
  }

  static std::string counted(std::size_t count, std::string_view noun) {
    return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
  }

  // ---- time -------------------------------------------------------------------------------------------------------

  Record make_record() {
    std::vector<double> time = std::move(columns_[time_column_].values);
    columns_.erase(columns_.begin() + static_cast<std::ptrdiff_t>(time_column_));
    const TimeGrid grid = find_time_grid(time, resolution_);
    if (grid.fault) {
      refuse_time(*grid.fault, time);
    }
    const Place header = source_.place_of(header_);
    return {std::move(time), grid.sample_time, std::move(columns_), header,
            std::make_shared<const SourceText>(std::move(source_))};
  }

  [[noreturn]] void refuse_time(const TimeFault& fault, const std::vector<double>& time) {
    constexpr int digits = 6;
    Diagnostics list;
    const std::vector<Note> before{{.place = source_.place("t", fault.row - 1), .text = "the row before"}};
    if (fault.reversed) {
      const bool same = time[fault.row] == time[fault.row - 1];
      const auto [last, here] = distinct_texts(time[fault.row - 1], time[fault.row], digits);
      list.error(error::reversed_time, source_.place("t", fault.row),
                 same ? fmt::format("The time {} s stands in two rows.", here)
                      : fmt::format("The time runs back, from {} s to {} s.", last, here),
                 same ? "print the time with more digits, or remove the row that was written twice."
                      : "put the rows in the order of time; give each record a file of its own.",
                 before);
    } else {
      std::string mend =
          "resample the record to a constant sample time, or cut it here. Take the nearest sample of encoders and "
          "commands, which step, and interpolate slow analog signals alone.";
      if (fault.step > 1.5 * fault.usual) {
        mend = "rows are missing: cut the record here, or record it again.";
      }
      if (fault.coarse) {
        mend += " The times are printed coarsely: more digits may mend it.";
      }
      const auto [here, elsewhere] = distinct_texts(fault.step, fault.usual, digits);
      list.error(error::uneven_time, source_.place("t", fault.row),
                 fault.off > 0.0 ? fmt::format("No single step stands out, but the times stray from an even grid by "
                                               "{:.3g} s, {:.3g} sample times: the clock jitters or drifts.",
                                               fault.off, fault.off / fault.usual)
                                 : fmt::format("The time goes on by {} s here, elsewhere by {} s.", here, elsewhere),
                 mend, before);
    }
    throw InputError(list);
  }

  SourceText source_;
  Diagnostics diagnostics_;
  Line header_{};
  std::vector<Cell> cells_;
  std::vector<Column> columns_;  ///< the time among them, until the record is made
  bool has_time_ = false;
  std::size_t time_column_ = 0;
  std::array<char, 64> point_{};
  std::optional<std::pair<Line, Cell>> comma_seen_;
  std::optional<std::pair<Line, Cell>> point_seen_;
  PrintedResolution resolution_;
};

}  // namespace

Record parse_csv(const std::string& file, std::string text) {
  return Reader(file, std::move(text)).read();
}

Record read_csv(const std::string& path) {
  return parse_csv(path, read_text_file(path));
}

}  // namespace hysteron::records
