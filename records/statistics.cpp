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

std::optional<MarkOfMissing> mark_of_missing(std::span<const double> values) {
  // Of Campbell, GIS and weather loggers, of Java and C, of registers of 16 and 32 bits without a value, of netCDF.
  constexpr auto marks =
      std::to_array({999.0, 6999.0, 7999.0, 8999.0, 9999.0, 99999.0, 999999.0, 9999999.0, 999.9, 9999.9, 999.99,
                     32767.0, 32768.0, 65535.0, 2147483647.0, 2147483648.0, 4294967295.0});
  constexpr double beyond_sensors = 1e30;
  MarkOfMissing result{.low = std::numeric_limits<double>::infinity(),
                       .high = -std::numeric_limits<double>::infinity()};
  const auto is_mark = [&](double value) {
    return std::abs(value) > beyond_sensors || std::ranges::find(marks, std::abs(value)) != marks.end();
  };
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (is_mark(values[k])) {
      result.first = result.rows == 0 ? k : result.first;
      result.value = result.rows == 0 ? values[k] : result.value;
      ++result.rows;
    } else {
      result.low = std::min(result.low, values[k]);
      result.high = std::max(result.high, values[k]);
    }
  }
  constexpr double far = 2.0;  // ranges of the others
  const double range = result.high - result.low;
  const double away = std::max(result.low - result.value, result.value - result.high);
  return result.rows > 0 && 2 * result.rows < values.size() && away > far * range ? std::optional(result)
                                                                                  : std::nullopt;
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
