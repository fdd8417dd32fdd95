// √(Σx²/n) of numbers of any size: the squares of 1e200 and of 1e-200 are no doubles, and are not needed.
#pragma once

#include <cmath>
#include <cstddef>

namespace hysteron {

/// Σx² = largest²·sum, as in LAPACK's dlassq.
class RootMeanSquare {
 public:
  void add(double x) {
    const double size = std::abs(x);
    ++count_;
    if (size > largest_) {
      sum_ = 1.0 + sum_ * (largest_ / size) * (largest_ / size);
      largest_ = size;
    } else if (size > 0.0) {
      sum_ += (size / largest_) * (size / largest_);
    } else if (std::isnan(size)) {
      largest_ = size;
    }
  }

  [[nodiscard]] std::size_t count() const { return count_; }
  /// Not a number where there is none, or where one was none.
  [[nodiscard]] double value() const {
    return largest_ == 0.0 && count_ > 0 ? 0.0 : largest_ * std::sqrt(sum_ / static_cast<double>(count_));
  }

 private:
  double largest_ = 0.0;
  double sum_ = 0.0;
  std::size_t count_ = 0;
};

}  // namespace hysteron
