// The log of a program: lines with a time, words, and values with their names, among lines that say other things.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "records/text/layout.hpp"

namespace hysteron::records {

/// A log as a table between tabs. Each line of the log is one line of it, with the values where they stood; a line
/// without the record's values is a remark.
struct LogTable {
  std::string text{};
  TextLayout layout{};
};

/// `[INFO] [1717408800.001]: u: 1.0, y: 2.0`, `I (1234) main: u:1.0`, `2024-06-03T10:00:00.001Z INFO u=1 y=2`,
/// `ts=… level=info u=1`, and lines whose values come in changing order. Nothing where the text is no such log: rows of
/// `u:1.0,y:2.0` alone are a table already. `skip` lines at the top are no part of the record.
[[nodiscard]] std::optional<LogTable> table_of_log(std::string_view text, std::size_t skip);

}  // namespace hysteron::records
