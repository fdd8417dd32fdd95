// A trace holds every step or counts it, and gives the same bits when it is replayed.
#include "runtime/task/trace.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "runtime/task/task.hpp"
#include "tests/runtime/task/accumulator.hpp"
#include "tests/support/file_size_limit.hpp"
#include "tests/support/own_disk.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/support/soon.hpp"

namespace hysteron::runtime {
namespace {

using test::Accumulator;

class Wave final : public FieldIo {
 public:
  Fault read(std::span<double> inputs) noexcept override {
    inputs[0] = std::sin(0.1 * static_cast<double>(++k_)) / 3.0;
    return Fault::none;
  }
  void write(std::span<const double> /*outputs*/) noexcept override {}

 private:
  std::uint64_t k_ = 0;
};

std::string traced_run(const TraceSettings& settings, std::uint64_t cycles,
                       const std::function<void(TaskDoor&, std::uint64_t)>& meanwhile = {}) {
  Accumulator program;
  Wave wave;
  {
    Trace trace(settings, program);
    Task task(program, {.loop = {.cycles = cycles}, .inputs = {{.from_device = true}}, .outputs = {{.high = 2.0}, {}}},
              {.field = &wave, .trace = &trace});
    std::uint64_t k = 0;
    program.during_step = [&](std::span<double>) {
      if (meanwhile) {
        meanwhile(task.door(), k);
      }
      ++k;
    };
    VirtualClock clock;
    const std::atomic<bool> stop{false};
    (void)task.run(clock, stop);
  }
  return hysteron::test::contents_of(settings.file);
}

ReplayResult replayed(const std::string& bytes, std::vector<TraceStep>* steps = nullptr) {
  Accumulator program;
  ReplayResult result;
  EXPECT_EQ(replay(bytes, program, result,
                   [&](const TraceStep& step) {
                     if (steps != nullptr) {
                       steps->push_back(step);
                     }
                   }),
            "");
  return result;
}

TEST(Trace, ReplaysToTheBitThroughParametersAndResets) {
  const hysteron::test::ScratchFolder scratch;
  const auto bytes = traced_run({.file = scratch / "trace"}, 5000, [](TaskDoor& door, std::uint64_t k) {
    if (k % 700 == 3) {
      const std::array<PointWrite, 2> writes{
          {{test::point(door, "G.A"), 1.0 / static_cast<double>(k)}, {test::point(door, "task.commit"), 1.0}}};
      EXPECT_EQ(door.write(writes), "");
    }
    if (k == 2500) {
      const std::array<PointWrite, 1> writes{{{test::point(door, "task.reset"), 1.0}}};
      EXPECT_EQ(door.write(writes), "");
    }
  });
  std::vector<TraceStep> steps;
  const auto result = replayed(bytes, &steps);
  EXPECT_EQ(result.steps, 5000U);
  EXPECT_EQ(result.different, 0U);
  EXPECT_EQ(result.without_state, 0U);
  EXPECT_TRUE(result.complete);
  ASSERT_EQ(steps.size(), 5000U);
  EXPECT_EQ(steps[4999].number, 4999U);
  EXPECT_NE(steps[0].computed[0], steps[1].computed[0]);
}

TEST(Trace, AChangedBitIsFoundAtItsStep) {
  const hysteron::test::ScratchFolder scratch;
  auto bytes = traced_run({.file = scratch / "trace"}, 100);
  const std::size_t record = 5 + 20 + 5 * 8;
  const std::size_t end = 5 + 16;
  // The lowest bit of the first computed output of step 60.
  const std::size_t at = bytes.size() - end - (100 - 60) * record + 5 + 20 + 8;
  bytes[at] = static_cast<char>(bytes[at] ^ 1);
  const auto result = replayed(bytes);
  EXPECT_EQ(result.different, 1U);
  EXPECT_EQ(result.first_different, 60U);
}

TEST(Trace, ATriggerKeepsWhatWasBefore) {
  const hysteron::test::ScratchFolder scratch;
  const TraceTrigger trigger{
      .signal = TraceTrigger::Signal::output, .index = 0, .level = 1.5, .before = 15, .after = 20};
  // Y rises from 0 as the sum of a sine, and passes 1.5 once in each period of it.
  const auto bytes = traced_run({.file = scratch / "trace", .trigger = trigger}, 5000);
  std::vector<TraceStep> steps;
  const auto result = replayed(bytes, &steps);
  EXPECT_EQ(result.different, 0U);
  EXPECT_EQ(result.without_state, 0U);
  std::size_t crossing = 1;
  while (crossing < steps.size() && !(steps[crossing].outputs[0] > 1.5 && steps[crossing - 1].outputs[0] <= 1.5)) {
    ++crossing;
  }
  ASSERT_LT(crossing, steps.size());
  EXPECT_EQ(steps.size() - crossing, 21U);
  EXPECT_GE(crossing, std::min<std::uint64_t>(15, steps[crossing].number));
  EXPECT_LE(crossing, 45U);
  for (std::size_t i = 1; i < steps.size(); ++i) {
    EXPECT_EQ(steps[i].number, steps[i - 1].number + 1);
  }
}

/// Armed again, it captures each further crossing, in a file of its own that replays by itself; then it is done.
TEST(Trace, ATriggerIsArmedAgainUntilItHasFiredSoOften) {
  const hysteron::test::ScratchFolder scratch;
  for (const std::uint64_t captures : {1U, 3U, 8U}) {
    const std::string file = scratch / fmt::format("trace{}", captures);
    const TraceTrigger trigger{.signal = TraceTrigger::Signal::input,
                               .index = 0,
                               .level = 0.3,
                               .before = 15,
                               .after = 20,
                               .captures = captures};
    // X is a sine of 62.8 steps: it passes 0.3 once in each.
    (void)traced_run({.file = file, .trigger = trigger, .files = 8}, 1000);
    std::set<std::uint64_t> fired;
    for (std::uint64_t number = 0; number < 9; ++number) {
      const std::string one = number == 0 ? file : fmt::format("{}.{}", file, number);
      EXPECT_EQ(std::filesystem::exists(one), number < captures) << one;
      if (number >= captures) {
        continue;
      }
      std::vector<TraceStep> steps;
      const auto result = replayed(hysteron::test::contents_of(one), &steps);
      EXPECT_EQ(result.different + result.without_state, 0U) << one;
      const auto crossing = std::adjacent_find(steps.begin(), steps.end(), [](const TraceStep& a, const TraceStep& b) {
        return a.inputs[0] <= 0.3 && b.inputs[0] > 0.3;
      });
      ASSERT_NE(crossing, steps.end()) << one;
      EXPECT_EQ(steps.end() - crossing, 22) << "the step before, that of the crossing, and 20 more";
      fired.insert(crossing->number);
    }
    EXPECT_EQ(fired.size(), captures) << "each of another crossing";
  }
}

/// A trace without a step takes no place among those that are kept: restarts without a crossing cost no capture.
TEST(Trace, AStartWhoseTriggerDoesNotFireKeepsEveryCapture) {
  const hysteron::test::ScratchFolder scratch;
  const std::string file = scratch / "trace";
  TraceTrigger trigger{.signal = TraceTrigger::Signal::input, .index = 0, .level = 0.3, .before = 5, .after = 5};
  trigger.captures = 2;
  (void)traced_run({.file = file, .trigger = trigger, .files = 3}, 500);
  const auto newest = hysteron::test::contents_of(file);
  const auto oldest = hysteron::test::contents_of(file + ".1");
  trigger.level = 100.0;
  for (int start = 0; start < 5; ++start) {
    EXPECT_EQ(replayed(traced_run({.file = file, .trigger = trigger, .files = 3}, 500)).steps, 0U);
    EXPECT_EQ(hysteron::test::contents_of(file + ".1"), newest) << start;
    EXPECT_EQ(hysteron::test::contents_of(file + ".2"), oldest) << start;
  }
  // A task that was killed left the head alone, or a torn record behind it.
  for (const std::size_t bytes : {21U, 10U, 0U}) {
    const auto empty = hysteron::test::contents_of(file);
    std::filesystem::resize_file(file, empty.size() - bytes);
    (void)traced_run({.file = file, .trigger = trigger, .files = 3}, 500);
    EXPECT_EQ(hysteron::test::contents_of(file + ".1"), newest) << bytes;
  }
  trigger.level = 0.3;
  trigger.captures = 1;
  EXPECT_GT(replayed(traced_run({.file = file, .trigger = trigger, .files = 3}, 500)).steps, 5U);
  EXPECT_EQ(hysteron::test::contents_of(file + ".1"), newest) << "the empty one was written over";
  (void)traced_run({.file = file, .trigger = trigger, .files = 3}, 500);
  EXPECT_EQ(hysteron::test::contents_of(file + ".2"), newest) << "a capture is put aside";
}

/// A trigger is an edge: a level that holds from the start has to be left first. A fault of the first step has begun.
TEST(Trace, ATriggerIsAnEdgeAndAFaultBeginsWithTheFirstStep) {
  const hysteron::test::ScratchFolder scratch;
  const TraceTrigger always{.signal = TraceTrigger::Signal::input, .index = 0, .level = -9.0, .before = 5, .after = 5};
  EXPECT_EQ(replayed(traced_run({.file = scratch / "level", .trigger = always}, 500)).steps, 0U);
  const std::string file = scratch / "fault";
  Accumulator program;
  {
    Trace trace({.file = file, .trigger = TraceTrigger{.before = 5, .after = 5}, .waits = true}, program);
    for (std::uint64_t k = 0; k < 50; ++k) {
      trace.before_step(k, program);
      trace.step(k, k, Fault::lost_link, std::array{1.0}, std::array{1.0, 0.0}, std::array{1.0, 0.0});
    }
  }
  std::vector<TraceStep> steps;
  (void)replayed(hysteron::test::contents_of(file), &steps);
  ASSERT_EQ(steps.size(), 6U);
  EXPECT_EQ(steps.front().number, 0U);
}

/// No room at the start: the trace of before has its name, and another is begun where there is room.
TEST(Trace, AFullDiskAtTheStartIsACutThatIsMended) {
  const hysteron::test::ScratchFolder scratch;
  const auto before = traced_run({.file = scratch / "trace"}, 50);
  Accumulator program;
  {
    auto limit = std::make_unique<test::FileSizeLimit>(0);
    Trace trace({.file = scratch / "trace"}, program);
    EXPECT_TRUE(trace.is_cut());
    EXPECT_EQ(trace.problem(), (scratch / "trace") + ": File too large");
    EXPECT_EQ(hysteron::test::contents_of(scratch / "trace"), before);
    limit.reset();
    // It is tried again every 10 s; a step comes every millisecond until one is in a file.
    std::uint64_t k = 0;
    EXPECT_TRUE(hysteron::test::soon([&] {
      trace.before_step(k, program);
      trace.step(k, k, Fault::none, std::array{1.0}, std::array{1.0, 0.0}, std::array{1.0, 0.0});
      ++k;
      return !trace.is_cut();
    }));
  }
  EXPECT_EQ(hysteron::test::contents_of(scratch / "trace.1"), before);
  EXPECT_NE(hysteron::test::contents_of(scratch / "trace"), "");
}

/// Whatever room there is, what stands at the name is a trace or empty: anything else would refuse the next start. An
/// end is shorter than a head, and may find room where that found none.
TEST(Trace, AnyRoomLeavesATraceOrNothing) {
  const std::size_t whole = [] {
    const hysteron::test::ScratchFolder scratch;
    return traced_run({.file = scratch / "trace"}, 3).size();
  }();
  for (std::size_t room = 0; room <= whole; ++room) {
    const hysteron::test::ScratchFolder scratch;
    {
      const test::FileSizeLimit limit(room);
      const Accumulator program;
      Trace trace({.file = scratch / "trace"}, program);
      trace.finish();
    }
    const std::string left = hysteron::test::contents_of(scratch / "trace");
    ASSERT_TRUE(left.empty() || left.starts_with(trace_first_line)) << room << " bytes: " << left;
  }
}

/// What it keeps in memory stays within what it says, whatever comes.
TEST(Trace, MemoryBeforeATriggerIsBounded) {
  const TraceTrigger trigger{.level = 1e9, .before = 100, .after = 1};
  // A record of a step: its length and kind, number, period and fault, one input, computed and given outputs.
  EXPECT_EQ(memory_before(trigger, 1, 2), 2 * 100 * (5 + 20 + 8 * 5));
  EXPECT_EQ(memory_before({.before = 0}, 1, 2), 2 * (5 + 20 + 8 * 5));
}

TEST(Trace, WhatIsDroppedIsCountedExactlyAndTheRestReplays) {
  const hysteron::test::ScratchFolder scratch;
  // Room for some steps only, filled faster than any disk takes them.
  const auto bytes = traced_run({.file = scratch / "trace", .ring_bytes = 2000}, 200'000);
  std::vector<TraceStep> steps;
  const auto result = replayed(bytes, &steps);
  EXPECT_GT(result.dropped, 0U);
  EXPECT_EQ(steps.size() + result.dropped, 200'000U);
  EXPECT_EQ(result.steps, steps.size());
  EXPECT_EQ(result.different, 0U);
  EXPECT_EQ(result.without_state, 0U);
}

TEST(Trace, ACutFileIsReadUpToTheCutAndABrokenOneRefused) {
  const hysteron::test::ScratchFolder scratch;
  const auto bytes = traced_run({.file = scratch / "trace"}, 50);
  const std::size_t head = bytes.find("data\n") + 5;
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    Accumulator program;
    ReplayResult result;
    const auto fault = replay(std::string_view(bytes).substr(0, length), program, result);
    EXPECT_EQ(fault.empty(), length >= head) << length;
    EXPECT_FALSE(result.complete);
    EXPECT_EQ(result.different, 0U);
  }
  Accumulator program;
  ReplayResult result;
  auto broken = bytes;
  broken[head + 4] = 'Q';
  EXPECT_EQ(replay(broken, program, result),
            "a record of an unknown kind or wrong length at byte " + std::to_string(head));
  program.mutable_shape().layout = "other";
  EXPECT_EQ(replay(bytes, program, result),
            "the trace is of another diagram, or of this one before an edit (ACCUMULATOR)");
}

/// Years of cycles take the room that they are given, each file can be replayed by itself, and none lacks a step.
TEST(Trace, FilesFollowOneAnotherAndTheOldestGo) {
  for (const std::size_t ring_bytes : {std::size_t{4000}, std::size_t{4} << 20}) {  // the writer is far behind
    const hysteron::test::ScratchFolder scratch;
    const TraceSettings settings{
        .file = scratch / "trace", .ring_bytes = ring_bytes, .file_bytes = 30'000, .files = 3, .waits = true};
    (void)traced_run(settings, 20'000);
    EXPECT_EQ(scratch.names(), (std::set<std::string>{"trace", "trace.1", "trace.2"}));
    std::uint64_t next = 20'000;
    for (std::size_t number = 0; number < 3; ++number) {
      const auto file = number == 0 ? settings.file : previous_trace(settings.file, number);
      const auto bytes = hysteron::test::contents_of(file);
      EXPECT_LE(bytes.size(), 30'000U) << number;
      std::vector<TraceStep> steps;
      const auto result = replayed(bytes, &steps);
      EXPECT_EQ(result.different + result.without_state + result.dropped, 0U) << number;
      EXPECT_TRUE(result.complete) << number;
      ASSERT_FALSE(steps.empty());
      EXPECT_EQ(steps.back().number + 1, next) << number;
      next = steps.front().number;
    }
    EXPECT_LT(next, 19'300U) << "the room is used";
  }
}

/// Of 2000 cycles, the file goes after the 1000th, and that is seen before the 1500th.
void run_while_its_file_goes(Trace& trace, Accumulator& program, const std::filesystem::path& file,
                             const std::function<void()>& go) {
  Task task(program, {.loop = {.cycles = 2000}, .inputs = {{}}, .outputs = {{}, {}}}, {.trace = &trace});
  program.during_step = [&, step = 0](std::span<double>) mutable {
    if (++step == 1000) {
      EXPECT_TRUE(hysteron::test::soon([&] { return std::filesystem::file_size(file) > 1000; }));
      go();
    }
    if (step == 1500) {
      EXPECT_TRUE(hysteron::test::soon([&] { return trace.wants_next(); }));
    }
  };
  VirtualClock clock;
  const std::atomic<bool> stop{false};
  (void)task.run(clock, stop);
  trace.finish();
}

/// As logrotate does it: the name is another file's, or no file's, and the task goes on in a new one.
TEST(Trace, AFileThatIsMovedAwayIsFollowedByAnother) {
  const hysteron::test::ScratchFolder scratch;
  const TraceSettings settings{.file = scratch / "trace", .waits = true};
  Accumulator program;
  Trace trace(settings, program);
  run_while_its_file_goes(trace, program, settings.file,
                          [&] { std::filesystem::rename(settings.file, scratch / "moved"); });
  std::vector<TraceStep> before;
  std::vector<TraceStep> after;
  EXPECT_EQ(replayed(hysteron::test::contents_of(scratch / "moved"), &before).different, 0U);
  EXPECT_EQ(replayed(hysteron::test::contents_of(settings.file), &after).different, 0U);
  EXPECT_EQ(before.size() + after.size(), 2000U);
  ASSERT_FALSE(after.empty());
  EXPECT_EQ(after.back().number, 1999U);
  EXPECT_FALSE(trace.is_cut());
}

/// As the one before, and the steps of the file that is gone are told of and counted.
TEST(Trace, AFileThatIsDeletedIsSaidAndFollowedByAnother) {
  const hysteron::test::ScratchFolder scratch;
  const TraceSettings settings{.file = scratch / "trace", .waits = true};
  Accumulator program;
  Trace trace(settings, program);
  run_while_its_file_goes(trace, program, settings.file, [&] { std::filesystem::remove(settings.file); });
  std::vector<TraceStep> after;
  EXPECT_EQ(replayed(hysteron::test::contents_of(settings.file), &after).different, 0U);
  ASSERT_FALSE(after.empty());
  EXPECT_EQ(after.back().number, 1999U);
  EXPECT_EQ(trace.dropped() + after.size(), 2000U);
  EXPECT_EQ(trace.remarks().lines(),
            std::vector{fmt::format("{} was deleted, or moved to another disk, and {} steps with it. Another file is "
                                    "begun.",
                                    settings.file.string(), trace.dropped())});
  EXPECT_FALSE(trace.is_cut());
}

TEST(Trace, AFileThatIsDeletedAtTheEndIsCutShort) {
  const hysteron::test::ScratchFolder scratch;
  Accumulator program;
  Trace trace({.file = scratch / "trace"}, program);
  const std::vector<double> inputs(1);
  const std::vector<double> outputs(2);
  trace.before_step(0, program);
  trace.step(0, 0, Fault::none, inputs, outputs, outputs);
  EXPECT_TRUE(hysteron::test::soon([&] { return std::filesystem::file_size(scratch / "trace") > 200; }));
  std::filesystem::remove(scratch / "trace");
  trace.finish();
  EXPECT_TRUE(trace.is_cut());
  EXPECT_EQ(trace.dropped(), 1U);
  EXPECT_EQ(trace.problem(), (scratch / "trace") + ": somebody deleted it");
}

/// No record is written before the trigger fires, and until then nobody else is to have the name.
TEST(Trace, AFileThatIsDeletedWhileItsTriggerWaitsIsThereAgain) {
  const hysteron::test::ScratchFolder scratch;
  Accumulator program;
  const Trace trace({.file = scratch / "trace", .trigger = TraceTrigger{}}, program);
  ASSERT_TRUE(std::filesystem::remove(scratch / "trace"));
  EXPECT_TRUE(hysteron::test::soon([&] { return std::filesystem::exists(scratch / "trace"); }));
  EXPECT_FALSE(trace.wants_next()) << "a state at each step would fill the memory of steps before";
  EXPECT_THROW(TraceOutput(scratch / "trace"), std::system_error);
}

TEST(Trace, AFileThatTakesNoMoreEndsWithAWholeStepAndTheRestIsCounted) {
  const hysteron::test::ScratchFolder scratch;
  const std::size_t record = 5 + 20 + 5 * 8;
  const std::size_t end = 5 + 16;
  const auto whole = traced_run({.file = scratch / "whole"}, 5000).size();
  // Room for a thousand steps, and for a part of one in which the end has room.
  const test::FileSizeLimit limit(whole - end - 4000 * record + end + 3);
  Accumulator program;
  Trace trace({.file = scratch / "trace"}, program);
  Task task(program, {.loop = {.cycles = 5000}, .inputs = {{}}, .outputs = {{}, {}}}, {.trace = &trace});
  program.during_step = [&, step = 0](std::span<double>) mutable {
    EXPECT_TRUE(++step < 4000 || hysteron::test::soon([&] { return trace.is_cut(); }));
  };
  VirtualClock clock;
  const std::atomic<bool> stop{false};
  (void)task.run(clock, stop);
  trace.finish();
  EXPECT_EQ(trace.problem(), (scratch / "trace") + ": File too large");
  EXPECT_EQ(trace.dropped(), 4000U);
  EXPECT_EQ(test::value(task.door(), "task.write_failures"), 1.0);
  const auto result = replayed(hysteron::test::contents_of(scratch / "trace"));
  EXPECT_EQ(result.steps, 1000U);
  EXPECT_EQ(result.dropped, 4000U);
  EXPECT_EQ(result.different, 0U);
  EXPECT_TRUE(result.complete);
}

/// A folder on a disk that is not there yet, or that has become read-only: the task starts, and the trace when it can.
TEST(Trace, WhatMayPassRefusesNoStart) {
  const hysteron::test::ScratchFolder scratch;
  const Accumulator program;
  const Trace trace({.file = scratch / "later/trace"}, program);
  EXPECT_TRUE(trace.is_cut());
  EXPECT_EQ(trace.problem(), (scratch / "later/trace") + ": No such file or directory");
  const std::string disk = scratch.path();
  hysteron::test::with_own_disk(disk, "nr_inodes=100", [&] {
    const auto before = traced_run({.file = disk + "/trace"}, 50);
    hysteron::test::change_disk(disk, "nr_inodes=100", true);
    const Trace cut({.file = disk + "/trace"}, program);
    EXPECT_TRUE(cut.is_cut());
    EXPECT_EQ(cut.problem(), disk + "/trace: Read-only file system");
    EXPECT_EQ(hysteron::test::contents_of(disk + "/trace"), before);
  });
}

TEST(Trace, AFileThatCannotBeOpenedIsSaid) {
  const Accumulator program;
  EXPECT_THROW(Trace({.file = "/dev/full"}, program), std::system_error);
  EXPECT_THROW(Trace({.file = "/dev/null/trace"}, program), std::system_error);
  const hysteron::test::ScratchFolder scratch;
  EXPECT_THROW(Trace({.file = scratch.path()}, program), std::system_error);
  scratch.write("trace", "of the run before");
  std::filesystem::create_directories(scratch / "trace.1");
  try {
    const Trace trace({.file = scratch / "trace"}, program);
    ADD_FAILURE() << "the trace before it could not be kept";
  } catch (const std::system_error& problem) {
    EXPECT_EQ(problem.what(), (scratch / "trace.1") + ": Is a directory");
  }
  EXPECT_EQ(hysteron::test::contents_of(scratch / "trace"), "of the run before");
}

}  // namespace
}  // namespace hysteron::runtime
