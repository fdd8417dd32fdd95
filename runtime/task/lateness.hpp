// How late a cycle was, and why.
//
// A cycle is late where it starts more than the tolerance after its time, or ends after its period. The cause is what
// took most of the delay:
//   late wake    the thread was not woken in time
//   own CPU      the cycle itself computed for too long
//   pre-empted   the thread had work and was not run
//   host steal   the hypervisor had taken the processor meanwhile, for at least half of the delay
// A cycle that is late only because the one before it was is carried: it has the same cause, and is no event of its
// own. One that itself computes for longer than a period is always its own: where a step is too long for its period,
// each of its cycles says so.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace hysteron::runtime {

enum class Cause : std::uint8_t { on_time, late_wake, own_cpu, preempted, host_steal };
inline constexpr std::size_t cause_count = 5;
[[nodiscard]] std::string_view name_of(Cause cause);

struct CycleTimes {
  std::int64_t due = 0;
  std::int64_t start = 0;
  std::int64_t end = 0;
  std::int64_t cpu = 0;           ///< computed by the thread between start and end
  std::int64_t steal = 0;         ///< stolen since the end of the cycle before
  std::int64_t previous_end = 0;  ///< of the cycle before
  Cause previous = Cause::on_time;
};

struct Verdict {
  Cause cause = Cause::on_time;
  bool carried = false;
};

[[nodiscard]] Verdict verdict_of(const CycleTimes& times, std::int64_t period, std::int64_t tolerance) noexcept;

/// Durations in classes that grow by 1/32 of an octave, so that a percentile is known to 3 %. Negative ones count as 0.
class Histogram {
 public:
  void add(std::int64_t value, std::uint64_t cycle) noexcept;
  [[nodiscard]] std::uint64_t count() const noexcept { return count_; }
  /// The upper edge of the class that holds the fraction; never above the worst. 0 where nothing was counted.
  [[nodiscard]] std::int64_t percentile(double fraction) const noexcept;
  [[nodiscard]] std::int64_t worst() const noexcept { return worst_; }
  [[nodiscard]] std::uint64_t worst_cycle() const noexcept { return worst_cycle_; }

 private:
  static constexpr std::size_t divisions = 32;
  static constexpr std::size_t classes = 60 * divisions;
  [[nodiscard]] static std::size_t class_of(std::uint64_t value) noexcept;
  [[nodiscard]] static std::uint64_t upper_edge(std::size_t number) noexcept;

  std::array<std::uint64_t, classes> counts_{};
  std::uint64_t count_ = 0;
  std::int64_t worst_ = 0;
  std::uint64_t worst_cycle_ = 0;
};

/// What a task says of its own time.
struct LoopStatistics {
  std::uint64_t run = 0;
  std::uint64_t skipped = 0;
  std::uint64_t elapsed = 0;  ///< periods by the clock since the first cycle, up to and with the newest
  std::array<std::uint64_t, cause_count> events{};  ///< by cause, each once
  std::uint64_t carried = 0;                        ///< cycles late by the one before
  std::int64_t cpu = 0;                             ///< ns that the thread has computed, in cycles and between them
  Histogram lateness{};                             ///< of the start
  Histogram duration{};                             ///< from start to end

  [[nodiscard]] std::uint64_t late_events() const noexcept;
};

}  // namespace hysteron::runtime
