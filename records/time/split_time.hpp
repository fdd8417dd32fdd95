// Times that tools write into two columns: seconds or a clock in one, what is left of a second in the other.
#pragma once

#include "records/table.hpp"

namespace hysteron::records {

/// Joins them: `Time,Millitm`, `Date&Time,ms`, `header.stamp.sec,header.stamp.nanosec`. The second column becomes a
/// part of the time, and a note says so. A clock that tells parts of a second itself is left as it is.
void join_split_times(Table& table);

}  // namespace hysteron::records
