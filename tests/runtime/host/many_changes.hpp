// Online changes there and back while another thread commits parameters: no set that was taken may be lost, whichever
// version it met.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <thread>
#include <vector>

#include "runtime/host/online_change.hpp"
#include "tests/runtime/task/accumulator.hpp"
#include "tests/runtime/task/integrators.hpp"

namespace hysteron::runtime::test {

struct ManyChanges {
  std::uint64_t changed = 0;
  std::uint64_t committed = 0;
  bool last_counts = false;  ///< the set that was taken last is that of the program at the end
  std::uint64_t version = 0;
  std::int64_t longest_cycle = 0;  ///< ns
};

/// In real time at a period of 1 ms.
inline ManyChanges change_many_times(std::uint64_t count) {
  const std::vector<Integrator> first{{"A", 0.001}, {"B", -0.001}};
  const std::vector<Integrator> second{{"B", 7.0}, {"NEW", 0.0}, {"A", 7.0}};
  ChangeableProgram program(integrators(first));
  Task task(program, {.inputs = {{}}, .outputs = {{}}}, {.changes = &program});
  OnlineChange change(program, task, {{.limit = {.most = 1e300}}});
  const auto write = [&](double gain) {
    const std::vector<PointWrite> set{{point(task.door(), "A.K"), gain},
                                      {point(task.door(), "B.K"), -gain},
                                      {point(task.door(), "task.commit"), 1.0}};
    return task.door().write(set).empty();
  };
  std::atomic<bool> stop{false};
  std::thread cyclic([&] {
    MonotonicClock clock;
    (void)task.run(clock, stop);
  });
  change.begin(nullptr, nullptr);
  ManyChanges result;
  std::atomic<bool> ends{false};
  double last = 0.0;
  std::thread client([&] {
    for (double gain = 1.0; !ends; gain = gain > 99.0 ? 1.0 : gain + 1.0) {
      if (write(gain)) {
        last = gain;
        ++result.committed;
      }
      std::this_thread::sleep_for(std::chrono::microseconds(200));
    }
  });
  for (std::uint64_t i = 0; i < count; ++i) {
    try {
      result.changed +=
          (i % 3 == 0 ? change.change_to(integrators(i % 2 == 0 ? second : first), {}) : change.change_back({})).is_done
              ? 1
              : 0;
    } catch (const InputError&) {
      // Counted by what is missing.
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  ends = true;
  client.join();
  // Two periods are enough; a busy machine has half a minute.
  const auto counts = [&] {
    return value(task.door(), "A.K") == last && value(task.door(), "B.K") == -last && result.committed > 0;
  };
  for (int i = 0; i < 30'000 && !counts(); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  result.last_counts = counts();
  stop = true;
  cyclic.join();
  result.version = program.version_number();
  result.longest_cycle = task.statistics().duration.worst();
  return result;
}

}  // namespace hysteron::runtime::test
