// The watchdog of a task: a time and a sensitivity, as in CODESYS.
//
// It trips when the cycle takes longer than the time in so many cycles in a row as the sensitivity says, or when a
// single cycle has taken longer than time × sensitivity. The second is what a hang is, and is seen from outside: the
// task itself is in the step and cannot look.
#pragma once

#include <algorithm>
#include <cstdint>

namespace hysteron::runtime {

struct WatchdogSettings {
  std::int64_t time = 0;  ///< in nanoseconds; 0: off
  std::uint32_t sensitivity = 1;

  /// A single cycle longer than this is a hang; 0: off.
  [[nodiscard]] constexpr std::int64_t longest() const noexcept {
    return time * std::max<std::int64_t>(1, static_cast<std::int64_t>(sensitivity));
  }
};

class Watchdog {
 public:
  explicit constexpr Watchdog(WatchdogSettings settings) noexcept : settings_(settings) {}

  /// After each cycle: whether it trips.
  constexpr bool finished(std::int64_t duration) noexcept {
    if (settings_.time <= 0) {
      return false;
    }
    in_a_row_ = duration > settings_.time ? in_a_row_ + 1 : 0;
    return in_a_row_ >= std::max(1U, settings_.sensitivity) || duration > settings_.longest();
  }

 private:
  WatchdogSettings settings_;
  std::uint32_t in_a_row_ = 0;
};

}  // namespace hysteron::runtime
