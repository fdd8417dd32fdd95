// What a file holds before any of it is a signal over time: what every reader of a format gives.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "records/text/cell_value.hpp"
#include "records/text/source_text.hpp"
#include "records/text/stated_rate.hpp"
#include "records/time/time_grid.hpp"
#include "support/diagnostic.hpp"

namespace hysteron::records {

struct TableColumn {
  std::string name{};
  std::string unit{};
  std::string in_file{};                   ///< its name in the file, where it was given another
  bool is_named = true;                    ///< in the file; else the name is the column's number
  CellKind kind = CellKind::Number;        ///< of its cells: Number, Truth, DateTime, Date, Clock or Text
  std::vector<double> values{};            ///< of numbers and truths
  std::vector<Stamp> stamps{};             ///< of times, and of numbers that may be times
  PrintedResolution resolution{};          ///< of the same
  std::vector<std::size_t> missing{};      ///< rows whose cell is empty or no finite number, rising
  bool is_gappy = false;                   ///< all that is wrong with it is missing
  bool has_values = false;                 ///< at least one of its cells is not empty
  bool is_time = false;                    ///< by what the format says; no signal, whatever it is called
  bool is_part_of_time = false;            ///< joined to the column of the time: its milliseconds
  std::vector<std::uint32_t> words{};      ///< of a column that names signals: which word of the dictionary
  std::vector<std::string> dictionary{};   ///< its words, in the order in which they come
  std::optional<Diagnostic> fault{};       ///< the first cell that is no value
  std::optional<std::string> ambiguity{};  ///< a date that could be another
  Place place{};                           ///< of its name
};

struct Table {
  std::vector<TableColumn> columns{};
  std::size_t rows = 0;
  Place place{};                         ///< of the row of names
  std::shared_ptr<SourceText> source{};  ///< null where it was no text
  std::vector<std::string> notes{};      ///< what was understood that the file does not say outright
  std::optional<StatedRate> stated{};    ///< what the head of a text says of its rate
};

/// The mend of a column that holds something else than numbers.
inline constexpr std::string_view another_column = "name another column with --column.";

[[nodiscard]] std::vector<std::string> names_of(const Table& table);

/// The columns of a name, without regard to case; of several, the one that is written so. Where there is none, the one
/// of that number, from 1 on.
[[nodiscard]] std::vector<std::size_t> columns_called(const Table& table, std::string_view name);

}  // namespace hysteron::records
