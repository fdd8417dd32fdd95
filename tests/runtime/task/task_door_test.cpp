// What servers ask of a task: two staged sets that leave each other alone, an owner of the writes, forced inputs.
#include "runtime/task/task_door.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <limits>

#include "runtime/task/task.hpp"
#include "tests/runtime/task/accumulator.hpp"
#include "tests/runtime/task/slow_clock.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/support/soon.hpp"

namespace hysteron::runtime {
namespace {

using test::Accumulator;
using test::point;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::StartsWith;

enum class By : std::uint8_t { plant, page };

struct DoorBench {
  std::string write(By by, std::initializer_list<std::pair<const char*, double>> values) {
    std::vector<PointWrite> writes;
    for (const auto& [name, value] : values) {
      writes.push_back({point(door, name), value});
    }
    return by == By::page ? door.write_from_page(writes) : door.write(writes);
  }
  /// What the page has staged, by name.
  std::vector<std::pair<std::string, double>> staged_by_page() {
    LiveValues live;
    door.read_live(live);
    std::vector<std::pair<std::string, double>> staged;
    for (const PointWrite& one : live.staged) {
      staged.emplace_back(door.view()->points[one.point].name, one.value);
    }
    return staged;
  }

  Accumulator program;
  TaskDoor door{program, {{}}, {{}, {}}};
};

/// Zero may be what an output never is.
TEST(TaskDoor, BeforeTheFirstCycleOutputsAreTheirSafeValues) {
  const Accumulator program;
  TaskDoor door(program, {{}}, {{.low = 2.0, .high = 8.0, .value = 3.0}, {.low = 4.0, .high = 8.0}});
  LiveValues live;
  door.read_live(live);
  for (const auto& [name, safe] : {std::pair("Y", 3.0), std::pair("TORN", 4.0)}) {
    EXPECT_EQ(test::value(door, name), safe);
    EXPECT_EQ(live.values[point(door, name)], safe) << "on the live page";
  }
}

using Staged = std::pair<std::string, double>;

TEST(TaskDoor, ACommitOfThePageLeavesWhatModbusHasStaged) {
  DoorBench bench;
  EXPECT_EQ(bench.write(By::plant, {{"G.A", 2.0}}), "");
  EXPECT_EQ(bench.write(By::page, {{"G.B", 7.0}}), "");
  EXPECT_EQ(test::value(bench.door, "G.A"), 2.0) << "a client of Modbus reads what it staged";
  EXPECT_EQ(test::value(bench.door, "G.B"), -1.0) << "and not what the page did";
  EXPECT_THAT(bench.staged_by_page(), ElementsAre(Staged("G.B", 7.0)));

  EXPECT_EQ(bench.write(By::page, {{"task.commit", 1.0}}), "");
  EXPECT_THAT(bench.door.take_orders()->parameters, ElementsAre(1.0, 7.0)) << "G.A stays";
  EXPECT_THAT(bench.staged_by_page(), IsEmpty());
  EXPECT_EQ(test::value(bench.door, "G.A"), 2.0) << "it still waits";

  EXPECT_EQ(bench.write(By::plant, {{"task.commit", 1.0}}), "");
  EXPECT_THAT(bench.door.take_orders()->parameters, ElementsAre(2.0, 7.0)) << "and takes nothing of the page's back";
}

TEST(TaskDoor, ADiscardIsOfOnesOwnSet) {
  DoorBench bench;
  EXPECT_EQ(bench.write(By::plant, {{"G.A", 2.0}}), "");
  EXPECT_EQ(bench.write(By::page, {{"G.A", 3.0}}), "");
  EXPECT_EQ(bench.write(By::plant, {{"task.discard", 1.0}}), "");
  EXPECT_THAT(bench.staged_by_page(), ElementsAre(Staged("G.A", 3.0)));
  EXPECT_EQ(bench.write(By::plant, {{"G.A", 3.0}, {"task.commit", 1.0}}), "");
  EXPECT_THAT(bench.staged_by_page(), IsEmpty()) << "it counts already";
}

TEST(TaskDoor, WhatWasStagedIsJudgedBesideWhatCountsMeanwhile) {
  DoorBench bench;
  bench.program.mutable_shape().relations = {{.numbers = {{.parameter = 1}, {.parameter = 0}}}};
  TaskDoor door(bench.program, {{}}, {{}, {}});
  const auto a = point(door, "G.A");
  const auto b = point(door, "G.B");
  const auto commit = point(door, "task.commit");
  EXPECT_EQ(door.write_from_page(std::vector<PointWrite>{{b, 0.5}}), "");
  EXPECT_EQ(door.write(std::vector<PointWrite>{{a, 0.0}, {commit, 1.0}}), "");
  EXPECT_EQ(door.write_from_page(std::vector<PointWrite>{{commit, 1.0}}), "G.A = 0 must be at least G.B = 0.5.");
}

TEST(TaskDoor, WhileAClientOwnsTheWritesThePageChangesNothing) {
  DoorBench bench;
  EXPECT_EQ(bench.write(By::page, {{"G.A", 2.0}}), "");
  EXPECT_EQ(bench.door.force(std::vector<Force>{{.point = 0, .value = 5.0}}), "");
  EXPECT_THAT(bench.door.take_orders()->forces, ElementsAre(std::optional(5.0)));
  bench.door.writes_are_owned(true);
  const TaskOrders* const orders = bench.door.take_orders();
  ASSERT_NE(orders, nullptr);
  EXPECT_THAT(orders->forces, ElementsAre(std::nullopt)) << "the owner's inputs count";
  for (const char* const command : {"task.commit", "task.discard", "task.reset", "G.A"}) {
    EXPECT_EQ(bench.write(By::page, {{command, 1.0}}),
              "Another client owns the writes, as own_writes under [modbus] has it; wait until it is gone.");
  }
  EXPECT_NE(bench.door.force(std::vector<Force>{{.point = 0, .value = 5.0}}), "");
  EXPECT_EQ(bench.door.take_orders(), nullptr);
  EXPECT_EQ(bench.write(By::plant, {{"X", 1.0}}), "");
  bench.door.writes_are_owned(false);
  EXPECT_EQ(bench.write(By::page, {{"task.commit", 1.0}}), "") << "what it staged before is there";
  EXPECT_THAT(bench.door.take_orders()->parameters, ElementsAre(2.0, -1.0));
}

TEST(TaskDoor, AForceIsHeldAgainstTheTypeAndTheRangeOfTheInput) {
  DoorBench bench;
  ProgramSignal& x = bench.program.mutable_shape().inputs[0];
  x.low = -2.0;
  x.high = 2.0;
  const auto refusal = [&](double value, PointType type = PointType::real64) {
    x.type = type;
    TaskDoor door(bench.program, {{.from_device = true}}, {{}, {}});
    const std::string why = door.force(std::vector<Force>{{.point = 0, .value = value}});
    EXPECT_EQ(door.take_orders() == nullptr, !why.empty());
    return why;
  };
  EXPECT_EQ(refusal(2.0), "") << "an input that a device gives, too";
  EXPECT_EQ(refusal(2.5), "X must be at most 2.");
  EXPECT_EQ(refusal(-2.5), "X must be at least -2.");
  EXPECT_EQ(refusal(std::numeric_limits<double>::quiet_NaN()), "X is not a finite number.");
  EXPECT_EQ(refusal(0.5, PointType::int32), "X takes a whole number.");
  EXPECT_EQ(refusal(2.0, PointType::boolean), "X takes 0 or 1.");
  x.low = -std::numeric_limits<double>::infinity();
  x.high = std::numeric_limits<double>::infinity();
  EXPECT_EQ(refusal(2147483647.0, PointType::int32), "");
  EXPECT_EQ(refusal(-2147483648.0, PointType::int32), "");
  EXPECT_EQ(refusal(2147483648.0, PointType::int32),
            "X takes whole numbers from -2147483648 to 2147483647; 2147483648 was given.");
  EXPECT_THAT(refusal(-1e300, PointType::int32), StartsWith("X takes whole numbers from -2147483648 to 2147483647"));
  EXPECT_EQ(refusal(65535.0, PointType::uint16), "");
  EXPECT_EQ(refusal(65536.0, PointType::uint16), "X takes whole numbers from 0 to 65535; 65536 was given.");
  EXPECT_EQ(refusal(-1.0, PointType::uint16), "X takes whole numbers from 0 to 65535; -1 was given.");
  EXPECT_EQ(refusal(1e300), "");
  EXPECT_EQ(bench.door.force(std::vector<Force>{{.point = 1, .value = 1.0}}), "Inputs alone can be forced.");
}

struct ForceBench {
  explicit ForceBench(TaskSettings settings = {.inputs = {{}}, .outputs = {{.value = -1.0}, {}}})
      : task(program, settings) {}
  /// Runs so many cycles; what the program then has summed.
  double run(std::uint64_t cycles) {
    VirtualClock clock;
    std::atomic<bool> stop{false};
    program.during_step = [&, left = cycles](std::span<double> /*outputs*/) mutable {
      if (--left == 0) {
        stop.store(true);
      }
    };
    (void)task.run(clock, stop);
    std::vector<double> sum(1);
    program.save(std::as_writable_bytes(std::span(sum)));
    return sum[0];
  }
  std::string force(std::optional<double> value) {
    return task.door().force(std::vector<Force>{{.point = 0, .value = value}});
  }
  std::string write(const char* name, double value) {
    return task.door().write(std::vector<PointWrite>{{point(task.door(), name), value}});
  }
  double forced() { return test::value(task.door(), "task.forced"); }

  Accumulator program;
  Task task;
};

TEST(ForcedInput, TakesThePlaceOfWhatAClientGivesAndGivesItBack) {
  ForceBench bench;
  EXPECT_EQ(bench.write("X", 2.0), "");
  EXPECT_EQ(bench.run(10), 20.0);
  EXPECT_EQ(bench.force(100.0), "");
  EXPECT_EQ(bench.run(3), 320.0);
  EXPECT_EQ(bench.forced(), 1.0);
  EXPECT_EQ(test::value(bench.task.door(), "X"), 100.0) << "what counts is what is shown";
  EXPECT_THAT(bench.task.door().forced(), ElementsAre("X = 100"));
  EXPECT_EQ(bench.write("X", 3.0), "") << "it is taken, and waits";
  EXPECT_EQ(bench.run(1), 420.0);
  EXPECT_EQ(bench.force(std::nullopt), "");
  EXPECT_EQ(bench.run(2), 426.0);
  EXPECT_EQ(bench.forced(), 0.0);
  EXPECT_THAT(bench.task.door().forced(), IsEmpty());
}

TEST(ForcedInput, HidesNoFaultOfWhatGivesTheInput) {
  ForceBench bench({.inputs = {{.longest_age = 5}}, .outputs = {{.value = -1.0}, {}}});
  EXPECT_EQ(bench.write("X", 2.0), "");
  EXPECT_EQ(bench.force(100.0), "");
  (void)bench.run(20);
  EXPECT_EQ(bench.task.faults().last, Fault::stale_input);
  EXPECT_EQ(bench.task.outputs()[0], -1.0);
}

TEST(ForcedInput, IsNotRetained) {
  const hysteron::test::ScratchFolder folder;
  RetainFolder files(folder.path() / "kept");
  files.open();
  ForceBench bench;
  Retainer retainer(files, bench.program, Recovery{}, state_of(bench.program), {0});
  bench.task.attach({.retainer = &retainer});
  EXPECT_EQ(bench.write("X", 2.0), "");
  EXPECT_EQ(bench.force(100.0), "");
  (void)bench.run(20);
  retainer.finish();
  std::size_t kept = 0;
  for (const std::size_t slot : {0U, 1U}) {
    if (const auto bytes = files.read(slot)) {
      const Slot read = decode_slot(*bytes);
      ASSERT_EQ(read.status, SlotStatus::whole);
      EXPECT_THAT(read.values.inputs, ElementsAre(2.0));
      ++kept;
    }
  }
  EXPECT_GT(kept, 0U);
}

TEST(TaskDoor, SaysForAsLongAsWhatIsRetainedCannotBeWritten) {
  const hysteron::test::ScratchFolder folder;
  const auto in_the_way = folder.path() / "kept/retain_a.new";
  std::filesystem::create_directories(in_the_way);
  RetainFolder files(folder.path() / "kept");
  files.open();
  ForceBench bench({.inputs = {{}}, .outputs = {{.value = -1.0}, {}}, .retain_every = 1});
  Retainer retainer(files, bench.program, Recovery{}, state_of(bench.program));
  bench.task.attach({.retainer = &retainer});
  const auto shortages_are = [&](double bits) {
    return hysteron::test::soon([&] {
      (void)bench.run(1);
      return test::value(bench.task.door(), "task.shortages") == bits;
    });
  };
  EXPECT_TRUE(shortages_are(256.0));
  std::filesystem::remove(in_the_way);
  EXPECT_TRUE(shortages_are(0.0));
}

TEST(ForcedInput, EndsWithAReset) {
  ForceBench bench;
  EXPECT_EQ(bench.force(100.0), "");
  EXPECT_EQ(bench.run(1), 100.0);
  EXPECT_EQ(bench.write("task.reset", 1.0), "");
  EXPECT_EQ(bench.run(5), 5.0);
  EXPECT_EQ(bench.forced(), 0.0);
  EXPECT_EQ(bench.force(100.0), "") << "after it, anew";
  EXPECT_EQ(bench.run(1), 105.0);
}

/// Until the reset nothing can be forced, and after it nothing is.
TEST(ForcedInput, EndsWhereTheWatchdogTrips) {
  ForceBench bench({.loop = {.cycles = 6},
                    .watchdog = {.time = 500'000, .sensitivity = 1},
                    .inputs = {{}},
                    .outputs = {{.value = -1.0}, {}}});
  test::SlowClock clock;
  std::vector<double> forced;
  bench.program.during_step = [&](std::span<double> /*outputs*/) {
    forced.push_back(bench.forced());
    clock.pass(forced.size() == 2 ? 600'000 : 100);
  };
  EXPECT_EQ(bench.force(100.0), "");
  const std::atomic<bool> stop{false};
  (void)bench.task.run(clock, stop);
  EXPECT_THAT(forced, ElementsAre(0.0, 1.0)) << "of the cycle before; it hung in the second";
  EXPECT_EQ(bench.forced(), 0.0);
  EXPECT_THAT(bench.task.door().forced(), IsEmpty());
  EXPECT_EQ(bench.force(100.0), "The watchdog has stopped the task: reset it first.");
  EXPECT_EQ(bench.write("task.reset", 1.0), "");
  (void)bench.task.run(clock, stop);
  EXPECT_EQ(forced.size(), 3U) << "it steps again";
  EXPECT_EQ(bench.forced(), 0.0);
  EXPECT_EQ(test::value(bench.task.door(), "X"), 1.0);
}

}  // namespace
}  // namespace hysteron::runtime
