// The loop of a cyclic task: wakes at whole periods of a clock, runs one cycle, and accounts for every period.
//
// Cycle k is due at first + k · period, whatever happened before. A period that has passed whole before its cycle could
// start is missed. What then: skip (the default) drops it and runs the newest; catch up runs up to so many of them at
// once, one after the other, and drops the rest; stop ends the task.
#pragma once

#include <atomic>
#include <cstdint>
#include <string_view>

#include "runtime/task/clock.hpp"
#include "runtime/task/lateness.hpp"

namespace hysteron::runtime {

enum class MissedPolicy : std::uint8_t { skip, catch_up, stop };

struct LoopSettings {
  std::int64_t period = 1'000'000;
  MissedPolicy policy = MissedPolicy::skip;
  std::uint64_t catch_up = 3;        ///< cycles that may be run at once
  std::int64_t tolerance = 100'000;  ///< a start later than this is late
  std::uint64_t cycles = 0;          ///< ends after so many; 0: does not end by itself
};

/// The place of a cycle among all.
struct CycleMoment {
  std::uint64_t number = 0;   ///< of cycles that were run, from 0
  std::uint64_t period = 0;   ///< of periods that have passed, from 0
  std::uint64_t skipped = 0;  ///< just before this cycle
  std::int64_t due = 0;
  std::int64_t start = 0;
};

class CycleBody {
 public:
  CycleBody() = default;
  CycleBody(const CycleBody&) = delete;
  CycleBody& operator=(const CycleBody&) = delete;
  virtual ~CycleBody() = default;

  /// One cycle. False ends the loop.
  virtual bool cycle(const CycleMoment& moment) noexcept = 0;
  /// After each cycle, with what is known of its time. False ends the loop.
  virtual bool finished(const LoopStatistics& statistics, std::int64_t duration, Verdict verdict) noexcept = 0;
};

enum class LoopEnd : std::uint8_t {
  stopped,         ///< it was asked to
  done,            ///< the number of cycles was reached
  body,            ///< the body ended it
  missed,          ///< a period was missed, and the policy is stop
  account_broken,  ///< run + skipped is not what the clock says
};
[[nodiscard]] std::string_view name_of(LoopEnd end);

/// Runs the loop in the calling thread. The first cycle is due one period after the call.
LoopEnd run_loop(const LoopSettings& settings, Clock& clock, CycleBody& body, const std::atomic<bool>& stop,
                 LoopStatistics& statistics) noexcept;

}  // namespace hysteron::runtime
