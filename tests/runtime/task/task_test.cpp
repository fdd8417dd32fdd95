// A task as a whole, on the virtual clock: orders, faults, points, and the way to the safe values.
#include "runtime/task/task.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "tests/runtime/task/linked_sets.hpp"
#include "tests/runtime/task/slow_clock.hpp"

namespace hysteron::runtime {
namespace {

using test::Accumulator;

TaskSettings settings(std::uint64_t cycles) {
  return {.loop = {.cycles = cycles}, .inputs = {{}}, .outputs = {{.low = -50.0, .high = 50.0, .value = -1.0}, {}}};
}

void write(TaskDoor& door, std::initializer_list<std::pair<const char*, double>> values, const std::string& refusal) {
  std::vector<PointWrite> writes;
  for (const auto& [name, value] : values) {
    writes.push_back({test::point(door, name), value});
  }
  EXPECT_EQ(door.write(writes), refusal);
}

/// Runs so many more cycles.
void run(Task& task) {
  VirtualClock clock;
  const std::atomic<bool> stop{false};
  (void)task.run(clock, stop);
}

class Field final : public FieldIo {
 public:
  Fault read(std::span<double> inputs) noexcept override {
    inputs[0] = input;
    return fault;
  }
  void write(std::span<const double> outputs) noexcept override { written.push_back(outputs[0]); }
  [[nodiscard]] bool is_awaited() const noexcept override { return awaited; }
  [[nodiscard]] std::size_t absent() const noexcept override { return fault != Fault::none && !awaited ? 1 : 0; }
  double input = 1.0;
  Fault fault = Fault::none;
  bool awaited = false;
  std::vector<double> written;
};

/// Takes a while to hand on what was written, or for ever.
class SlowField final : public FieldIo {
 public:
  explicit SlowField(int cycles) : cycles_(cycles) {}
  Fault read(std::span<double> /*inputs*/) noexcept override { return Fault::none; }
  void write(std::span<const double> /*outputs*/) noexcept override {}
  Delivery delivery() noexcept override { return --cycles_ < 0 ? Delivery::done : Delivery::pending; }

 private:
  int cycles_;
};

TEST(Task, WaitsAtItsEndUntilTheSafeValuesHaveArrivedAndSaysWhereTheyDidNot) {
  Accumulator program;
  SlowField slow(500);
  Task task(program, settings(100), {.field = &slow});
  run(task);
  EXPECT_EQ(task.fault(), Fault::stop);
  SlowField dead(1'000'000'000);
  Task lost(program, settings(100), {.field = &dead});
  run(lost);
  EXPECT_EQ(lost.fault(), Fault::lost_link);
}

TEST(Task, EndsOnceTheSlowestRampHasArrivedHoweverLongThatTakes) {
  Accumulator program;
  Field field;
  auto slow = settings(100);
  slow.outputs[0].action = SafeAction::ramp;
  slow.outputs[0].ramp = 1.0;
  slow.outputs[0].hold_cycles = 5000;
  Task task(program, slow, {.field = &field});
  run(task);
  EXPECT_EQ(field.written.back(), -1.0);
  EXPECT_NEAR(static_cast<double>(field.written.size()), 100 + 5000 + 51'000, 1.0) << "from 50 to -1 at 1 a second";
  EXPECT_EQ(task.fault(), Fault::stop);
  EXPECT_GE(task.beats(), field.written.size()) << "what watches it sees that it lives";
}

TEST(Task, SaysWhereASafeValueIsOutOfReach) {
  Accumulator program;
  Field field;
  field.input = 1e17;
  auto lost = settings(1);
  lost.outputs[0] = {.action = SafeAction::ramp, .hold_cycles = 10, .value = -1.0, .ramp = 1.0};
  Task task(program, lost, {.field = &field});
  run(task);
  EXPECT_EQ(task.fault(), Fault::not_safe);
  EXPECT_EQ(test::value(task.door(), "task.fault"), static_cast<double>(Fault::not_safe));
}

TEST(Task, AFaultThatHoldsAtTheEndIsNotForgotten) {
  for (const Fault fault : {Fault::stale_input, Fault::lost_link}) {
    Accumulator program;
    Field field;
    field.fault = fault;
    Task task(program, settings(10), {.field = &field});
    run(task);
    EXPECT_EQ(task.fault(), fault);
    EXPECT_EQ(test::value(task.door(), "task.fault"), static_cast<double>(fault));
    field.fault = Fault::none;
    run(task);
    EXPECT_EQ(task.fault(), Fault::stop) << "it was over before the end";
  }
}

TEST(Task, CountsFaultsAndKeepsTheNewestOfThem) {
  Accumulator program;
  Field field;
  Task task(program, settings(40), {.field = &field});
  const std::vector<Fault> faults{Fault::none, Fault::lost_link, Fault::none, Fault::stale_input};
  std::vector<double> states;
  program.during_step = [&, step = 0U](std::span<double> outputs) mutable {
    states.push_back(test::value(task.door(), "task.state"));
    field.fault = faults[++step / 5 % 4];
    outputs[0] = step == 12 ? std::numeric_limits<double>::infinity() : outputs[0];
  };
  run(task);
  // Twice lost, twice stale, once not finite.
  const FaultReport report = task.faults();
  EXPECT_EQ(report.count, 5U);
  EXPECT_EQ(test::value(task.door(), "task.faults"), 5.0);
  EXPECT_EQ(report.last, Fault::stale_input);
  EXPECT_EQ(test::value(task.door(), "task.last_fault"), static_cast<double>(Fault::stale_input));
  EXPECT_EQ(std::count(states.begin(), states.end(), 2.0), 20)
      << "faulted while one holds, but for the last cycle, which is not seen";
}

TEST(Task, AFaultIsOfAnInputOrAnOutput) {
  Accumulator program;
  Task task(program, settings(3), {});
  program.during_step = [&](std::span<double> outputs) { outputs[1] = std::numeric_limits<double>::quiet_NaN(); };
  run(task);
  EXPECT_EQ(task.faults(), (FaultReport{.fault = Fault::not_finite, .last = Fault::not_finite, .port = 2, .count = 1}));
  Field field;
  field.input = std::numeric_limits<double>::quiet_NaN();
  Accumulator sound;
  Task stale(sound, settings(3), {.field = &field});
  run(stale);
  EXPECT_EQ(stale.faults(),
            (FaultReport{.fault = Fault::stale_input, .last = Fault::stale_input, .port = 0, .count = 1}));
}

TEST(Task, RunsTheProgramAndEndsInSafeOutputs) {
  Accumulator program;
  Field field;
  Task task(program, settings(100), {.field = &field});
  run(task);
  ASSERT_EQ(field.written.size(), 101U);
  for (std::size_t i = 0; i < 100; ++i) {
    EXPECT_EQ(field.written[i], std::min(50.0, static_cast<double>(i + 1)));
  }
  EXPECT_EQ(field.written.back(), -1.0);
  EXPECT_EQ(test::value(task.door(), "task.cycles"), 100.0);
  EXPECT_EQ(test::value(task.door(), "task.elapsed"), 100.0);
  EXPECT_EQ(test::value(task.door(), "task.state"), 3.0);
}

TEST(Task, ParametersAreStagedAndAppliedAsASet) {
  Accumulator program;
  Task task(program, settings(1), {});
  TaskDoor& door = task.door();
  write(door, {{"G.A", 7.0}}, "");
  EXPECT_EQ(test::value(door, "G.A"), 7.0);
  run(task);
  EXPECT_EQ(program.parameter(0), 1.0);  // staged is not applied
  write(door, {{"G.B", 2e9}, {"task.commit", 1.0}}, "G.B must be at most 1000000000.");
  run(task);
  EXPECT_EQ(program.parameter(0), 1.0);
  EXPECT_EQ(program.parameter(1), -1.0);
  EXPECT_EQ(test::value(door, "G.B"), -1.0);  // nothing of a refused write is kept
  write(door, {{"task.commit", 1.0}, {"G.B", 3.0}}, "");
  run(task);
  EXPECT_EQ(program.parameter(0), 7.0);
  EXPECT_EQ(program.parameter(1), 3.0);
  EXPECT_EQ(test::value(door, "task.commits"), 1.0);
  write(door, {{"G.A", 9.0}}, "");
  write(door, {{"task.discard", 1.0}}, "");
  EXPECT_EQ(test::value(door, "G.A"), 7.0);
  // The sum was kept through all of it: three steps of 1, 1 and 7.
  EXPECT_EQ(task.outputs()[0], -1.0);
  std::array<std::byte, 8> state{};
  program.save(state);
  double sum = 0.0;
  std::memcpy(&sum, state.data(), 8);
  EXPECT_EQ(sum, 9.0);
}

TEST(Task, ASetThatNoSingleRangeRefusesIsRefusedByTheRelationsOfItsProgram) {
  Accumulator program;  // G.A = 1, G.B = -1
  const RelatedNumber a{.parameter = 0};
  const RelatedNumber b{.parameter = 1};
  program.mutable_shape().relations = {{.numbers = {b, a}, .strictly = true},
                                       {.numbers = {a, {.constant = 7.0}}},
                                       {.numbers = {{.constant = -9.0}, b, {.constant = -20.0}}, .count = a}};
  Task task(program, settings(1), {});
  TaskDoor& door = task.door();
  write(door, {{"G.A", -1.0}, {"task.commit", 1.0}}, "G.A = -1 must be above G.B = -1.");
  write(door, {{"G.A", -3.0}, {"G.B", -4.0}, {"task.commit", 1.0}}, "G.B = -4 must be at most -20.");
  write(door, {{"G.A", 7.5}, {"task.commit", 1.0}}, "G.A = 7.5 must be at most 7.");
  write(door, {{"G.A", 2.0}, {"G.B", -9.5}, {"task.commit", 1.0}}, "G.B = -9.5 must be at least -9.");
  write(door, {{"G.A", 2.0}, {"G.B", -8.5}, {"task.commit", 1.0}}, "");
  run(task);
  EXPECT_EQ(program.parameter(1), -8.5);
  EXPECT_EQ(test::value(door, "task.commits"), 1.0) << "nothing of what was refused";
}

TEST(Task, WhatACommitLeavesAsItIsDoesNotRefuseIt) {
  Accumulator program;
  program.set_parameter(1, std::numeric_limits<double>::infinity());  // as a bound that is not set
  program.mutable_shape().relations = {{.numbers = {{.parameter = 1}, {.constant = 0.0}}}};
  Task task(program, settings(1), {});
  write(task.door(), {{"G.A", 5.0}, {"task.commit", 1.0}}, "");
  run(task);
  EXPECT_EQ(program.parameter(0), 5.0);
}

TEST(Task, AWriteIsTakenWholeOrNotAtAll) {
  Accumulator program;
  Task task(program, settings(1), {});
  write(task.door(), {{"X", 5.0}, {"Y", 1.0}}, "Y can only be read.");
  EXPECT_EQ(test::value(task.door(), "X"), 1.0);
  write(task.door(), {{"X", 5.0}, {"task.heartbeat", 77.0}}, "");
  run(task);
  EXPECT_EQ(test::value(task.door(), "X"), 5.0);
  EXPECT_EQ(test::value(task.door(), "task.heartbeat"), 77.0);

  auto device = settings(1);
  device.inputs[0].from_device = true;
  Task other(program, device, {});
  EXPECT_FALSE(other.door().points()[0].writable);
  write(other.door(), {{"X", 5.0}}, "X is given by a device.");
}

TEST(Task, LinkedSetsAreNeverTorn) {
  const auto result = test::commit_linked_sets(20'000);
  EXPECT_EQ(result.committed, 20'000U);
  EXPECT_EQ(result.torn, 0U);
  EXPECT_GT(result.applied, 1U);
}

TEST(Task, FaultsOfTheFieldMakeTheOutputsSafeWhileTheyLast) {
  for (const Fault fault : {Fault::stale_input, Fault::lost_link}) {
    Accumulator program;
    Field field;
    Task task(program, settings(1), {.field = &field});
    run(task);
    EXPECT_EQ(field.written[0], 1.0);
    field.fault = fault;
    run(task);
    EXPECT_EQ(field.written[2], -1.0);
    field.fault = Fault::none;
    run(task);
    EXPECT_EQ(field.written[4], 3.0);  // the program went on
  }
}

/// Until the first exchange the outputs are safe, and no fault has begun; another fault is one at once.
TEST(Task, WhatIsAwaitedAtTheStartIsNoFault) {
  Accumulator program;
  Field field;
  field.fault = Fault::lost_link;
  field.awaited = true;
  Task task(program, settings(1), {.field = &field});
  program.during_step = [&](std::span<double>) { field.awaited = field.written.size() < 5; };
  Task lost(program, settings(8), {.field = &field});
  run(task);
  EXPECT_EQ(field.written.front(), -1.0);
  EXPECT_EQ(test::value(task.door(), "task.faults"), 0.0);
  EXPECT_EQ(task.fault(), Fault::stop);
  run(lost);
  EXPECT_EQ(lost.faults().count, 1U) << "it went on after its time";
  EXPECT_EQ(test::value(task.door(), "task.shortages"), 0.0);
  EXPECT_EQ(test::value(lost.door(), "task.shortages"), 8.0) << "a device never answered";
  field.awaited = true;
  program.during_step = {};
  Task client(program, settings(1), {.field = &field});
  client.client_lost(true);
  run(client);
  EXPECT_EQ(client.faults().last, Fault::lost_client);
}

TEST(Task, AnInputThatIsNoNumberNeverReachesTheProgram) {
  Accumulator program;
  Field field;
  Task task(program, settings(1), {.field = &field});
  run(task);
  field.input = std::numeric_limits<double>::quiet_NaN();
  run(task);
  EXPECT_EQ(field.written[2], -1.0);
  field.input = 1.0;
  run(task);
  EXPECT_EQ(field.written[4], 3.0);
}

TEST(Task, AnInputThatNobodyWritesBecomesStale) {
  Accumulator program;
  Field field;
  auto with_age = settings(10);
  with_age.inputs[0].longest_age = 5;
  with_age.outputs[0].high = 1e9;
  Accumulator plain;
  Task task(plain, with_age, {});
  write(task.door(), {{"X", 2.0}}, "");
  std::vector<double> faults;
  plain.during_step = [&](std::span<double>) { faults.push_back(test::value(task.door(), "task.fault")); };
  run(task);
  // Seen one step later: ages 0 to 5 are well.
  EXPECT_EQ(faults, (std::vector<double>{0, 0, 0, 0, 0, 0, 0, 4, 4, 4}));
}

TEST(Task, AnOutputThatIsNoNumberIsSafeByItself) {
  Accumulator program;
  Field field;
  Task task(program, settings(3), {.field = &field});
  int step = 0;
  program.during_step = [&](std::span<double> outputs) {
    if (++step == 2) {
      outputs[0] = std::numeric_limits<double>::infinity();
    }
  };
  run(task);
  EXPECT_EQ(field.written, (std::vector<double>{1.0, -1.0, 3.0, -1.0}));
}

TEST(Task, ATrippedWatchdogLastsUntilTheReset) {
  Accumulator program;
  test::SlowClock clock;
  Field field;
  auto with_watchdog = settings(6);
  with_watchdog.watchdog = {.time = 500'000, .sensitivity = 1};
  Task task(program, with_watchdog, {.field = &field});
  int step = 0;
  program.during_step = [&](std::span<double>) { clock.pass(++step == 2 ? 600'000 : 100); };
  std::atomic<bool> stop{false};
  (void)task.run(clock, stop);
  EXPECT_EQ(field.written, (std::vector<double>{1.0, 2.0, -1.0, -1.0, -1.0, -1.0, -1.0}));
  EXPECT_EQ(step, 2);  // not stepped any more
  EXPECT_EQ(test::value(task.door(), "task.state"), 2.0);
  EXPECT_EQ(test::value(task.door(), "task.fault"), 1.0);
}

TEST(Task, AResetClearsStateAndFaultAndKeepsParameters) {
  Accumulator program;
  Task task(program, settings(4), {});
  write(task.door(), {{"G.A", 10.0}, {"task.commit", 1.0}}, "");
  run(task);
  write(task.door(), {{"task.reset", 1.0}}, "");
  auto once = settings(1);
  run(task);
  std::array<std::byte, 8> state{};
  program.save(state);
  double sum = 0.0;
  std::memcpy(&sum, state.data(), 8);
  EXPECT_EQ(sum, 10.0);  // one step after the reset: the loop counts its cycles from the first start
}

TEST(Task, TellsHowLongACertificateCounts) {
  test::Accumulator program;
  Task task(program, {.loop = {.cycles = 1}, .inputs = {{}}, .outputs = {{}, {}}});
  const auto days = [&] {
    VirtualClock clock;
    const std::atomic<bool> stop{false};
    (void)task.run(clock, stop);
    return test::value(task.door(), "task.tls_days");
  };
  EXPECT_EQ(days(), 65535.0) << "there is none";
  task.tls_days(29);
  EXPECT_EQ(days(), 29.0);
}

}  // namespace
}  // namespace hysteron::runtime
