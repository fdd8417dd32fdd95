#include "records/statistics.hpp"

#include <algorithm>
#include <array>
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

double loop_width(std::span<const double> u, std::span<const double> y) {
  constexpr std::size_t bins = 40;
  constexpr double least_samples = 3.0;
  const std::size_t count = std::min(u.size(), y.size());
  if (count < 2) {
    return 0.0;
  }
  const auto [u_low, u_high] = std::minmax_element(u.begin(), u.begin() + static_cast<std::ptrdiff_t>(count));
  const auto [y_low, y_high] = std::minmax_element(y.begin(), y.begin() + static_cast<std::ptrdiff_t>(count));
  if (!(*u_high > *u_low) || !(*y_high > *y_low)) {
    return 0.0;
  }
  struct Branch {
    double sum = 0.0;
    double samples = 0.0;
  };
  std::array<std::array<Branch, 2>, bins> branches{};
  for (std::size_t k = 1; k < count; ++k) {
    if (!std::isfinite(u[k] + u[k - 1] + y[k]) || u[k] == u[k - 1]) {
      continue;
    }
    const double share = (u[k] - *u_low) / (*u_high - *u_low);
    Branch& branch = branches[std::min(bins - 1, static_cast<std::size_t>(share * bins))][u[k] > u[k - 1] ? 1 : 0];
    branch.sum += y[k];
    branch.samples += 1.0;
  }
  double apart = 0.0;
  double used = 0.0;
  for (const auto& [falling, rising] : branches) {
    if (falling.samples >= least_samples && rising.samples >= least_samples) {
      apart += std::abs(rising.sum / rising.samples - falling.sum / falling.samples);
      used += 1.0;
    }
  }
  return used > 0.0 ? apart / used / (*y_high - *y_low) : 0.0;
}

double jitter_of(const Record& record) {
  return 0.5 * deviations_from_grid(record.time(), record.sample_time()).span();
}

}  // namespace hysteron::records
