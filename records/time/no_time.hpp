// What is said of a record in which no column is the time.
#pragma once

#include "records/table.hpp"

namespace hysteron::records {

/// Throws InputError HY502, or HY509 where the columns have no names, with the way out for this table: the rate above
/// its rows, the column that counts them, the one that rises.
[[noreturn]] void refuse_without_time(const Table& table);

}  // namespace hysteron::records
