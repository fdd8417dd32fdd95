// The loop on a scripted clock, and delays of every cause injected into it.
#pragma once

#include <array>
#include <random>
#include <utility>
#include <vector>

#include "runtime/task/cyclic_loop.hpp"
#include "tests/runtime/namespaces.hpp"

namespace hysteron::runtime::test {

inline constexpr std::int64_t scripted_period = 1'000'000;

/// What happens to one cycle.
struct Event {
  Cause cause = Cause::on_time;
  std::int64_t amount = 0;  ///< of the delay
  bool at_wake = false;     ///< host steal: before the cycle, else in it
};

/// Time passes as a script says. The body tells it that a cycle runs.
class ScriptedClock final : public Clock {
 public:
  std::int64_t now() noexcept override { return now_; }
  void sleep_until(std::int64_t time) noexcept override {
    if (time > now_) {
      now_ = time;
    }
    const Event& event = next();
    if (event.cause == Cause::late_wake || (event.cause == Cause::host_steal && event.at_wake)) {
      now_ += event.amount;
      stolen_ += event.cause == Cause::host_steal ? event.amount : 0;
    }
  }
  std::int64_t own_cpu() noexcept override { return cpu_; }
  std::int64_t stolen() noexcept override { return stolen_; }

  void work() {
    const Event event = next();
    ++at;
    now_ += 20'000;
    cpu_ += 20'000;
    if (event.cause == Cause::own_cpu) {
      cpu_ += event.amount;
      now_ += event.amount;
    } else if (event.cause == Cause::preempted || (event.cause == Cause::host_steal && !event.at_wake)) {
      now_ += event.amount;
      stolen_ += event.cause == Cause::host_steal ? event.amount : 0;
    }
  }

  std::vector<Event> script;
  std::size_t at = 0;

 private:
  [[nodiscard]] const Event& next() const {
    static const Event nothing;
    return at < script.size() ? script[at] : nothing;
  }
  std::int64_t now_ = 17'000'000;
  std::int64_t cpu_ = 0;
  std::int64_t stolen_ = 0;
};

class Worker final : public CycleBody {
 public:
  explicit Worker(ScriptedClock& clock) : clock_(&clock) {}
  bool cycle(const CycleMoment& moment) noexcept override {
    moments.push_back(moment);
    clock_->work();
    return moments.size() != ends_after;
  }
  bool finished(const LoopStatistics& statistics, std::int64_t /*duration*/, Verdict /*verdict*/) noexcept override {
    account_holds = account_holds && statistics.run + statistics.skipped == statistics.elapsed;
    return true;
  }
  std::vector<CycleMoment> moments;
  std::size_t ends_after = 0;
  bool account_holds = true;

 private:
  ScriptedClock* clock_;
};

struct ScriptedRun {
  LoopEnd end = LoopEnd::stopped;
  LoopStatistics statistics;
  std::vector<CycleMoment> moments;
  bool account_holds = false;
};

inline ScriptedRun run_script(std::vector<Event> script, LoopSettings settings) {
  ScriptedClock clock;
  clock.script = std::move(script);
  Worker worker(clock);
  ScriptedRun result;
  const std::atomic<bool> stop{false};
  result.end = run_loop(settings, clock, worker, stop, result.statistics);
  result.moments = worker.moments;
  result.account_holds = worker.account_holds;
  return result;
}

struct InjectedDelays {
  std::array<std::uint64_t, cause_count> injected{};  ///< by cause
  std::uint64_t quiet = 0;                            ///< cycles between
  ScriptedRun run{};

  /// Every cause counted exactly, and every period.
  [[nodiscard]] bool are_counted() const {
    std::uint64_t all = 0;
    bool same = run.account_holds;
    for (std::size_t i = 1; i < cause_count; ++i) {
      same = same && run.statistics.events[i] == injected[i];
      all += injected[i];
    }
    return same && run.statistics.late_events() == all && run.statistics.run == all + quiet &&
           run.statistics.events[0] + run.statistics.carried == quiet;
  }
};

inline InjectedDelays inject_delays(std::uint64_t count) {
  constexpr std::int64_t period = scripted_period;
  std::mt19937 random(1);
  std::uniform_int_distribution<int> cause(1, 4);
  std::uniform_int_distribution<std::int64_t> delay(period + 1, 4 * period);
  std::uniform_int_distribution<std::int64_t> small_delay(period / 10 + 1, 4 * period);
  InjectedDelays result;
  std::vector<Event> script;
  for (std::uint64_t i = 0; i < count; ++i) {
    Event event{.cause = static_cast<Cause>(cause(random)), .at_wake = i % 2 == 0};
    const bool wakes_late = event.cause == Cause::late_wake || (event.cause == Cause::host_steal && event.at_wake);
    event.amount = wakes_late ? small_delay(random) : delay(random);
    ++result.injected[static_cast<std::size_t>(event.cause)];
    script.push_back(event);
    // Quiet cycles between: one may be carried, the next are on time.
    script.insert(script.end(), 2 + i % 3, Event{});
    result.quiet += 2 + i % 3;
  }
  const std::uint64_t cycles = script.size();
  result.run = run_script(std::move(script), {.period = period, .tolerance = period / 10, .cycles = cycles});
  return result;
}

}  // namespace hysteron::runtime::test
