// Time of a plant that passes as fast as the machine computes: what this program is linked into has no other.
//
// The functions of the C library that tell the time or wait for it are replaced for the whole process, the libraries of
// TLS and SQLite among it. So the host runs as it is: with its monotonic clock, its threads and its wall clock. Time
// passes where the cyclic thread waits for its next period, and nowhere else. Threads beside it that wait until a time
// are woken when that has come, and the cyclic thread waits until all of them wait again: what they do takes no time.
//
// To wake them at each of their times would cost more than the cycles. Away from what happens they are woken at whole
// quanta alone; in close-up, as they wished.
#pragma once

#include <cstdint>
#include <functional>

namespace hysteron::soak {

inline constexpr std::int64_t second = 1'000'000'000;  ///< in nanoseconds, as all times here

class SimulatedTime {
 public:
  /// What is done at each wake of the cyclic thread, in this thread: given when it wished to be woken, says when it is.
  using AtWake = std::function<std::int64_t(std::int64_t due)>;

  /// From now on, for this process and what it forks: the monotonic clock in nanoseconds, and UTC ahead of it.
  static void begin(std::int64_t now, std::int64_t utc_ahead);
  [[nodiscard]] static std::int64_t now() noexcept;
  /// Sets the wall clock.
  static void set_utc_ahead(std::int64_t nanoseconds) noexcept;
  [[nodiscard]] static std::int64_t utc() noexcept;
  /// From the cyclic thread: time that passes while it computes.
  static void compute(std::int64_t nanoseconds) noexcept;
  static void at_wake(AtWake action);
  /// Threads beside are woken at multiples of this; 0: when they wish.
  static void set_quantum(std::int64_t nanoseconds) noexcept;
  /// So many threads beside are to wait for a time before the first cycle.
  static void expect(int threads) noexcept;
  /// The cyclic thread is to end, which takes real time: from now on nobody waits for it.
  static void let_go() noexcept;
};

}  // namespace hysteron::soak
