// A state that is not finite is gone on from nowhere: the task takes the last that was.
#include "runtime/task/sound_state.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <limits>
#include <string>
#include <vector>

#include "runtime/task/task.hpp"
#include "runtime/task/trace_file.hpp"
#include "tests/runtime/task/integrators.hpp"
#include "tests/support/scratch_folder.hpp"

namespace hysteron::runtime {
namespace {

using test::Integrators;

constexpr std::uint64_t first_bad = 10;
constexpr std::uint64_t first_good = 15;

/// 1, and for some cycles so much that an integrator behind a gain of 100 has no number for it.
class Surge final : public FieldIo {
 public:
  Fault read(std::span<double> inputs) noexcept override {
    inputs[0] = k_ >= first_bad && k_ < first_good ? 1.7e308 : 1.0;
    ++k_;
    return Fault::none;
  }
  void write(std::span<const double> outputs) noexcept override { written.push_back(outputs[0]); }
  std::vector<double> written{};

 private:
  std::uint64_t k_ = 0;
};

TaskSettings settings_of(std::uint64_t cycles) {
  return {.loop = {.cycles = cycles}, .inputs = {{.from_device = true}}, .outputs = {{.value = -1.0}}};
}

/// The rest of a run that began well goes on as if nothing had been; the trace of it replays to the bit.
TEST(SoundState, AFaultOfTheStateEndsWithTheCauseAndTheTraceReplays) {
  const hysteron::test::ScratchFolder scratch;
  Integrators program({{.name = "I", .gain = 100.0}});
  Surge field;
  FaultReport faults;
  {
    Trace trace({.file = scratch / "trace"}, program);
    Task task(program, settings_of(30), {.field = &field, .trace = &trace});
    VirtualClock clock;
    const std::atomic<bool> stop{false};
    (void)task.run(clock, stop);
    faults = task.faults();
    EXPECT_EQ(task.fault(), Fault::stop) << "no fault holds at the end";
  }
  for (std::uint64_t k = 0; k < 30; ++k) {
    const bool is_bad = k >= first_bad && k < first_good;
    const std::uint64_t good_steps = k < first_bad ? k + 1 : k + 1 - (first_good - first_bad);
    EXPECT_EQ(field.written.at(k), is_bad ? -1.0 : 100.0 * static_cast<double>(good_steps)) << k;
  }
  EXPECT_EQ(faults.count, 1U);
  EXPECT_EQ(faults.last, Fault::not_finite);
  Integrators again({{.name = "I", .gain = 100.0}});
  ReplayResult result;
  EXPECT_EQ(replay(hysteron::test::contents_of(scratch / "trace"), again, result), "");
  EXPECT_EQ(result.steps, 30U);
  EXPECT_EQ(result.different, 0U);
}

std::vector<double> stepped(Integrators& program, double x) {
  std::vector<double> outputs(1);
  program.step(std::vector{x}, outputs);
  std::vector<double> sums(program.shape().inner.size());
  program.inner_values(sums);
  return sums;
}

constexpr double too_much = 1.7e308;

/// What else the diagram controls has no part in it.
TEST(SoundState, OtherPartsOfTheDiagramGoOn) {
  Integrators program({{.name = "BROKEN", .gain = 100.0}, {.name = "SOUND", .gain = 1e-308}});
  SoundState sound(program);
  (void)stepped(program, 1e306);
  EXPECT_FALSE(sound.follow(program, true));
  for (int k = 0; k < 5; ++k) {
    (void)stepped(program, too_much);
    EXPECT_TRUE(sound.follow(program, false)) << k;
  }
  const auto sums = stepped(program, 0.0);
  EXPECT_EQ(sums[0], 1e308);
  EXPECT_NEAR(sums[1], 0.01 + 5 * 1.7, 1e-12);
}

/// What a reset has just begun is not undone.
TEST(SoundState, AfterAResetItIsThatOfTheReset) {
  Integrators program({{.name = "I", .gain = 100.0}});
  SoundState sound(program);
  (void)stepped(program, 1.0);
  EXPECT_FALSE(sound.follow(program, true));
  program.reset();
  sound.begin_with(program);
  (void)stepped(program, too_much);
  EXPECT_TRUE(sound.follow(program, false));
  EXPECT_EQ(stepped(program, 1.0), std::vector{100.0});
}

/// An output may be no number though the state is sound, as behind a division, and the other way round.
TEST(SoundState, OnlyAStateThatAnOutputShowsIsMended) {
  Integrators program({{.name = "I", .gain = 100.0}});
  SoundState sound(program);
  (void)stepped(program, 1.0);
  EXPECT_FALSE(sound.follow(program, false));
  EXPECT_EQ(stepped(program, 1.0), std::vector{200.0});
  (void)stepped(program, too_much);
  EXPECT_FALSE(sound.follow(program, true)) << "behind a limit";
  EXPECT_EQ(stepped(program, 0.0), std::vector{std::numeric_limits<double>::infinity()});
  EXPECT_TRUE(sound.follow(program, false));
  EXPECT_EQ(stepped(program, 0.0), std::vector{100.0}) << "as it was when it was last looked at and finite";
}

/// Its numbers are looked at but now and then, and at once where an output is no number.
TEST(SoundState, ALargeStateIsLookedAtMoreRarely) {
  std::vector<test::Integrator> many(500, {.gain = 100.0});
  for (std::size_t i = 0; i < many.size(); ++i) {
    many[i].name = "I" + std::to_string(i);
  }
  Integrators program(many);
  SoundState sound(program);
  for (int k = 0; k < 7; ++k) {
    (void)stepped(program, 1.0);
    EXPECT_FALSE(sound.follow(program, true));
  }
  (void)stepped(program, too_much);
  EXPECT_TRUE(sound.follow(program, false));
  EXPECT_EQ(stepped(program, 0.0), std::vector<double>(500, 500.0)) << "of the fifth step: one of four, at 4,008 bytes";
  (void)stepped(program, too_much);
  EXPECT_FALSE(sound.follow(program, false)) << "not again so soon";
  EXPECT_FALSE(sound.follow(program, false));
  EXPECT_FALSE(sound.follow(program, false));
  EXPECT_TRUE(sound.follow(program, false));
}

/// An infinite number that a program begins with is no fault of it.
TEST(SoundState, WhatIsInfiniteByItselfIsLeftAlone) {
  Integrators program({{.name = "I", .gain = 1.0}});
  program.resets_to = std::numeric_limits<double>::infinity();
  program.reset();
  SoundState sound(program);
  (void)stepped(program, 1.0);
  EXPECT_FALSE(sound.follow(program, false));
}

}  // namespace
}  // namespace hysteron::runtime
