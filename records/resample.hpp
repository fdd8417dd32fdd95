// Signals at uneven times, or at another rate, brought to an even sample time.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "records/read_options.hpp"

namespace hysteron::records {

/// What resampling did to a record.
struct ResamplingCost {
  std::size_t rows = 0;
  std::size_t made_up = 0;  ///< rows in gaps of more than one and a half steps of the record
  double farthest = 0.0;    ///< s: the largest distance from a row to the sample, or the nearer of two, it is made of
  double delay = 0.0;       ///< s: by which a signal is late in the mean
};

/// The times first, first + TS, … up to the last that is not behind `last`.
[[nodiscard]] std::vector<double> even_times(double first, double last, double sample_time);

/// Values at the times `at`, which rise and lie within the times of the samples, which rise too. The cost of the most
/// is kept in `cost`.
[[nodiscard]] std::vector<double> resampled(std::span<const double> time, std::span<const double> values,
                                            std::span<const double> at, Resampling way, ResamplingCost& cost);

/// `linear`, `hold`, `average`; `none`.
[[nodiscard]] std::string_view name_of(Resampling way);

/// The way of a name, without regard to case; nothing where it is none.
[[nodiscard]] std::optional<Resampling> resampling_of(std::string_view name);

}  // namespace hysteron::records
