// A table of text as a table of values.
#pragma once

#include <string>

#include "records/read_options.hpp"
#include "records/table.hpp"

namespace hysteron::records {

/// Reads it. A cell that is no number is a fault of its column, not of the file: a column that nobody uses may hold
/// what it will. Throws InputError HY501, HY504, HY509, HY510 where the text as a whole is no table.
[[nodiscard]] Table read_text(const std::string& file, std::string bytes, const ReadOptions& options);

}  // namespace hysteron::records
