// Whether a parameter of a machine changes from record to record by more than its intervals and the scatter explain.
#pragma once

#include <cstddef>
#include <vector>

#include "support/numbers.hpp"

namespace hysteron::fleet {

/// A value of each record, in the order of time.
struct Series {
  std::vector<double> time{};  ///< s since 1970
  std::vector<double> value{};
  std::vector<double> error{};  ///< standard deviation by the fit; not a number where it is not known
};

enum class Change {
  None,
  Ramp,  ///< constant, then a straight line
  Step   ///< constant, then another constant
};

struct Trend {
  double slope = not_a_number;   ///< of Theil and Sen, over all records, a second
  Change change = Change::None;  ///< the form that fits better; None where it cannot be asked
  double since = not_a_number;   ///< the last record before a ramp, the first one behind a step
  double from = not_a_number;    ///< fitted value before
  double to = not_a_number;      ///< fitted value at the last record
  double p = 1.0;                ///< of a change as large where nothing changes
};

/// Records at different times that a change is asked of: with one left out, three must still show it.
inline constexpr std::size_t least_records = 4;

/// How far records of one machine scatter where nothing changes, by those of all machines.
struct Scatter {
  double deviation = not_a_number;
  double freedom = 0.0;  ///< degrees of it
};

/// 1.4826 times the median distance from each machine's line of Theil and Sen, widened for the two numbers that each
/// line takes: √(n/(n − 2m)) of n values of m machines. Series of fewer than `least_records` say nothing.
[[nodiscard]] Scatter scatter_of(const std::vector<Series>& machines);

/// Tries a ramp from each record and a step at each record, by weighted least squares. A record's standard deviation is
/// the largest of its own, that of the fleet's scatter, and that of the machine about the form. The form with the
/// largest |t| is taken; its p is that of the least |t| with any one record left out, times the number of forms tried
/// (Bonferroni). So no single record makes a change.
[[nodiscard]] Trend trend_of(const Series& series, const Scatter& scatter);

}  // namespace hysteron::fleet
