// The even grid behind recorded times that were rounded when they were printed.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string_view>

namespace hysteron::records {

/// How finely times were printed. Trailing zeros that were printed count, those that were left out do not: so the
/// finest of all the texts is taken.
class PrintedResolution {
 public:
  /// Takes in the text of one time, which must be a number with a point: 0.0001563, 1e-3, 12.
  void take(std::string_view number);

  /// What one unit in the last printed digit is worth for a time of this size: 1e-7 for 0.0001563. It is the larger
  /// of the finest decimal and, for times printed to a number of significant digits, the last of those.
  [[nodiscard]] double quantum(double time) const;

  /// For times that were multiplied after they were read: minutes as seconds.
  void scale(double factor) { scale_ *= factor; }

 private:
  double scale_ = 1.0;
  int finest_exponent_ = 300;  ///< of ten, of the last digit
  int significant_digits_ = 0;
};

/// s: the step in the middle of all, in size.
[[nodiscard]] double median_step(std::span<const double> time);

/// The number of fewest digits within `radius` of a sample time, as seconds or as rows per second.
[[nodiscard]] double plainest_near(double sample_time, double radius);

/// s: the least and the largest of t_k − t_0 − k·TS.
struct Deviations {
  double low = 0.0;
  double high = 0.0;
  [[nodiscard]] double span() const { return high - low; }
};
[[nodiscard]] Deviations deviations_from_grid(std::span<const double> time, double sample_time);

struct TimeFault {
  std::size_t row = 0;    ///< the row at which it shows, never the first
  double step = 0.0;      ///< from the row before, s
  double usual = 0.0;     ///< the median step, s
  double off = 0.0;       ///< from the even grid, s, where no step stands out; else 0
  bool reversed = false;  ///< the step is zero or negative
  bool coarse = false;    ///< a single printed digit is worth more than a tenth of the sample time
};

struct TimeGrid {
  double sample_time = 0.0;  ///< s
  std::optional<TimeFault> fault{};
};

/// Finds the sample time of two or more finite times.
///
/// The times are t_k = t_0 + k·TS + e_k, where e_k is what printing took away. TS is the least-squares slope; where
/// a number with few digits (of seconds, or of rows per second) lies within what the printed digits leave open, that
/// is taken: times printed as 0.0001563, 0.0003125 … give exactly 1/6400 s.
///
/// A fault is: a step that is zero or negative; a step outside TS/2 … 3·TS/2, which is a missing or an extra row; or
/// deviations from the grid that span more than one and a quarter units of the last printed digit plus 2 % of TS.
/// The digits are taken as exact where all steps are equal, and where the last one is worth more than TS/10 and nine
/// steps in ten are equal: or a missing row could hide behind the rounding.
[[nodiscard]] TimeGrid find_time_grid(std::span<const double> time, const PrintedResolution& resolution);

}  // namespace hysteron::records
