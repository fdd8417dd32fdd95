// The wall-clock time of a cycle, for threads beside the task: the task counts periods and asks no wall clock.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <utility>

namespace hysteron::runtime {

/// In nanoseconds; and the periods of the task that have passed by now.
struct BesideClocks {
  std::function<std::int64_t()> utc{};
  std::function<std::int64_t()> steady{};
  std::function<std::uint64_t()> elapsed{};
};

class TaskTime {
 public:
  /// On a virtual clock, times are those that it says, from now on.
  TaskTime(BesideClocks clocks, std::int64_t period, bool is_virtual)
      : clocks_(std::move(clocks)),
        period_(period),
        is_virtual_(is_virtual),
        start_(clocks_.steady()),
        offset_(clocks_.utc() - start_) {}

  /// To be called as time goes by. Gives the seconds by which the wall clock was set since the last call; below half a
  /// second, it is a clock that is brought to the right time by and by: 0.
  double look() {
    if (is_virtual_) {
      return 0.0;
    }
    const std::int64_t now = clocks_.steady();
    const std::uint64_t elapsed = clocks_.elapsed();
    // What was published may be old by the time it is seen, and is never newer: the earliest start is the true one.
    const std::int64_t seen = now - static_cast<std::int64_t>(elapsed) * period_;
    start_ = is_anchored_ ? std::min(start_, seen) : seen;
    is_anchored_ = elapsed > 0;
    const std::int64_t step = clocks_.utc() - now - offset_;
    offset_ += step;
    const double seconds = static_cast<double>(step) * 1e-9;
    return std::abs(seconds) > 0.5 ? seconds : 0.0;
  }
  [[nodiscard]] std::int64_t steady() const { return clocks_.steady(); }
  [[nodiscard]] std::int64_t now_ms() const { return (clocks_.steady() + offset_) / 1'000'000; }
  [[nodiscard]] std::int64_t utc_ms(std::uint64_t elapsed) const {
    return (start_ + static_cast<std::int64_t>(elapsed) * period_ + offset_) / 1'000'000;
  }

 private:
  BesideClocks clocks_;
  std::int64_t period_;
  bool is_virtual_;
  std::int64_t start_;        ///< of the task, on the steady clock
  std::int64_t offset_;       ///< of UTC from the steady clock
  bool is_anchored_ = false;  ///< the task has been seen to run
};

}  // namespace hysteron::runtime
