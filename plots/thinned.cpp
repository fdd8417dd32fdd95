#include "plots/thinned.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace hysteron::plots {
namespace {

constexpr std::size_t most_of_a_group = 6;

void add_group(std::span<const double> x, std::span<const double> y, std::size_t begin, std::size_t end,
               std::vector<std::size_t>& rows) {
  const std::size_t at = rows.size();
  rows.push_back(begin);
  rows.push_back(end - 1);
  for (const std::span<const double> values : {x, y}) {
    std::size_t least = end;
    std::size_t largest = end;
    for (std::size_t k = begin; k < end; ++k) {
      if (!std::isfinite(x[k]) || !std::isfinite(y[k])) {
        continue;
      }
      least = least == end || values[k] < values[least] ? k : least;
      largest = largest == end || values[k] > values[largest] ? k : largest;
    }
    if (least != end) {
      rows.push_back(least);
      rows.push_back(largest);
    }
  }
  for (std::size_t k = begin; k < end; ++k) {
    if (!std::isfinite(x[k]) || !std::isfinite(y[k])) {
      rows.push_back(k);
      break;
    }
  }
  std::sort(rows.begin() + static_cast<std::ptrdiff_t>(at), rows.end());
  rows.erase(std::unique(rows.begin() + static_cast<std::ptrdiff_t>(at), rows.end()), rows.end());
}

}  // namespace

std::vector<std::size_t> thinned(std::span<const double> x, std::span<const double> y, std::size_t groups) {
  const std::size_t count = std::min(x.size(), y.size());
  groups = std::max<std::size_t>(groups, 1);
  std::vector<std::size_t> rows;
  if (count <= most_of_a_group * groups) {
    rows.resize(count);
    std::iota(rows.begin(), rows.end(), std::size_t{0});
    return rows;
  }
  rows.reserve(most_of_a_group * groups);
  for (std::size_t group = 0; group < groups; ++group) {
    add_group(x, y, count * group / groups, count * (group + 1) / groups, rows);
  }
  return rows;
}

bool changes_seldom(std::span<const double> values) {
  std::size_t changes = 0;
  for (std::size_t k = 1; k < values.size(); ++k) {
    changes += values[k] != values[k - 1] ? 1 : 0;
  }
  return changes > 0 && changes * 8 < values.size();
}

bool is_of_steps(std::span<const double> values) {
  const auto is_whole = [](double value) { return !std::isfinite(value) || value == std::floor(value); };
  const auto is_truth = [](double value) { return value == 0.0 || value == 1.0 || std::isnan(value); };
  return std::ranges::all_of(values, is_whole) && (std::ranges::all_of(values, is_truth) || changes_seldom(values));
}

}  // namespace hysteron::plots
