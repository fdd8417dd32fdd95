// Which of the lines above the rows names the columns: between it and the rows may stand units, and what tools add.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "records/text/csv_line.hpp"
#include "records/text/source_text.hpp"

namespace hysteron::records {

struct HeadLine {
  std::size_t line = 0;  ///< in the head
  std::vector<Cell> cells{};
};

/// The lines above the rows that are neither blank nor remarks, the nearest first; no more than a head of names has.
[[nodiscard]] std::vector<HeadLine> lines_above(const std::vector<Line>& head, std::size_t first_row, char separator);

/// Whether the first cell that is not empty is a word.
[[nodiscard]] bool begins_with_text(const std::vector<Cell>& cells);

/// Whether a row states units: one cell is a unit of time, all are in brackets, or half of them at least are units.
[[nodiscard]] bool states_units(const std::vector<Cell>& cells);

/// Whether the row has a word in its first cell alone: pandas names the index so.
[[nodiscard]] bool is_name_of_index(const std::vector<Cell>& cells);

/// Which of the lines, the nearest first, names the columns. It is the nearest, unless that states units, repeats
/// itself or has gaps without naming a time, and the one above it has a different word in each cell.
[[nodiscard]] std::size_t row_of_names(std::span<const HeadLine> words);

}  // namespace hysteron::records
