// Tables with a row for each value, which name the signal in a column, as WinCC and InfluxDB export them:
//
//   VarName;TimeString;VarValue;Validity;Time_ms
//   u;03.06.2024 10:00:00;0,8883;1;45446416666,6667
//   y;03.06.2024 10:00:00;2,6649;1;45446416666,6667
#pragma once

#include "records/table.hpp"

namespace hysteron::records {

/// Whether a column of this name holds the names of signals, beside a column of their values.
[[nodiscard]] bool names_signals(std::string_view column);

/// A column for each signal, and a row for each time; a signal without a value at a time is missing there. The table as
/// it is where it is none of these.
[[nodiscard]] Table widened(Table table);

}  // namespace hysteron::records
