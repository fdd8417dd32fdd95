// An axis of a plot: what it reaches over, and the round numbers along it.
#pragma once

#include <limits>
#include <span>
#include <string>
#include <vector>

namespace hysteron::plots {

/// From the least to the largest finite value that was taken; empty where none was.
struct Reach {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  void take(double value);
  void take(std::span<const double> values);
  [[nodiscard]] bool is_empty() const { return !(low <= high); }
  /// With room at both ends, as a share of its length. Of a single value, some room about it; of none, 0 to 1.
  [[nodiscard]] Reach with_room(double share) const;
};

/// Round numbers within a reach: multiples of 1, 2 or 5 times a power of ten, at most so many or one more; but two at
/// least where finer ones give them, as one alone shows no scale.
[[nodiscard]] std::vector<double> round_numbers(const Reach& reach, int most);

/// The number of a tick, with as many digits as tell it from its neighbour at that step.
[[nodiscard]] std::string tick_text(double value, double step);

}  // namespace hysteron::plots
