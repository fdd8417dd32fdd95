// What a file holds before any of it is a signal over time: what every reader of a format gives.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "records/text/cell_value.hpp"
#include "records/text/source_text.hpp"
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
};

}  // namespace hysteron::records
