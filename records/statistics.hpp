// What the numbers of a record say of the sensors behind it.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "records/record.hpp"

namespace hysteron::records {

struct ColumnStatistics {
  double low = 0.0;
  double high = 0.0;
  double resolution = 0.0;       ///< the smallest step between two values that occur; 0 of a constant
  double repeats = 0.0;          ///< the share of rows with exactly the value of the row before
  std::size_t longest_rest = 0;  ///< rows in the longest run of one value
};

/// Of at least one value.
[[nodiscard]] ColumnStatistics statistics_of(std::span<const double> values);

/// A number that loggers write for "no value", -9999 say, or a thousandfold of all others: how often it stands and
/// where.
struct MarkOfMissing {
  double value = 0.0;
  std::size_t rows = 0;
  std::size_t first = 0;  ///< from 0 on
  double low = 0.0;       ///< of the other numbers
  double high = 0.0;
};

/// Nothing where all numbers may have been measured: such a number lies far outside of the others' range.
[[nodiscard]] std::optional<MarkOfMissing> mark_of_missing(std::span<const double> values);

/// How far y lies apart while u rises and while it falls, at the same u: the mean over u, as a share of the range of y.
/// 0 of a function of u; a hysteresis, a play or a lag opens a loop. 0 where u does not go both ways.
[[nodiscard]] double loop_width(std::span<const double> u, std::span<const double> y);

/// s: how far the times of a record lie from its even grid, at most.
[[nodiscard]] double jitter_of(const Record& record);

}  // namespace hysteron::records
