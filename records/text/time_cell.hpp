// A cell that holds a time: a date, a time of day, both, or a length of time as a PLC or pandas writes it.
#pragma once

#include <optional>
#include <string_view>

#include "records/text/cell_value.hpp"

namespace hysteron::records {

/// DateTime: `2024-06-03 10:00:00.001`, `20240603T100000.001Z`, `03-Jun-2024 10:00:00`, `Mon Jun  3 10:00:00 2024`,
/// `DT#2024-06-03-10:00:00`. Date and Clock: the parts of these, `10:00:00;001`, `12:30.5` of minutes and seconds,
/// `0 days 00:00:00.001`, `T#1s5ms`. Nothing where it is none of them. The text has no blanks at its ends.
[[nodiscard]] std::optional<CellValue> time_cell(std::string_view text);

/// The text behind the time of arrival that a terminal puts before each line: `10:00:00.001 -> 1.5`,
/// `[2024-06-03 10:00:00.001] 1.5`, `2024-06-03 10:00:00.001 1.5`. The text itself where there is none.
[[nodiscard]] std::string_view behind_arrival(std::string_view text);

}  // namespace hysteron::records
