// A task on a clock that knows what its steps compute.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <utility>

#include "runtime/task/task.hpp"
#include "tests/runtime/task/accumulator.hpp"

namespace hysteron::runtime::test {

inline constexpr std::int64_t loaded_period = 1'000'000;

/// Only what a step takes is computed; sleep is not.
class WorkClock final : public Clock {
 public:
  std::int64_t now() noexcept override { return now_; }
  void sleep_until(std::int64_t time) noexcept override { now_ = std::max(now_, time); }
  std::int64_t own_cpu() noexcept override { return cpu_; }
  std::int64_t stolen() noexcept override { return 0; }
  void work(std::int64_t nanoseconds) {
    now_ += nanoseconds;
    cpu_ += nanoseconds;
  }

 private:
  std::int64_t now_ = 0;
  std::int64_t cpu_ = 0;
};

/// A task whose steps take so long, one after the other.
struct Loaded {
  explicit Loaded(std::function<std::int64_t(std::uint64_t step)> cost, TaskSettings settings = {}) {
    settings.inputs = {{}};
    settings.outputs = {{.low = -50.0, .high = 50.0, .value = -1.0}, {}};
    program.during_step = [this, cost = std::move(cost)](std::span<double>) { clock.work(cost(steps++)); };
    task.emplace(program, settings);
  }
  Accumulator program{loaded_period};
  WorkClock clock{};
  std::uint64_t steps = 0;
  std::optional<Task> task{};

  void run() {
    const std::atomic<bool> stop{false};
    (void)task->run(clock, stop);
  }
};

}  // namespace hysteron::runtime::test
