// What the columns of a table are called in the diagram, and a column that is called as the time is.
#pragma once

#include "records/read_options.hpp"
#include "records/table.hpp"
#include "records/time/time_column.hpp"

namespace hysteron::records {

/// Gives the columns the names that are stated. A column that had the name before is passed over. Throws InputError
/// HY502 where the file has none of a name, HY514 where it has two.
void rename(Table& table, const ReadOptions& options);

/// A column called t that is not the time is the signal T, but where another was named as that.
void settle_names_of_t(Table& table, const Times& times, const ReadOptions& options);

}  // namespace hysteron::records
