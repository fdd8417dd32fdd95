// How much of its time the cyclic thread computes: counted, told once, and a fault where the run file says so.
#include "runtime/task/load.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "runtime/host/notices.hpp"
#include "tests/runtime/task/loaded_task.hpp"

namespace hysteron::runtime {
namespace {

using testing::HasSubstr;

using test::Loaded;
using test::loaded_period;

TEST(Load, IsTheOwnProcessorTimeOfTheLastSecond) {
  Loaded bench([](std::uint64_t) { return 97 * loaded_period / 100; }, {.loop = {.cycles = 1000}});
  bench.run();
  EXPECT_EQ(test::value(bench.task->door(), "task.load"), 97.0);
  EXPECT_EQ(bench.task->load().stretch, 1U);
  EXPECT_EQ(bench.task->load().periods, 1000U);
  EXPECT_EQ(bench.task->load().skipped, 0U);
  EXPECT_EQ(bench.task->fault(), Fault::stop) << "it is told of, and is no fault without the key";
}

TEST(Load, OfAStepThatIsLongerThanItsPeriodIsAllOfTheTime) {
  Loaded bench([](std::uint64_t) { return 5 * loaded_period / 2; }, {.loop = {.cycles = 1000}});
  bench.run();
  const LoadReport report = bench.task->load();
  EXPECT_GE(report.load, 0.99);
  EXPECT_NEAR(static_cast<double>(report.skipped) / static_cast<double>(report.periods), 0.6, 0.01);
  EXPECT_GT(bench.task->statistics().events[static_cast<std::size_t>(Cause::own_cpu)], 990U);
}

TEST(Load, IsAFaultByPolicyForAsLongAsItLasts) {
  for (const bool is_fault : {false, true}) {
    std::vector<std::pair<double, double>> seen;  // fault and output at the steps below
    Loaded bench([](std::uint64_t step) { return step < 2500 ? 9 * loaded_period / 10 : loaded_period / 10; },
                 {.loop = {.cycles = 5500}, .overload_is_a_fault = is_fault});
    bench.program.during_step = [&, before = bench.program.during_step](std::span<double> outputs) {
      before(outputs);
      outputs[0] = 7.0;
      if (bench.steps == 500 || bench.steps == 1500 || bench.steps == 5400) {
        seen.emplace_back(test::value(bench.task->door(), "task.fault"), test::value(bench.task->door(), "Y"));
      }
    };
    bench.run();
    const std::pair<double, double> well{0.0, 7.0};
    const std::pair<double, double> safe{static_cast<double>(Fault::overload), -1.0};
    EXPECT_EQ(seen, (std::vector{well, is_fault ? safe : well, well})) << is_fault;
  }
}

TEST(Load, ABoundOfOneStretchIsTenPeriodsAtTheLeast) {
  LoadWatch slow(10'000'000'000, 0.8);
  LoopStatistics statistics;
  for (int i = 1; i <= 9; ++i) {
    statistics.elapsed = static_cast<std::uint64_t>(i);
    statistics.cpu += 9'500'000'000;
    slow.finished(statistics);
    EXPECT_FALSE(slow.is_too_much()) << "one long cycle is no overload";
  }
  statistics.elapsed = 10;
  slow.finished(statistics);
  EXPECT_TRUE(slow.is_too_much());
}

TEST(LoadNotices, AreOneLineWhereItBeginsAndOneWhereItIsOver) {
  LoadNotices notices(0.8);
  std::uint64_t stretch = 0;
  const auto line = [&](double load, std::uint64_t skipped) {
    return notices.line({.stretch = ++stretch, .load = load, .periods = 1000, .skipped = skipped});
  };
  EXPECT_EQ(notices.line({}), "") << "before the first second is over";
  EXPECT_EQ(line(0.79, 0), "");
  EXPECT_THAT(line(0.97, 812), HasSubstr("computes for 97 % of the time, and 80 % is the most that it should (load in "
                                         "[task]); 812 of the last 1000 periods passed without a cycle."));
  EXPECT_TRUE(notices.is_told());
  for (int i = 0; i < 100; ++i) {
    EXPECT_EQ(line(i % 9 == 0 ? 0.97 : 0.5, 0), "") << "it comes and goes, and is told once";
  }
  std::string well;
  for (int i = 0; i < 10 && well.empty(); ++i) {
    well = line(0.41, 0);
  }
  EXPECT_EQ(well, "well again: the cyclic thread computes for 41 % of the time.");
  EXPECT_THAT(line(0.12, 101),
              HasSubstr("101 of the last 1000 periods passed without a cycle, though the cyclic thread "
                        "computes for 12 % of the time alone"));
  EXPECT_EQ(line(0.12, 101), "");
}

TEST(HeldBack, CountsEachOutputThatALimitKeepsFromWhatTheDiagramGives) {
  SafeOutputs outputs({{.low = 0.0, .high = 10.0}, {.slew = 1.0}, {}}, 1.0);
  const auto step = [&](std::array<double, 3> wanted, Fault fault = Fault::none) {
    outputs.step(wanted, fault);
    return outputs.held_back();
  };
  EXPECT_EQ(step({5.0, 0.5, 1e300}), 0U);
  EXPECT_EQ(step({10.0, 1.5, -1.0}), 0U) << "at a limit is within it";
  EXPECT_EQ(step({10.5, 1.5, 0.0}), 1U) << "above high";
  EXPECT_EQ(step({-0.5, 9.0, 0.0}), 2U) << "below low; further than slew lets it go";
  EXPECT_EQ(step({99.0, 99.0, 0.0}, Fault::hang), 0U) << "in a fault nothing is wanted";
  EXPECT_EQ(step({std::numeric_limits<double>::quiet_NaN(), 2.5, 0.0}), 0U) << "no number is a fault of its own";
}

TEST(HeldBack, IsAStatusOfTheTask) {
  test::Accumulator program;  // Y grows by 1 a step
  Task task(program, {.loop = {.cycles = 12}, .inputs = {{}}, .outputs = {{.low = -50.0, .high = 10.0}, {}}});
  VirtualClock clock;
  const std::atomic<bool> stop{false};
  (void)task.run(clock, stop);
  EXPECT_EQ(test::value(task.door(), "task.held_back"), 2.0);
}

}  // namespace
}  // namespace hysteron::runtime
