// What the system grants a cyclic thread: its scheduling class, locked memory, precise timers, a clean floating-point
// state. Each is asked for, and what was obtained is read back from the system and reported; without the rights a task
// still runs, and says so.
#pragma once

#include <cstdint>
#include <string>

namespace hysteron::runtime {

enum class Scheduling : std::uint8_t { other, fifo, deadline };

struct SchedulingRequest {
  Scheduling scheduling = Scheduling::fifo;
  int priority = 80;         ///< of fifo, 1 to 99
  std::int64_t period = 0;   ///< of deadline, in nanoseconds
  std::int64_t runtime = 0;  ///< of deadline: computing time that a period may take
  int processor = -1;        ///< pinned to it; -1: any. Deadline cannot be pinned
  bool lock_memory = true;
};

struct SchedulingObtained {
  Scheduling scheduling = Scheduling::other;
  int priority = 0;
  int processor = -1;
  bool memory_locked = false;
  std::int64_t timer_slack = 0;  ///< in nanoseconds; of no effect where the class is not other
  std::string refused{};         ///< what the system refused and why, empty where nothing was
};

/// For the calling thread.
[[nodiscard]] SchedulingObtained obtain_scheduling(const SchedulingRequest& request);

/// FIFO 80, memory locked
[[nodiscard]] std::string description_of(const SchedulingObtained& obtained);

/// Puts the calling thread's floating-point state to the default. Numbers below the smallest normal one are kept, not
/// flushed to zero: flushing would change bits between targets. A library built with fast-math may have set it so.
void default_floating_point() noexcept;

/// Touches the stack below the caller, so that no later call meets a page that is not there.
void touch_stack() noexcept;

}  // namespace hysteron::runtime
