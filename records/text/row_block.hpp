// The rows of numbers in a text: the longest run of lines of the same shape.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "records/text/source_text.hpp"

namespace hysteron::records {

/// A run of lines of the same shape.
struct RowBlock {
  std::size_t first = 0;  ///< its line in the head
  std::size_t rows = 0;
  std::vector<bool> values{};  ///< by cell: whether the first line has a value there
  bool begins_empty = false;   ///< the first cell of the first line
  [[nodiscard]] std::size_t score() const { return rows * static_cast<std::size_t>(std::ranges::count(values, true)); }
  /// As many cells, and at least half of the values: a cell that is faulty ends no table. A line that begins with a
  /// word ends before those that begin with a number, or with nothing: "Sample Interval,0.001,0.001" is no row.
  [[nodiscard]] bool goes_on_with(const std::vector<bool>& next, bool next_begins_empty) const {
    if (rows == 0 || next.size() != values.size() || (next.front() && !values.front()) ||
        (!next.front() && !values.front() && next_begins_empty != begins_empty)) {
      return false;
    }
    std::size_t kept = 0;
    std::size_t had = 0;
    for (std::size_t c = 0; c < values.size(); ++c) {
      had += values[c] ? 1 : 0;
      kept += values[c] && next[c] ? 1 : 0;
    }
    return 2 * kept >= had && kept > 0;
  }
};

/// The longest run between these separators; no rows where no line holds a value.
[[nodiscard]] RowBlock longest_block(const std::vector<Line>& head, char separator);

/// Whether the nearest line above a block that is neither blank nor a remark has words in as many cells.
[[nodiscard]] bool has_names_above(const std::vector<Line>& head, const RowBlock& block, char separator);

/// Rows of the same shape above the longest run are rows too: what parts them is reported, not passed over.
void take_earlier_rows(const std::vector<Line>& head, char separator, RowBlock& block);

}  // namespace hysteron::records
