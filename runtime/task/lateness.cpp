#include "runtime/task/lateness.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

namespace hysteron::runtime {

std::string_view name_of(Cause cause) {
  constexpr std::array<std::string_view, cause_count> names{"on time", "late wake", "own CPU", "pre-empted",
                                                            "host steal"};
  return names[static_cast<std::size_t>(cause)];
}

Verdict verdict_of(const CycleTimes& times, std::int64_t period, std::int64_t tolerance) noexcept {
  if (times.cpu > period) {
    return {.cause = Cause::own_cpu};
  }
  if (times.start - times.due > tolerance) {
    const std::int64_t carried = std::max<std::int64_t>(0, times.previous_end - times.due);
    const std::int64_t wake = times.start - std::max(times.due, times.previous_end);
    if (carried >= wake && times.previous != Cause::on_time) {
      return {.cause = times.previous, .carried = true};
    }
    return {.cause = times.steal >= wake / 2 && times.steal > 0 ? Cause::host_steal : Cause::late_wake};
  }
  if (times.end - times.due <= period) {
    return {};
  }
  const std::int64_t waiting = std::max<std::int64_t>(0, times.end - times.start - times.cpu);
  if (times.cpu >= waiting) {
    return {.cause = Cause::own_cpu};
  }
  return {.cause = times.steal >= waiting / 2 ? Cause::host_steal : Cause::preempted};
}

std::size_t Histogram::class_of(std::uint64_t value) noexcept {
  if (value < divisions) {
    return static_cast<std::size_t>(value);
  }
  const auto octave = static_cast<std::size_t>(std::bit_width(value)) - 6;  // 32 to 63 is the first
  return std::min(classes - 1, (octave + 1) * divisions + static_cast<std::size_t>(value >> octave) - divisions);
}

std::uint64_t Histogram::upper_edge(std::size_t number) noexcept {
  if (number < divisions) {
    return number;
  }
  const std::size_t octave = number / divisions - 1;
  return ((static_cast<std::uint64_t>(number % divisions + divisions) + 1) << octave) - 1;
}

void Histogram::add(std::int64_t value, std::uint64_t cycle) noexcept {
  const std::int64_t counted = std::max<std::int64_t>(0, value);
  ++counts_[class_of(static_cast<std::uint64_t>(counted))];
  ++count_;
  if (counted > worst_ || count_ == 1) {
    worst_ = counted;
    worst_cycle_ = cycle;
  }
}

std::int64_t Histogram::percentile(double fraction) const noexcept {
  const auto wanted = static_cast<std::uint64_t>(std::ceil(fraction * static_cast<double>(count_)));
  std::uint64_t seen = 0;
  for (std::size_t i = 0; i < classes; ++i) {
    seen += counts_[i];
    if (seen >= wanted && seen > 0) {
      return std::min(worst_, static_cast<std::int64_t>(upper_edge(i)));
    }
  }
  return 0;
}

std::uint64_t LoopStatistics::late_events() const noexcept {
  return std::accumulate(events.begin() + 1, events.end(), std::uint64_t{0});
}

}  // namespace hysteron::runtime
