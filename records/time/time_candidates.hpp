// Which columns of a table could be the time; and of a column called t, where a signal is called T, which of both it
// is.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "records/read_options.hpp"
#include "records/table.hpp"

namespace hysteron::records {

/// Those that are called so, hold dates or times of day, or are the times of a signal; without those that are the
/// signal T. Throws InputError HY514 where a column could be both.
[[nodiscard]] std::vector<std::size_t> time_candidates(const Table& table, const ReadOptions& options);

[[nodiscard]] bool is_clock_kind(CellKind kind);

/// Of a signal at a rate of its own the rows end earlier: how many there are; all where a cell is missing in between.
[[nodiscard]] std::size_t own_rows(const TableColumn& column, std::size_t rows);

/// Whether the times of a column go up from row to row; of days, whether they never go back.
[[nodiscard]] bool rises(const TableColumn& column);

/// The columns of numbers that rise from row to row, whatever they are called.
[[nodiscard]] std::vector<std::size_t> rising_columns(const Table& table);

[[nodiscard]] std::vector<std::string> names_of(const Table& table, const std::vector<std::size_t>& columns);

}  // namespace hysteron::records
