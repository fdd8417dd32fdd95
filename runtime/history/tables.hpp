// The tables of a history, and what a file is that stands at its name.
//
//   runs      a row for each start of a task: its title, the period of a cycle, and how many periods lie between rows
//   points    a row for each column that was ever recorded: the point, its unit, type and meaning
//   recorded  which columns a run has; a cell without a value is no number there, and not recorded elsewhere
//   rows      the values: run, cycle, elapsed periods since the run's start, UTC in milliseconds, a column a point
//
// Rows are numbered as they were written, and that is their order: the wall clock may be set back.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "database/sqlite.hpp"

namespace hysteron::runtime {

inline constexpr int history_version = 1;

enum class HistoryKind : std::uint8_t {
  None,     ///< nothing is there, or an empty file
  Fits,     ///< a history of this version
  Other,    ///< a history of another version
  Damaged,  ///< a file of SQLite that cannot be read, or one whose beginning is all zeros
  Foreign,  ///< anything else
};

/// Changes nothing. Throws database::DatabaseError where that cannot be told.
[[nodiscard]] HistoryKind kind_of_history(const std::filesystem::path& file);

/// In a file that has none.
void make_history_tables(database::Database& database);

/// A name as SQL has it: "HYST.C1".
[[nodiscard]] std::string sql_name(std::string_view name);

}  // namespace hysteron::runtime
