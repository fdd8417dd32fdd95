// The median and other quantiles, and the standard deviation by them.
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace hysteron {

/// The value that this share of them, below 1, goes before, the higher one of two; 0 where there is none.
[[nodiscard]] inline double quantile(std::vector<double> values, double share) {
  if (values.empty()) {
    return 0.0;
  }
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size()));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

/// The value in the middle.
[[nodiscard]] inline double median(std::vector<double> values) {
  return quantile(std::move(values), 0.5);
}

/// The standard deviation of a normal distribution over the median of its absolute values: outliers hardly count.
inline constexpr double deviation_of_median = 1.4826;

}  // namespace hysteron
