#include "runtime/task/cyclic_loop.hpp"

#include <array>

namespace hysteron::runtime {

std::string_view name_of(LoopEnd end) {
  constexpr std::array<std::string_view, 5> names{"stopped", "done", "stopped by a fault", "stopped by a missed cycle",
                                                  "stopped because periods were lost"};
  return names[static_cast<std::size_t>(end)];
}

LoopEnd run_loop(const LoopSettings& settings, Clock& clock, CycleBody& body, const std::atomic<bool>& stop,
                 LoopStatistics& statistics) noexcept {
  const std::int64_t first = clock.now() + settings.period;
  const std::uint64_t before = statistics.run + statistics.skipped;  // of an earlier run of the same task
  std::int64_t due = first;
  std::int64_t stolen = clock.stolen();
  const std::int64_t cpu_before = clock.own_cpu() - statistics.cpu;
  CycleTimes times{.previous_end = first - settings.period};
  for (;;) {
    clock.sleep_until(due);
    if (stop.load(std::memory_order_relaxed)) {
      return LoopEnd::stopped;
    }
    times.start = clock.now();
    if (times.start < due) {
      continue;  // a signal ended the sleep
    }
    times.due = due;
    auto dropped = static_cast<std::uint64_t>((times.start - due) / settings.period);
    if (dropped > 0 && settings.policy == MissedPolicy::stop) {
      return LoopEnd::missed;
    }
    if (settings.policy == MissedPolicy::catch_up) {
      dropped = dropped > settings.catch_up ? dropped - settings.catch_up : 0;
    }
    due += static_cast<std::int64_t>(dropped) * settings.period;
    statistics.skipped += dropped;
    statistics.elapsed = before + static_cast<std::uint64_t>((due - first) / settings.period);
    if (statistics.run + statistics.skipped != statistics.elapsed) {
      return LoopEnd::account_broken;
    }
    const std::int64_t cpu = clock.own_cpu();
    const bool goes_on = body.cycle(
        {.number = statistics.run, .period = statistics.elapsed, .skipped = dropped, .due = due, .start = times.start});
    const std::int64_t cpu_now = clock.own_cpu();
    times.cpu = cpu_now - cpu;
    statistics.cpu = cpu_now - cpu_before;
    times.end = clock.now();
    const std::int64_t stolen_now = clock.stolen();
    times.steal = stolen_now - stolen;
    stolen = stolen_now;

    const Verdict verdict = verdict_of(times, settings.period, settings.tolerance);
    if (verdict.carried) {
      ++statistics.carried;
    } else {
      ++statistics.events[static_cast<std::size_t>(verdict.cause)];
    }
    statistics.lateness.add(times.start - times.due, statistics.run);
    statistics.duration.add(times.end - times.start, statistics.run);
    times.previous = verdict.cause;
    times.previous_end = times.end;
    ++statistics.run;
    ++statistics.elapsed;
    due += settings.period;
    if (!body.finished(statistics, times.end - times.start, verdict) || !goes_on) {
      return LoopEnd::body;
    }
    if (settings.cycles > 0 && statistics.run >= settings.cycles) {
      return LoopEnd::done;
    }
  }
}

}  // namespace hysteron::runtime
