#include "records/text/log_line.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstddef>
#include <map>
#include <utility>
#include <vector>

#include "records/text/cell_value.hpp"
#include "records/text/characters.hpp"
#include "records/text/named_values.hpp"
#include "records/text/time_cell.hpp"
#include "records/time/time_unit.hpp"
#include "support/counted.hpp"
#include "support/names.hpp"
#include "support/trimmed.hpp"

namespace hysteron::records {
namespace {

/// A log shows what it is in its first lines; before them a controller tells of its start.
constexpr std::size_t looked_at = 400;

// ---- times before them ----------------------------------------------------------------------------------------------

struct LineTime {
  Span span{};  ///< empty where there is none
  CellKind kind = CellKind::Text;
  std::string_view unit{};  ///< of a number

  [[nodiscard]] bool is_like(const LineTime& other) const { return kind == other.kind && unit == other.unit; }
};

/// Without the comma that Zephyr puts between milli- and microseconds, 00:00:01.234,567.
std::string without_group(std::string_view text) {
  std::string result(text);
  const auto point = result.find('.');
  if (point != std::string::npos && point + 4 < result.size() && result[point + 4] == ',') {
    result.erase(point + 4, 1);
  }
  return result;
}

/// 1717408800.001 and 12.345678: of so many digits, or so fine, that it is no identifier of a process.
bool is_number_of_time(std::string_view text) {
  const CellValue value = cell_value(text);
  const auto point = text.find('.');
  return value.kind == CellKind::Number && value.digits.size() == text.size() && is_digit(text.front()) &&
         (epoch_unit(value.stamp.whole) || (point != std::string_view::npos && text.size() - point > 3));
}

/// The time in the brackets that begin at a place: `[1717408800.001]`, `[ 12.345678]`, `[1717408800.001, 12.345]` of
/// ROS, where the second is the time of the simulation.
LineTime time_in_brackets(std::string_view line, std::size_t open, std::size_t limit) {
  const auto close = line.find_first_of("])", open);
  if (close == std::string_view::npos || close >= limit) {
    return {};
  }
  const auto comma = line.rfind(", ", close);
  Span inside{.begin = comma != std::string_view::npos && comma > open ? comma + 2 : open + 1, .end = close};
  inside.begin = behind_blanks(line, inside.begin);
  if (inside.begin >= inside.end) {
    return {};
  }
  // ESP-IDF counts milliseconds: `I (1234) main:`.
  const std::size_t first = behind_blanks(line, 0);
  const bool of_esp = line[open] == '(' && open == first + 2 && line[first + 1] == ' ' &&
                      std::string_view("EWIDV").find(line[first]) != std::string_view::npos;
  const CellValue value = cell_value(inside.of(line));
  if (of_esp && value.kind == CellKind::Number && !value.has_point && !value.has_comma) {
    return {.span = inside, .kind = CellKind::Number, .unit = "ms"};
  }
  return is_number_of_time(inside.of(line)) ? LineTime{.span = inside, .kind = CellKind::Number} : LineTime{};
}

/// The time that stands before the values: a date with a time of day, a time of day, a number in brackets or at the
/// begin. A date without its year counts by its time of day.
LineTime time_before(std::string_view line, std::size_t limit) {
  constexpr std::string_view joints = " \t[](){}<>|,;";
  constexpr std::size_t most_words = 3;
  for (std::size_t at = 0; at < limit; ++at) {
    if (line[at] == '[' || line[at] == '(') {
      if (const LineTime time = time_in_brackets(line, at, limit); time.kind != CellKind::Text) {
        return time;
      }
    }
    const bool begins =
        line[at] != ' ' && line[at] != '\t' && (at == 0 || joints.find(line[at - 1]) != std::string_view::npos);
    if (!begins || joints.find(line[at]) != std::string_view::npos) {
      continue;
    }
    // The longest of one, two and three words that is a time.
    LineTime found;
    std::size_t end = at;
    for (std::size_t words = 1; words <= most_words && end < limit; ++words) {
      end = std::min(std::min(line.find_first_of(" \t[](){}<>|;", end + 1), line.size()), limit);
      const std::string_view text = trimmed(line.substr(at, end - at), " \t,:-");
      const std::string plain = without_group(text);
      const auto time = time_cell(plain);
      if (time && (time->kind == CellKind::DateTime || (time->kind == CellKind::Clock && !time->digits.empty()))) {
        found = {.span = {.begin = at, .end = at + text.size()}, .kind = time->kind};
      }
    }
    if (found.kind != CellKind::Text) {
      return found;
    }
    const Span word{.begin = at, .end = std::min(line.find_first_of(" \t", at), limit)};
    if (at == 0 && is_number_of_time(word.of(line))) {
      return {.span = word, .kind = CellKind::Number};
    }
  }
  return {};
}

// ---- lines ----------------------------------------------------------------------------------------------------------

struct LogLine {
  LineTime time{};
  std::vector<NamedValue> pairs{};

  /// The names of its values, in the order of the alphabet.
  [[nodiscard]] std::vector<std::string> names_of(std::string_view line) const {
    std::vector<std::string> names;
    for (const NamedValue& one : pairs) {
      names.emplace_back(one.name.of(line));
    }
    std::ranges::sort(names);
    return names;
  }
};

/// Nothing where a line holds no values with names, or one name twice.
std::optional<LogLine> log_line(std::string_view line) {
  line = line.substr(0, line.find_last_not_of(" \t,;") + 1);
  if (line.find_first_of(":=") == std::string_view::npos) {
    return std::nullopt;
  }
  LogLine result{.pairs = named_values(line)};
  const auto names = result.names_of(line);
  if (names.empty() || std::ranges::adjacent_find(names) != names.end()) {
    return std::nullopt;
  }
  result.time = time_before(line, result.pairs.front().name.begin);
  return result;
}

/// A row of a table: digits and marks, and letters at most of 1e-3 and of a date.
bool is_row_of_numbers(std::string_view line) {
  return std::ranges::none_of(
      line, [](char c) { return is_letter(c) && std::string_view("eETZ").find(c) == std::string_view::npos; });
}

/// What the rows of a log have in common.
struct Shape {
  LineTime time{};
  std::vector<std::string> names{};
};

/// Makes the table, line by line.
class LogWriter {
 public:
  LogWriter(std::string_view text, std::size_t skip) : text_(text), skip_(skip) {}

  std::optional<LogTable> table() {
    if (!find_shape()) {
      return std::nullopt;
    }
    write_all();
    return rows_ > 1 && has_reason_ ? std::optional(std::move(result_)) : std::nullopt;
  }

 private:
  template <class Take>
  void for_each_line(std::size_t most, const Take& take) const {
    std::size_t skipped = 0;
    for (std::size_t at = 0; at < text_.size() && most > 0;) {
      const std::size_t end = std::min(text_.find('\n', at), text_.size());
      std::string_view line = text_.substr(at, end - at);
      line.remove_suffix(line.ends_with('\r') ? 1 : 0);
      at = end + 1;
      const bool is_skipped = skipped++ < skip_;
      most -= trimmed(line).empty() || is_skipped ? 0 : 1;
      take(line, is_skipped);
    }
  }

  /// The names of the rows: of the lines that come most often, and of those that come at least a tenth as often, such
  /// as a line for each signal.
  bool find_shape() {
    std::map<std::vector<std::string>, std::size_t> counts;
    std::vector<std::string> order;
    std::size_t lines = 0;
    std::size_t plain = 0;
    for_each_line(looked_at, [&](std::string_view line, bool is_skipped) {
      const bool is_said = !is_skipped && !trimmed(line).empty();
      lines += is_said ? 1 : 0;
      const auto one = is_said ? log_line(line) : std::nullopt;
      if (!one) {
        plain += is_said && is_row_of_numbers(line) ? 1 : 0;
        return;
      }
      ++counts[one->names_of(line)];
      shape_.time = shape_.time.kind == CellKind::Text ? one->time : shape_.time;
      for (const NamedValue& pair : one->pairs) {
        if (std::ranges::find(order, pair.name.of(line)) == order.end()) {
          order.emplace_back(pair.name.of(line));
        }
      }
    });
    std::size_t most = 2;  // a name that comes once is a setting of the head
    for (const auto& [names, count] : counts) {
      most = std::max(most, count);
    }
    std::erase_if(counts, [&](const auto& one) { return one.second < 2 || 10 * one.second < most; });
    std::size_t rows = 0;
    for (const auto& [names, count] : counts) {
      rows += count;
    }
    if (rows == 0 || 4 * rows < lines || rows <= plain) {
      return false;
    }
    std::ranges::copy_if(order, std::back_inserter(shape_.names), [&](const std::string& name) {
      return std::ranges::any_of(counts, [&](const auto& one) { return std::ranges::binary_search(one.first, name); });
    });
    for (auto& [names, count] : counts) {
      shapes_.push_back(names);
    }
    // A time among the values is the row's own; T alone is a temperature where another time stands before.
    if (std::ranges::any_of(shape_.names,
                            [](const std::string& name) { return name != "T" && time_name(name).has_value(); })) {
      shape_.time = {};
    }
    return true;
  }

  void write_all() {
    TextLayout& layout = result_.layout;
    layout.separator = '\t';
    has_time_ = shape_.time.kind != CellKind::Text;
    has_reason_ = has_time_ || shapes_.size() > 1;
    if (has_time_) {
      layout.columns.push_back({.name = "time", .unit = std::string(shape_.time.unit)});
    }
    for (const std::string& name : shape_.names) {
      layout.columns.push_back({.name = name});
    }
    layout.cells = layout.columns.size();
    std::size_t others = 0;
    for_each_line(text_.size() + 1, [&](std::string_view line, bool is_skipped) {
      const auto one = is_skipped ? std::nullopt : log_line(line);
      const bool is_row = one && (!has_time_ || one->time.is_like(shape_.time)) &&
                          std::ranges::find(shapes_, one->names_of(line)) != shapes_.end();
      if (is_row) {
        layout.first_row = rows_ == 0 ? result_.text.size() : layout.first_row;
        ++rows_;
        result_.text += row_of(line, *one);
      } else if (!trimmed(line).empty()) {
        others += is_skipped ? 0 : 1;
        result_.text += '#';
      }
      result_.text += '\n';
    });
    layout.notes.push_back(fmt::format("it is a log, whose values have names: {}", fmt::join(shape_.names, ", ")));
    if (others > 0) {
      layout.notes.push_back(fmt::format("{} of the log {} other values or none, and {} left out",
                                         counted(others, "line"), others == 1 ? "holds" : "hold",
                                         others == 1 ? "is" : "are"));
    }
    if (has_comma_) {
      layout.notes.emplace_back("commas in its numbers are decimal ones");
    }
  }

  std::string row_of(std::string_view line, const LogLine& one) {
    bool in_order = one.pairs.size() == shape_.names.size();
    for (std::size_t k = 0; in_order && k < one.pairs.size(); ++k) {
      in_order = one.pairs[k].name.of(line) == shape_.names[k];
    }
    for (const NamedValue& pair : one.pairs) {
      const CellValue value = cell_value(pair.value.of(line));
      has_comma_ = has_comma_ || value.has_comma;
      const bool has_unit = pair.unit.end > pair.unit.begin;
      const bool has_blanks = pair.value.begin > pair.name.end + 1;
      has_reason_ = has_reason_ || has_unit || has_blanks || !is_value(value.kind) || value.kind == CellKind::DateTime;
    }
    has_reason_ = has_reason_ || !in_order;
    return in_order ? row_in_place(line, one) : row_in_order(line, one);
  }

  /// Each value where it stood, so that a place in the table is one in the file.
  [[nodiscard]] std::string row_in_place(std::string_view line, const LogLine& one) const {
    std::string row(line.size(), ' ');
    const auto put = [&](std::size_t at, std::string_view text) { row.replace(at, text.size(), text); };
    if (has_time_) {
      put(one.time.span.begin, without_group(one.time.span.of(line)));
    }
    for (std::size_t k = 0; k < one.pairs.size(); ++k) {
      const NamedValue& pair = one.pairs[k];
      if (has_time_ || k > 0) {
        row[pair.name.begin - 1] = '\t';
      }
      // A blank before the unit, 1.5V: there is room for it where the name stood.
      const bool joined = pair.unit.end > pair.unit.begin && pair.unit.begin == pair.value.end;
      put(pair.value.begin - (joined ? 1 : 0), pair.value.of(line));
      if (joined) {
        row[pair.unit.begin - 1] = ' ';
      }
      put(pair.unit.begin, pair.unit.of(line));
    }
    return row;
  }

  [[nodiscard]] std::string row_in_order(std::string_view line, const LogLine& one) const {
    std::string row = has_time_ ? without_group(one.time.span.of(line)) : std::string();
    for (std::size_t k = 0; k < shape_.names.size(); ++k) {
      row += has_time_ || k > 0 ? "\t" : "";
      const auto pair = std::ranges::find_if(
          one.pairs, [&](const NamedValue& other) { return other.name.of(line) == shape_.names[k]; });
      if (pair != one.pairs.end()) {
        row += pair->value.of(line);
        row += pair->unit.end > pair->unit.begin ? fmt::format(" {}", pair->unit.of(line)) : std::string();
      }
    }
    return row;
  }

  std::string_view text_;
  std::size_t skip_;
  Shape shape_;
  std::vector<std::vector<std::string>> shapes_;  ///< the names of the lines that are rows
  LogTable result_;
  std::size_t rows_ = 0;
  bool has_time_ = false;
  bool has_comma_ = false;
  bool has_reason_ = false;  ///< whether the lines are more than a table of values with names
};

}  // namespace

std::optional<LogTable> table_of_log(std::string_view text, std::size_t skip) {
  return LogWriter(text, skip).table();
}

}  // namespace hysteron::records
