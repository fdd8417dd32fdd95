// How much of its time a cyclic thread computes, and how many of its periods pass without a cycle: over stretches of a
// second, or of ten periods where those take longer. A load near 1 leaves no time for anything that comes late.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "runtime/task/exchange.hpp"
#include "runtime/task/lateness.hpp"

namespace hysteron::runtime {

/// Of one stretch.
struct LoadReport {
  std::uint64_t stretch = 0;  ///< its number, from 1; 0 before the first is over
  double load = 0.0;          ///< own processor time over time, 0 to 1
  std::uint64_t periods = 0;
  std::uint64_t skipped = 0;  ///< of them, those that passed without a cycle
};

class LoadWatch {
 public:
  /// `most`: the load above which it is too much.
  LoadWatch(std::int64_t period, double most)
      : period_(period), periods_(std::max<std::int64_t>(10, (second + period - 1) / period)), most_(most) {}

  /// From the cyclic thread, after each cycle. Allocates nothing and takes no lock.
  void finished(const LoopStatistics& statistics) noexcept {
    const std::uint64_t periods = statistics.elapsed - begin_.elapsed;
    if (periods < static_cast<std::uint64_t>(periods_)) {
      return;
    }
    const double time = static_cast<double>(periods) * static_cast<double>(period_);
    newest_ = {.stretch = newest_.stretch + 1,
               .load = std::clamp(static_cast<double>(statistics.cpu - begin_.cpu) / time, 0.0, 1.0),
               .periods = periods,
               .skipped = statistics.skipped - begin_.skipped};
    begin_ = {.elapsed = statistics.elapsed, .skipped = statistics.skipped, .cpu = statistics.cpu};
    told_.publish(newest_.stretch,
                  std::array{newest_.load, static_cast<double>(newest_.periods), static_cast<double>(newest_.skipped)});
  }
  /// For the cyclic thread.
  [[nodiscard]] double load() const noexcept { return newest_.load; }
  [[nodiscard]] bool is_too_much() const noexcept { return newest_.load > most_; }
  /// From any thread.
  [[nodiscard]] LoadReport report() const noexcept {
    LoadReport report;
    std::array<double, 3> told{};
    if (told_.read(report.stretch, told)) {
      report.load = told[0];
      report.periods = static_cast<std::uint64_t>(told[1]);
      report.skipped = static_cast<std::uint64_t>(told[2]);
    }
    return report;
  }

 private:
  static constexpr std::int64_t second = 1'000'000'000;
  struct Begin {
    std::uint64_t elapsed = 0;
    std::uint64_t skipped = 0;
    std::int64_t cpu = 0;
  };

  std::int64_t period_;
  std::int64_t periods_;  ///< of a stretch, at the least
  double most_;
  Begin begin_{};
  LoadReport newest_{};
  SnapshotRing told_{3};
};

}  // namespace hysteron::runtime
