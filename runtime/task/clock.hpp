// The clocks that a cyclic task can run on. All times are nanoseconds.
//
// The loop asks a clock for four things and the system for none, so that the same loop runs in real time, as fast as it
// can, and under a script that a test wrote.
#pragma once

#include <atomic>
#include <cstdint>
#include <thread>

namespace hysteron::runtime {

class Clock {
 public:
  Clock() = default;
  Clock(const Clock&) = delete;
  Clock& operator=(const Clock&) = delete;
  virtual ~Clock() = default;

  [[nodiscard]] virtual std::int64_t now() noexcept = 0;
  /// Returns at once where the time has passed.
  virtual void sleep_until(std::int64_t time) noexcept = 0;
  /// What the calling thread has computed so far.
  [[nodiscard]] virtual std::int64_t own_cpu() noexcept = 0;
  /// What a hypervisor has taken from this machine so far; a machine of its own has nothing taken.
  [[nodiscard]] virtual std::int64_t stolen() noexcept = 0;
};

/// CLOCK_MONOTONIC, slept on by absolute times, so that a late wake-up does not shift those after it.
class MonotonicClock final : public Clock {
 public:
  /// Begins to read the stolen time in a thread of its own: reading it is a system call, which the task does not make.
  MonotonicClock();
  ~MonotonicClock() override;
  MonotonicClock(const MonotonicClock&) = delete;
  MonotonicClock& operator=(const MonotonicClock&) = delete;
  [[nodiscard]] std::int64_t now() noexcept override;
  void sleep_until(std::int64_t time) noexcept override;
  [[nodiscard]] std::int64_t own_cpu() noexcept override;
  [[nodiscard]] std::int64_t stolen() noexcept override { return stolen_.load(std::memory_order_relaxed); }

 private:
  std::atomic<std::int64_t> stolen_{0};
  std::atomic<bool> stop_{false};
  std::thread reader_;
};

/// Time passes by sleeping alone: a run takes as long as its steps, and no cycle is ever late.
class VirtualClock final : public Clock {
 public:
  [[nodiscard]] std::int64_t now() noexcept override { return now_; }
  void sleep_until(std::int64_t time) noexcept override { now_ = time > now_ ? time : now_; }
  [[nodiscard]] std::int64_t own_cpu() noexcept override { return 0; }
  [[nodiscard]] std::int64_t stolen() noexcept override { return 0; }

 private:
  std::int64_t now_ = 0;
};

/// CLOCK_MONOTONIC now.
[[nodiscard]] std::int64_t monotonic_now() noexcept;

/// What the calling thread has computed so far: what others compute meanwhile does not count.
[[nodiscard]] std::int64_t own_cpu_now() noexcept;

/// The stolen time in a text like /proc/stat's, in nanoseconds: of all processors together. 0 where it says nothing.
[[nodiscard]] std::int64_t stolen_time(const char* text, long ticks_a_second);

}  // namespace hysteron::runtime
