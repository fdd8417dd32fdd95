// The loop on a scripted clock: every period accounted for, every late cycle counted by its cause.
#include "runtime/task/cyclic_loop.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

namespace hysteron::runtime {
namespace {

constexpr std::int64_t period = 1'000'000;

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

struct Run {
  LoopEnd end = LoopEnd::stopped;
  LoopStatistics statistics;
  std::vector<CycleMoment> moments;
  bool account_holds = false;
};

Run run(std::vector<Event> script, LoopSettings settings) {
  ScriptedClock clock;
  clock.script = std::move(script);
  Worker worker(clock);
  Run result;
  const std::atomic<bool> stop{false};
  result.end = run_loop(settings, clock, worker, stop, result.statistics);
  result.moments = worker.moments;
  result.account_holds = worker.account_holds;
  return result;
}

TEST(CyclicLoop, TenThousandInjectedDelaysAreCountedByCause) {
  std::mt19937 random(1);
  std::uniform_int_distribution<int> cause(1, 4);
  std::uniform_int_distribution<std::int64_t> delay(period + 1, 4 * period);
  std::uniform_int_distribution<std::int64_t> small_delay(period / 10 + 1, 4 * period);
  std::vector<Event> script;
  std::array<std::uint64_t, cause_count> injected{};
  for (int i = 0; i < 10'000; ++i) {
    Event event{.cause = static_cast<Cause>(cause(random)), .at_wake = i % 2 == 0};
    const bool wakes_late = event.cause == Cause::late_wake || (event.cause == Cause::host_steal && event.at_wake);
    event.amount = wakes_late ? small_delay(random) : delay(random);
    ++injected[static_cast<std::size_t>(event.cause)];
    script.push_back(event);
    // Quiet cycles between: one may be carried, the next are on time.
    script.insert(script.end(), static_cast<std::size_t>(2 + i % 3), Event{});
  }
  const auto result = run(script, {.period = period, .tolerance = period / 10, .cycles = script.size()});
  EXPECT_EQ(result.end, LoopEnd::done);
  EXPECT_TRUE(result.account_holds);
  for (std::size_t i = 1; i < cause_count; ++i) {
    EXPECT_EQ(result.statistics.events[i], injected[i]) << name_of(static_cast<Cause>(i));
  }
  EXPECT_EQ(result.statistics.late_events(), 10'000U);
  EXPECT_EQ(result.statistics.run, script.size());
  EXPECT_EQ(result.statistics.events[0] + result.statistics.carried + 10'000U, script.size());
  EXPECT_GT(result.statistics.skipped, 0U);
}

TEST(CyclicLoop, ASkippedPeriodIsNeverRunAndTheGridIsKept) {
  const auto result = run({{}, {.cause = Cause::late_wake, .amount = 7 * period / 2}}, {.period = period, .cycles = 4});
  ASSERT_EQ(result.moments.size(), 4U);
  EXPECT_EQ(result.moments[1].period, 4U);
  EXPECT_EQ(result.moments[1].skipped, 3U);
  EXPECT_EQ(result.moments[1].due - result.moments[0].due, 4 * period);
  EXPECT_EQ(result.moments[2].period, 5U);
  EXPECT_EQ(result.moments[2].due - result.moments[1].due, period);
  EXPECT_EQ(result.statistics.skipped, 3U);
  EXPECT_EQ(result.statistics.elapsed, 7U);
}

TEST(CyclicLoop, CatchingUpIsBounded) {
  const auto result = run({{}, {.cause = Cause::own_cpu, .amount = 21 * period / 2}},
                          {.period = period, .policy = MissedPolicy::catch_up, .catch_up = 4, .cycles = 8});
  // The second cycle ends 10.5 periods late; periods 2 to 11 have begun, 11 is still open, 4 before it may be caught
  // up.
  ASSERT_EQ(result.moments.size(), 8U);
  EXPECT_EQ(result.moments[2].period, 7U);
  EXPECT_EQ(result.moments[2].skipped, 5U);
  for (std::size_t i = 3; i < 8; ++i) {
    EXPECT_EQ(result.moments[i].period, 5 + i);
    EXPECT_EQ(result.moments[i].skipped, 0U);
  }
  EXPECT_EQ(result.statistics.skipped, 5U);
  EXPECT_TRUE(result.account_holds);
}

TEST(CyclicLoop, StopsAtAMissedPeriodWhereAsked) {
  const auto result = run({{}, {}, {.cause = Cause::late_wake, .amount = 2 * period}},
                          {.period = period, .policy = MissedPolicy::stop, .cycles = 9});
  EXPECT_EQ(result.end, LoopEnd::missed);
  EXPECT_EQ(result.statistics.run, 2U);
  // Late, but within its period, is not missed.
  EXPECT_EQ(run({{.cause = Cause::late_wake, .amount = period - 1}},
                {.period = period, .policy = MissedPolicy::stop, .cycles = 9})
                .end,
            LoopEnd::done);
}

TEST(CyclicLoop, EndsByItsBodyAndByRequest) {
  ScriptedClock clock;
  Worker worker(clock);
  worker.ends_after = 3;
  LoopStatistics statistics;
  std::atomic<bool> stop{false};
  EXPECT_EQ(run_loop({.period = period}, clock, worker, stop, statistics), LoopEnd::body);
  EXPECT_EQ(statistics.run, 3U);
  stop = true;
  EXPECT_EQ(run_loop({.period = period}, clock, worker, stop, statistics), LoopEnd::stopped);
  EXPECT_EQ(worker.moments.size(), 3U);
}

TEST(Lateness, TheHistogramHoldsPercentilesToThreePerCent) {
  std::mt19937_64 random(3);
  std::vector<std::int64_t> values;
  Histogram histogram;
  for (std::uint64_t i = 0; i < 200'000; ++i) {
    const double exponent = std::uniform_real_distribution<double>(0.0, 9.0)(random);
    values.push_back(static_cast<std::int64_t>(std::pow(10.0, exponent)));
    histogram.add(values.back(), i);
  }
  const auto worst = std::ranges::max_element(values);
  EXPECT_EQ(histogram.worst(), *worst);
  EXPECT_EQ(histogram.worst_cycle(), static_cast<std::uint64_t>(worst - values.begin()));
  std::ranges::sort(values);
  for (const double fraction : {0.01, 0.5, 0.9, 0.99, 0.999, 0.9999}) {
    const auto rank = static_cast<std::size_t>(std::ceil(fraction * 200'000.0)) - 1;
    const auto exact = static_cast<double>(values[rank]);
    const auto found = static_cast<double>(histogram.percentile(fraction));
    EXPECT_GE(found, exact);
    EXPECT_LE(found, exact * (1.0 + 1.0 / 32.0) + 1.0);
  }
  EXPECT_EQ(histogram.percentile(1.0), histogram.worst());
  EXPECT_EQ(Histogram().percentile(0.5), 0);
}

TEST(Lateness, StolenTimeIsReadFromTheKernelsText) {
  EXPECT_EQ(stolen_time("cpu  10 0 20 300 4 0 1 25 0 0\ncpu0 1 2 3\n", 100), 250'000'000);
  EXPECT_EQ(stolen_time("cpu0 1 2 3 4 5 6 7 8\n", 100), 0);
  EXPECT_EQ(stolen_time("", 100), 0);
}

TEST(Clock, TheVirtualOneIsNeverLate) {
  VirtualClock clock;
  ScriptedClock unused;
  Worker worker(unused);
  LoopStatistics statistics;
  const std::atomic<bool> stop{false};
  EXPECT_EQ(run_loop({.period = 50'000, .cycles = 100'000}, clock, worker, stop, statistics), LoopEnd::done);
  EXPECT_EQ(statistics.run, 100'000U);
  EXPECT_EQ(statistics.skipped, 0U);
  EXPECT_EQ(statistics.late_events(), 0U);
  EXPECT_EQ(statistics.lateness.worst(), 0);
  EXPECT_EQ(clock.now(), 50'000LL * 100'000);
}

TEST(Clock, TheMonotonicOneKeepsTheAccount) {
  MonotonicClock clock;
  ScriptedClock unused;
  Worker worker(unused);
  LoopStatistics statistics;
  const std::atomic<bool> stop{false};
  const auto before = clock.now();
  EXPECT_EQ(run_loop({.period = period, .cycles = 100}, clock, worker, stop, statistics), LoopEnd::done);
  EXPECT_TRUE(worker.account_holds);
  EXPECT_EQ(statistics.run, 100U);
  EXPECT_GE(clock.now() - before, static_cast<std::int64_t>(statistics.elapsed) * period);
  for (std::size_t i = 0; i < worker.moments.size(); ++i) {
    EXPECT_GE(worker.moments[i].start, worker.moments[i].due);
  }
}

}  // namespace
}  // namespace hysteron::runtime
