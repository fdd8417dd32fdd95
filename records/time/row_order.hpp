// Rows in another order than that of their times: newest first, as histories export them, or written twice.
#pragma once

#include <span>

#include "records/read_options.hpp"
#include "records/table.hpp"

namespace hysteron::records {

/// Brings the rows into the order of their times, where these allow it, and says so: all times run back; the rows of a
/// time fill each other's gaps; a row stands twice, with the same numbers; or, where the record is resampled, two rows
/// have one time, and the later one counts, as at the events of a simulation. Whether a row was moved or left out.
[[nodiscard]] bool settle_rows(Table& table, std::span<const double> seconds, const ReadOptions& options);

}  // namespace hysteron::records
