// The loop on a scripted clock: every period accounted for, every late cycle counted by its cause.
#include "runtime/task/cyclic_loop.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "tests/runtime/task/scripted_loop.hpp"

namespace hysteron::runtime {
namespace {

using test::ScriptedClock;
using test::Worker;

constexpr std::int64_t period = test::scripted_period;

TEST(CyclicLoop, TenThousandInjectedDelaysAreCountedByCause) {
  const auto result = test::inject_delays(10'000);
  EXPECT_EQ(result.run.end, LoopEnd::done);
  EXPECT_TRUE(result.run.account_holds);
  for (std::size_t i = 1; i < cause_count; ++i) {
    EXPECT_EQ(result.run.statistics.events[i], result.injected[i]) << name_of(static_cast<Cause>(i));
  }
  EXPECT_EQ(result.run.statistics.late_events(), 10'000U);
  EXPECT_TRUE(result.are_counted());
  EXPECT_GT(result.run.statistics.skipped, 0U);
}

TEST(CyclicLoop, ASkippedPeriodIsNeverRunAndTheGridIsKept) {
  const auto result =
      test::run_script({{}, {.cause = Cause::late_wake, .amount = 7 * period / 2}}, {.period = period, .cycles = 4});
  ASSERT_EQ(result.moments.size(), 4U);
  EXPECT_EQ(result.moments[1].period, 4U);
  EXPECT_EQ(result.moments[1].skipped, 3U);
  EXPECT_EQ(result.moments[1].due - result.moments[0].due, 4 * period);
  EXPECT_EQ(result.moments[2].period, 5U);
  EXPECT_EQ(result.moments[2].due - result.moments[1].due, period);
  EXPECT_EQ(result.statistics.skipped, 3U);
  EXPECT_EQ(result.statistics.elapsed, 7U);
}

/// A step that is too long for its period says so in each cycle, also where the first was late for another reason.
TEST(CyclicLoop, PermanentOverloadIsOwnTime) {
  std::vector<test::Event> script{{}, {.cause = Cause::late_wake, .amount = 3 * period / 2}};
  for (int i = 0; i < 100; ++i) {
    script.push_back({.cause = Cause::own_cpu, .amount = 8 * period / 5});
  }
  const auto result = test::run_script(script, {.period = period, .cycles = script.size()});
  EXPECT_EQ(result.statistics.events[static_cast<std::size_t>(Cause::own_cpu)], 100U);
  EXPECT_EQ(result.statistics.events[static_cast<std::size_t>(Cause::late_wake)], 1U);
  EXPECT_GT(result.statistics.skipped, 50U);
}

TEST(CyclicLoop, CatchingUpIsBounded) {
  const auto result =
      test::run_script({{}, {.cause = Cause::own_cpu, .amount = 21 * period / 2}},
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
  const auto result = test::run_script({{}, {}, {.cause = Cause::late_wake, .amount = 2 * period}},
                                       {.period = period, .policy = MissedPolicy::stop, .cycles = 9});
  EXPECT_EQ(result.end, LoopEnd::missed);
  EXPECT_EQ(result.statistics.run, 2U);
  // Late, but within its period, is not missed.
  EXPECT_EQ(test::run_script({{.cause = Cause::late_wake, .amount = period - 1}},
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
  for (const auto& moment : worker.moments) {
    EXPECT_GE(moment.start, moment.due);
  }
}

}  // namespace
}  // namespace hysteron::runtime
