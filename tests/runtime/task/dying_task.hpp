// A task in a process of its own that goes wrong in one of many ways, with a guard, and a device that both can write.
#pragma once

#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cmath>
#include <csignal>
#include <ctime>
#include <limits>
#include <new>
#include <string_view>

#include "runtime/task/clock.hpp"
#include "runtime/task/guard.hpp"

namespace hysteron::runtime::test {

enum class Mishap { hang, not_finite, segmentation_fault, killed, stopped };
inline constexpr std::array<std::string_view, 5> mishap_names{"hang", "NaN", "SIGSEGV", "SIGKILL", "SIGSTOP"};

/// What both processes and the test see.
struct SharedDevice {
  std::atomic<double> output{0.0};
  std::atomic<std::int64_t> written{0};
  std::atomic<std::int64_t> mishap_at{0};
  std::atomic<std::int64_t> safe_at{0};  ///< the first write of the safe value after the mishap
  std::atomic<pid_t> writer{0};
};

inline constexpr double working_value = 4.0;
inline constexpr double safe_value = -1.0;

class SharedDeviceWriter final : public OutputDevice {
 public:
  explicit SharedDeviceWriter(SharedDevice& device) : device_(&device) {}
  void open() override {}
  bool write(std::span<const double> values) override {
    device_->writer.store(getpid());
    device_->output.store(values[0]);
    if (values[0] == safe_value && device_->mishap_at.load() != 0 && device_->safe_at.load() == 0) {
      device_->safe_at.store(monotonic_now());
    }
    ++device_->written;
    return true;
  }

 private:
  SharedDevice* device_;
};

/// Runs to the mishap and beyond, in the child.
[[noreturn]] inline void live_until(Mishap mishap, SharedDevice& device) {
  SharedDeviceWriter writer(device);
  SafeOutputs outputs({{.low = -10.0, .high = 10.0, .hold_cycles = 2, .value = safe_value}}, 0.001);
  Guard guard({.watchdog = {.time = 5'000'000, .sensitivity = 2}, .silence = 20'000'000}, outputs, writer);
  std::int64_t due = monotonic_now();
  for (int cycle = 0;; ++cycle) {
    due += 1'000'000;
    const timespec until{.tv_sec = due / 1'000'000'000, .tv_nsec = due % 1'000'000'000};
    (void)clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr);
    guard.cycle_begins(monotonic_now());
    double wanted = working_value;
    if (cycle == 20) {
      device.mishap_at.store(monotonic_now());
      switch (mishap) {
        case Mishap::hang:
          for (volatile bool for_ever = true; for_ever;) {
          }
          break;
        case Mishap::segmentation_fault:
          (void)std::signal(SIGSEGV, SIG_DFL);
          (void)raise(SIGSEGV);
          break;
        case Mishap::killed:
          (void)raise(SIGKILL);
          break;
        case Mishap::stopped:
          (void)raise(SIGSTOP);
          break;
        case Mishap::not_finite:
          break;
      }
    }
    if (cycle >= 20 && mishap == Mishap::not_finite) {
      wanted = std::numeric_limits<double>::quiet_NaN();
    }
    outputs.step(std::array{wanted}, Fault::none);
    guard.cycle_ends(outputs.values());
    if (guard.may_write()) {
      (void)writer.write(outputs.values());
    }
  }
}

/// The nanoseconds from a mishap to the safe output; negative where it never came. `longest` is how long it waits.
inline std::int64_t time_to_safety(Mishap mishap, std::int64_t longest = 5'000'000'000) {
  void* const memory = mmap(nullptr, sizeof(SharedDevice), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  auto& device = *new (memory) SharedDevice;
  const pid_t task = fork();
  if (task == 0) {
    live_until(mishap, device);
  }
  const std::int64_t give_up = monotonic_now() + longest;
  while (device.safe_at.load() == 0 && monotonic_now() < give_up) {
    const timespec pause{.tv_sec = 0, .tv_nsec = 500'000};
    (void)nanosleep(&pause, nullptr);
  }
  std::int64_t result = device.safe_at.load() == 0 ? -1 : device.safe_at.load() - device.mishap_at.load();
  if (mishap == Mishap::stopped && result >= 0) {
    // Awake again, the task must not write over what the guard holds.
    (void)kill(task, SIGCONT);
    const std::int64_t written = device.written.load();
    while (device.written.load() < written + 20 && monotonic_now() < give_up) {
      const timespec pause{.tv_sec = 0, .tv_nsec = 500'000};
      (void)nanosleep(&pause, nullptr);
    }
    if (device.output.load() != safe_value || device.writer.load() == task) {
      result = -2;
    }
  }
  (void)kill(task, SIGKILL);
  (void)waitpid(task, nullptr, 0);
  if (device.output.load() != safe_value) {
    result = -3;
  }
  return result;
}

}  // namespace hysteron::runtime::test
