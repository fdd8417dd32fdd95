#include "runtime/task/clock.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <ctime>

namespace hysteron::runtime {
namespace {

constexpr std::int64_t second = 1'000'000'000;

std::int64_t read_clock(clockid_t clock) noexcept {
  timespec time{};
  (void)clock_gettime(clock, &time);
  return static_cast<std::int64_t>(time.tv_sec) * second + time.tv_nsec;
}

std::int64_t stolen_now() {
  std::array<char, 256> text{};
  const int file = open("/proc/stat", O_RDONLY | O_CLOEXEC);
  if (file < 0) {
    return 0;
  }
  const auto size = read(file, text.data(), text.size() - 1);
  (void)close(file);
  return size > 0 ? stolen_time(text.data(), sysconf(_SC_CLK_TCK)) : 0;
}

}  // namespace

std::int64_t monotonic_now() noexcept {
  return read_clock(CLOCK_MONOTONIC);
}

std::int64_t own_cpu_now() noexcept {
  return read_clock(CLOCK_THREAD_CPUTIME_ID);
}

std::int64_t stolen_time(const char* text, long ticks_a_second) {
  // cpu user nice system idle iowait irq softirq steal
  unsigned long long steal = 0;
  const bool all = std::strncmp(text, "cpu ", 4) == 0;  // not cpu0, which is one of several
  const int found = !all ? 0 : std::sscanf(text, "cpu %*u %*u %*u %*u %*u %*u %*u %llu", &steal);
  return found == 1 && ticks_a_second > 0 ? static_cast<std::int64_t>(steal) * (second / ticks_a_second) : 0;
}

MonotonicClock::MonotonicClock() : stolen_(stolen_now()) {
  reader_ = std::thread([this] {
    while (!stop_.load(std::memory_order_relaxed)) {
      stolen_.store(stolen_now(), std::memory_order_relaxed);
      std::this_thread::sleep_for(std::chrono::milliseconds(10));  // the kernel counts in ticks of this length
    }
  });
}

MonotonicClock::~MonotonicClock() {
  stop_.store(true, std::memory_order_relaxed);
  reader_.join();
}

std::int64_t MonotonicClock::now() noexcept {
  return monotonic_now();
}

void MonotonicClock::sleep_until(std::int64_t time) noexcept {
  const timespec until{.tv_sec = static_cast<time_t>(time / second), .tv_nsec = static_cast<long>(time % second)};
  // Interrupted by a signal, it returns: the loop then looks whether it is to stop, and comes back.
  (void)clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr);
}

std::int64_t MonotonicClock::own_cpu() noexcept {
  return own_cpu_now();
}

}  // namespace hysteron::runtime
