// Columns of numbers that are at hand, of a binary file or of a program, as the table that a text would be.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "records/read_options.hpp"
#include "records/table.hpp"
#include "support/diagnostic.hpp"

namespace hysteron::records {

struct NumberColumn {
  std::string name{};  ///< its unit may stand in it, as in a header: `u [mV]`
  std::string unit{};
  std::vector<double> values{};
  bool is_truth = false;              ///< nothing lies between two of its values
  bool is_time = false;               ///< by what the format says; no signal, whatever it is called
  std::optional<Diagnostic> fault{};  ///< why it is no signal, and has no values
};

/// The table of these columns. One of another length than the time (without a time: than most) is a fault of its own,
/// as is one that holds a value that is not finite. Throws InputError HY501 where no column has two values.
[[nodiscard]] Table table_of(const std::string& file, std::vector<NumberColumn> columns, const ReadOptions& options);

}  // namespace hysteron::records
