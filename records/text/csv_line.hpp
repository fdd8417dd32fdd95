// A line of a table of text cut into cells.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace hysteron::records {

struct Cell {
  std::string_view text{};  ///< without blanks round it, and without quotes
  std::size_t offset = 0;   ///< in bytes from the begin of the line
};

/// Cuts a line at a separator that stands outside quotes; the blank separates however often it stands. Reuses the
/// cells' memory.
void cut_line(std::string_view line, char separator, std::vector<Cell>& cells);

/// Whether a line holds nothing: blanks, separators and empty quotes only. Spreadsheets leave such rows at the end.
[[nodiscard]] bool is_blank(std::string_view line, char separator);

struct HeaderName {
  std::string name{};
  std::string unit{};
};

/// `u [V]`, `u (V)`, `u {V}`, `u <V>`, `u / V`, `u/V`, `u in V`, `u, V`, and of units of more than one letter `u: mV`,
/// `u - mV` and `u mV` as name `u` and its unit; `y[2] [V]` as the element `y[2]` in V. `u_mV` and `u.mV` keep their
/// names, and their unit is mV. `V(u)` is a name of circuit simulators.
[[nodiscard]] HeaderName split_header(std::string_view cell);

}  // namespace hysteron::records
