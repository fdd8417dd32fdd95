// What the head of a record says of its rate: "Sample rate: 1 kHz", "Delta_X 0.001", "tInc = 1e-3".
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "records/text/source_text.hpp"

namespace hysteron::records {

struct StatedRate {
  double period = 0.0;      ///< s, above 0
  double begin = 0.0;       ///< s, of the first row
  std::string words{};      ///< the line that says it
  bool differs = false;     ///< the line states another step for another column
  bool is_of_rows = false;  ///< the format says so of files without a column of times; else it is a remark of the tool
};

/// Looks through the lines above the rows.
[[nodiscard]] std::optional<StatedRate> stated_rate(const std::vector<Line>& head, std::size_t first_row);

}  // namespace hysteron::records
