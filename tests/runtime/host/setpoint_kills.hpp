// A task that is killed while a client writes a setpoint that is retained: what the next start begins with.
#pragma once

#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <csignal>
#include <ctime>
#include <deque>
#include <filesystem>
#include <optional>
#include <span>
#include <thread>

#include "runtime/host/retained_state.hpp"
#include "runtime/task/clock.hpp"
#include "runtime/task/task.hpp"
#include "tests/runtime/namespaces.hpp"
#include "tests/runtime/task/accumulator.hpp"

namespace hysteron::runtime::test {

struct SetpointKill {
  double confirmed = 0.0;  ///< the newest setpoint that was on the disk before the end
  double written = 0.0;    ///< the newest that the client wrote
  double begun_with = 0.0;
  [[nodiscard]] bool holds() const { return begun_with >= confirmed && begun_with <= written; }
};

/// What a start of the accumulator begins its input X with.
inline std::optional<double> setpoint_after_start(const std::filesystem::path& folder) {
  Accumulator program;
  const RetainedState state({.folder = folder.string()}, program, {0});
  return state.starts().at(0);
}

/// In a process of its own: in each cycle a client writes the next number, which counts from the cycle after. Says what
/// is on the disk for sure, and what was written.
[[noreturn]] inline void write_setpoints(const std::filesystem::path& folder, int told) {
  Accumulator program;
  RetainedState state({.folder = folder.string()}, program, {0});
  Retainer retainer(state.folder(), program, state.recovery(), {}, state.inputs());
  TaskSettings settings{.inputs = {{.is_retained = true, .start = state.starts().at(0)}}, .outputs = {{}, {}}};
  settings.retain_every = 1;
  Task task(program, settings, {.retainer = &retainer});
  struct Offered {
    std::uint64_t after = 0;  ///< so many writes
    double setpoint = 0.0;
  };
  std::deque<Offered> offered;
  const double first = settings.inputs[0].start.value_or(0.0);
  std::array<double, 2> pair{first, first};
  program.during_step = [&](std::span<double>) {
    // The step's own input is offered at its end. The write after the one that may be under way then has it.
    const std::uint64_t written = retainer.written();
    while (!offered.empty() && written >= offered.front().after + 2) {
      pair[0] = offered.front().setpoint;
      offered.pop_front();
    }
    offered.push_back({.after = written + 1, .setpoint = pair[1]});
    pair[1] += 1.0;
    const std::array<PointWrite, 1> writes{PointWrite{.point = 0, .value = pair[1]}};
    (void)task.door().write(writes);
    if (::write(told, pair.data(), sizeof pair) != static_cast<ssize_t>(sizeof pair)) {
      ::_exit(1);
    }
  };
  VirtualClock clock;
  const std::atomic<bool> stop{false};
  (void)task.run(clock, stop);
  ::_exit(0);
}

/// Killed so many nanoseconds after its first cycle.
inline SetpointKill kill_while_setpoints_come(const std::filesystem::path& folder, std::int64_t after) {
  std::array<int, 2> ends{};
  (void)::pipe(ends.data());
  const pid_t child = ::fork();
  if (child == 0) {
    write_setpoints(folder, ends[1]);
  }
  (void)::close(ends[1]);
  SetpointKill result;
  std::array<double, 2> pair{};
  const auto next = [&] {
    const bool read = ::read(ends[0], pair.data(), sizeof pair) == static_cast<ssize_t>(sizeof pair);
    result.confirmed = read ? pair[0] : result.confirmed;
    result.written = read ? pair[1] : result.written;
    return read;
  };
  (void)next();
  std::thread reader([&] {
    while (next()) {
    }
  });
  const timespec wait{.tv_sec = after / 1'000'000'000, .tv_nsec = after % 1'000'000'000};
  (void)::nanosleep(&wait, nullptr);
  (void)::kill(child, SIGKILL);
  (void)::waitpid(child, nullptr, 0);
  reader.join();
  (void)::close(ends[0]);
  result.begun_with = setpoint_after_start(folder).value_or(0.0);
  return result;
}

}  // namespace hysteron::runtime::test
