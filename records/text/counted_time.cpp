#include "records/text/counted_time.hpp"

#include <algorithm>
#include <vector>

#include "records/text/cell_value.hpp"
#include "records/text/csv_line.hpp"
#include "support/names.hpp"

namespace hysteron::records {

std::optional<CountedTime> counted_time(std::string_view names, std::string_view units) {
  std::vector<Cell> above;
  std::vector<Cell> below;
  cut_line(names, ',', above);
  cut_line(units, ',', below);
  const auto stated = [&](std::string_view name) -> std::optional<double> {
    const auto found =
        std::ranges::find_if(above, [&](const Cell& cell) { return equal_ignoring_case(cell.text, name); });
    const auto at = static_cast<std::size_t>(found - above.begin());
    if (found == above.end() || at >= below.size()) {
      return std::nullopt;
    }
    const CellValue value = cell_value(below[at].text);
    return value.kind == CellKind::Number ? std::optional(value.number) : std::nullopt;
  };
  const auto start = stated("Start");
  const auto increment = stated("Increment");
  return start && increment && *increment > 0.0 ? std::optional(CountedTime{*start, *increment}) : std::nullopt;
}

}  // namespace hysteron::records
