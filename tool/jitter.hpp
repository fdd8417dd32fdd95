// How late a cyclic thread wakes up on this machine: the same loop and scheduling as those of a task, with empty steps.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "runtime/task/clock.hpp"
#include "runtime/task/lateness.hpp"
#include "runtime/task/scheduling.hpp"

namespace hysteron::tool {

struct JitterRequest {
  std::int64_t period = 1'000'000;  ///< in nanoseconds
  std::uint64_t cycles = 10'000;
  runtime::SchedulingRequest scheduling{};
};

struct JitterClass {
  std::int64_t below = 0;  ///< in nanoseconds; of the last class, the worst
  std::uint64_t count = 0;
};

struct Jitter {
  std::string obtained{};  ///< the scheduling, as a task's status line says it
  std::uint64_t skipped = 0;
  runtime::Histogram lateness{};       ///< of the wake-ups, in nanoseconds
  std::vector<JitterClass> classes{};  ///< up to 1, 2, 5, 10, 20, 50 us and so on; none that is empty at the end
};

/// In a thread of its own, on this clock; takes as long as the cycles.
[[nodiscard]] Jitter measure_jitter(const JitterRequest& request, runtime::Clock& clock);

}  // namespace hysteron::tool
