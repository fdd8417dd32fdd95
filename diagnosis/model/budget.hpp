// The time that a search may take.
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>

namespace hysteron::diagnosis {

class Budget {
 public:
  /// From now on.
  explicit Budget(double seconds) : seconds_(seconds) {}

  /// Whether it is used up. What asks would go on otherwise, and does so from several threads.
  [[nodiscard]] bool is_over() {
    const bool over = std::chrono::duration<double>(Clock::now() - begun_).count() > seconds_;
    if (over) {
      has_cut_ = true;
    }
    return over;
  }

  /// What begins now has this share of the whole, if no more is left.
  void at_least(double share) {
    const std::chrono::duration<double> used((1.0 - share) * seconds_);
    begun_ = std::max(begun_, Clock::now() - std::chrono::duration_cast<Clock::duration>(used));
  }

  [[nodiscard]] double seconds() const { return seconds_; }  ///< the whole
  [[nodiscard]] bool has_cut() const { return has_cut_; }    ///< something was not done since it was over

 private:
  using Clock = std::chrono::steady_clock;
  double seconds_;
  Clock::time_point begun_ = Clock::now();
  std::atomic<bool> has_cut_ = false;
};

}  // namespace hysteron::diagnosis
