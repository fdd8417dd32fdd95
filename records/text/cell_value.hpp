// What a cell of a text says: a number, a date, a time of day, a word for true or false, or none of these.
#pragma once

#include <cstdint>
#include <string_view>

namespace hysteron::records {

/// A time to the nanosecond and beyond, where a double would round it: 1717408800.001 s, 2024-06-03T10:00:00.001.
struct Stamp {
  std::int64_t whole = 0;
  double fraction = 0.0;
};

enum class CellKind : std::uint8_t {
  Empty,
  Number,
  NotFinite,   ///< nan, inf, NULL and the like: nothing was measured
  OutOfRange,  ///< a number that no double holds
  TwoMarks,    ///< a number with more decimal marks than one: one of them separates thousands
  Truth,       ///< TRUE, FALSE, ON, OFF: 1 or 0
  DateTime,
  Date,
  Clock,  ///< a time of day
  Text
};

struct CellValue {
  CellKind kind = CellKind::Text;
  double number = 0.0;
  Stamp stamp{};              ///< of a number, in its unit; of dates and clocks, in seconds since 1970 or midnight
  std::string_view digits{};  ///< of a time, what was printed of it: 0.001 of 10:00:00.001
  std::string_view label{};   ///< u of u:1.0
  std::string_view unit{};    ///< V of "1.5 V"
  bool has_point = false;     ///< a decimal point
  bool has_comma = false;     ///< a decimal comma
  bool is_ambiguous = false;  ///< 6/3/2024, a day of two months; 00:58, of hours or of minutes
};

/// Reads a cell. A comma in it is a decimal mark: where it separates cells, it stands in none but in quotes.
[[nodiscard]] CellValue cell_value(std::string_view text);

/// Reads a cell whose decimal mark is stated: the other mark then separates thousands, 2.664 and 1.234,5 where it is
/// the comma. TwoMarks where it stands elsewhere than between groups of three digits.
[[nodiscard]] CellValue number_with_mark(std::string_view text, char decimal);

/// Whether the cell is a word or sign for a value that was not measured: -, OL, #VALUE!.
[[nodiscard]] bool says_missing(std::string_view text);

/// Whether the kind is one that a column of a record has rows of.
[[nodiscard]] constexpr bool is_value(CellKind kind) {
  return kind != CellKind::Empty && kind != CellKind::Text;
}

}  // namespace hysteron::records
