// The median, and the standard deviation by it.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace hysteron {

/// The value in the middle, the higher one of two; 0 where there is none.
[[nodiscard]] inline double median(std::vector<double> values) {
  if (values.empty()) {
    return 0.0;
  }
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// The standard deviation of a normal distribution over the median of its absolute values: outliers hardly count.
inline constexpr double deviation_of_median = 1.4826;

}  // namespace hysteron
