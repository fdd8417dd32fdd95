#include "records/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "records/time/time_grid.hpp"

namespace hysteron::records {

ColumnStatistics statistics_of(std::span<const double> values) {
  const auto [low, high] = std::ranges::minmax(values);
  ColumnStatistics result{.low = low, .high = high, .longest_rest = 1};
  std::size_t repeats = 0;
  std::size_t run = 1;
  for (std::size_t k = 1; k < values.size(); ++k) {
    const bool same = values[k] == values[k - 1];
    repeats += same ? 1 : 0;
    run = same ? run + 1 : 1;
    result.longest_rest = std::max(result.longest_rest, run);
  }
  if (values.size() > 1) {
    result.repeats = static_cast<double>(repeats) / static_cast<double>(values.size() - 1);
  }
  std::vector<double> sorted(values.begin(), values.end());
  std::ranges::sort(sorted);
  // Two printed numbers that differ by rounding alone are one value.
  const double rounding = 4.0 * std::numeric_limits<double>::epsilon() * std::max(std::abs(low), std::abs(high));
  for (std::size_t k = 1; k < sorted.size(); ++k) {
    const double step = sorted[k] - sorted[k - 1];
    if (step > rounding && (result.resolution == 0.0 || step < result.resolution)) {
      result.resolution = step;
    }
  }
  return result;
}

double jitter_of(const Record& record) {
  return 0.5 * deviations_from_grid(record.time(), record.sample_time()).span();
}

}  // namespace hysteron::records
