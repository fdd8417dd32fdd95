// Retained values of an edited diagram: what has the same name, type and unit is taken over, and the rest is said.
#include "runtime/task/carry.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "runtime/task/retain.hpp"
#include "tests/runtime/task/accumulator.hpp"
#include "tests/support/soon.hpp"

namespace hysteron::runtime {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr double infinite = std::numeric_limits<double>::infinity();

ProgramShape before() {
  return {.parameters = {{.name = "HYST.C1", .unit = "um/V"}, {.name = "L.MX", .unit = "V"}, {.name = "OLD.K"}},
          .state = {{.name = "HYST.P", .block = "HY_HYSTERESIS_RO", .unit = "um", .offset = 8},
                    {.name = "LINE.X", .block = "HY_DEAD_TIME", .unit = "V", .length = 3, .offset = 16},
                    {.name = "N.CV", .block = "HY_CTU", .type = PointType::int32, .offset = 40},
                    {.name = "N.Q", .block = "HY_CTU", .type = PointType::boolean, .offset = 44},
                    {.name = "STEPS", .unit = "of 4 steps", .type = PointType::int32, .offset = 48},
                    {.name = "OLD.Y", .block = "HY_LAG", .unit = "V", .offset = 56}}};
}
constexpr std::size_t size_before = 64;

template <class T>
void put(std::vector<std::byte>& bytes, std::size_t at, T value) {
  std::memcpy(bytes.data() + at, &value, sizeof(T));
}
template <class T>
T get(const std::vector<std::byte>& bytes, std::size_t at) {
  T value{};
  std::memcpy(&value, bytes.data() + at, sizeof(T));
  return value;
}

std::vector<std::byte> state_before() {
  std::vector<std::byte> bytes(size_before);
  put(bytes, 8, 1.25);
  for (std::size_t i = 0; i < 3; ++i) {
    put(bytes, 16 + 8 * i, 0.5 + static_cast<double>(i));
  }
  put(bytes, 40, std::int32_t{-7});
  put(bytes, 44, true);
  put(bytes, 48, std::int32_t{3});
  put(bytes, 56, 9.0);
  return bytes;
}

TEST(Carry, ADescriptionComesBackAsItWas) {
  const KeptLayout kept = read_description(describe(before()), size_before);
  ASSERT_EQ(kept.parameters.size(), 3U);
  EXPECT_EQ(kept.parameters[1].name, "L.MX");
  EXPECT_EQ(kept.parameters[1].unit, "V");
  ASSERT_EQ(kept.state.size(), before().state.size());
  EXPECT_EQ(describe({.parameters = before().parameters, .state = kept.state}), describe(before()));
}

/// Files may be of anyone: whatever a description says, nothing beyond the bytes is read.
TEST(Carry, ADescriptionOfWhatIsNotThereIsNone) {
  const std::string whole = describe(before());
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const KeptLayout kept = read_description(whole.substr(0, size), size_before);
    EXPECT_TRUE(whole[size == 0 ? 0 : size - 1] == '\n' || size == 0 || kept.state.empty()) << size;
  }
  for (const char* const text :
       {"s\tA\tB\tLREAL\t1\t57\t\n", "s\tA\tB\tLREAL\t9\t0\t\n", "s\tA\tB\tLREAL\t18446744073709551615\t8\t\n",
        "s\tA\tB\tLREAL\t1\t18446744073709551612\t\n", "s\tA\tB\tLREAL\t-1\t0\t\n", "s\tA\tB\tSTRING\t1\t0\t\n",
        "p\tA\tLREAL\n", "x\n", "\n", "s\n"}) {
    const KeptLayout kept = read_description(text, size_before);
    EXPECT_THAT(kept.state, IsEmpty()) << text;
    EXPECT_THAT(kept.parameters, IsEmpty()) << text;
  }
}

TEST(Carry, TakesOverWhatIsStillTheSame) {
  const KeptLayout kept = read_description(describe(before()), size_before);
  const ProgramShape after{
      .parameters = {{.name = "NEW.K"},
                     {.name = "L.MX", .unit = "V", .high = 4.0},
                     {.name = "HYST.C1", .unit = "um/V"}},
      .state = {
          {.name = "STEPS", .unit = "of 4 steps", .type = PointType::uint64, .offset = 0},
          {.name = "LINE.X", .block = "HY_DEAD_TIME", .unit = "V", .type = PointType::real32, .length = 3, .offset = 8},
          {.name = "N.Q", .block = "HY_CTU", .type = PointType::boolean, .offset = 20},
          {.name = "N.CV", .block = "HY_CTU", .type = PointType::int32, .offset = 24},
          {.name = "HYST.P", .block = "HY_HYSTERESIS_RO", .unit = "um", .offset = 32},
          {.name = "F.Y", .block = "HY_LAG", .offset = 40}}};
  CarriedValues carried = carry_parameters(kept, std::vector{1.5, 5.0, 2.0}, after, std::vector{10.0, 3.0, 0.1});
  EXPECT_THAT(carried.parameters, ElementsAre(10.0, 3.0, 1.5));
  EXPECT_EQ(carried.parameters_taken, 1U);
  EXPECT_THAT(carried.left, ElementsAre("NEW.K (new)", "L.MX (5 is outside of its limits)", "OLD.K (gone)"));
  carried.left.clear();
  std::vector<std::byte> state(48);
  put(state, 40, 77.0);
  carry_state(kept, state_before(), after, state, carried);
  EXPECT_EQ(get<std::uint64_t>(state, 0), 3U);
  EXPECT_EQ(get<float>(state, 8), 0.5F);
  EXPECT_EQ(get<float>(state, 16), 2.5F);
  EXPECT_TRUE(get<bool>(state, 20));
  EXPECT_EQ(get<std::int32_t>(state, 24), -7);
  EXPECT_EQ(get<double>(state, 32), 1.25);
  EXPECT_EQ(get<double>(state, 40), 77.0) << "as after the reset";
  EXPECT_EQ(carried.states_taken, 5U);
  EXPECT_THAT(carried.left, ElementsAre("F.Y (new)", "OLD.Y (gone)"));
}

TEST(Carry, WhatHasBecomeSomethingElseIsLeftAndSaid) {
  const KeptLayout kept = read_description(describe(before()), size_before);
  std::vector<std::byte> from = state_before();
  put(from, 24, infinite);
  const ProgramShape after{
      .parameters = {{.name = "HYST.C1", .unit = "mm/V"}, {.name = "L.MX", .unit = "V", .type = PointType::boolean}},
      .state = {{.name = "HYST.P", .block = "HY_LAG", .unit = "um"},
                {.name = "LINE.X", .block = "HY_DEAD_TIME", .unit = "V", .length = 3, .offset = 8},
                {.name = "N.CV", .block = "HY_CTU", .offset = 32},
                {.name = "STEPS", .unit = "of 6 steps", .type = PointType::int32, .offset = 40},
                {.name = "OLD.Y", .block = "HY_LAG", .offset = 48}}};
  CarriedValues carried = carry_parameters(kept, std::vector{1.5, 5.0, 2.0}, after, std::vector{0.1, 0.0});
  std::vector<std::byte> state(56);
  const std::vector<std::byte> untouched = state;
  carry_state(kept, from, after, state, carried);
  EXPECT_EQ(state, untouched);
  EXPECT_EQ(carried.states_taken + carried.parameters_taken, 0U);
  EXPECT_THAT(carried.left, ElementsAre("HYST.C1 (um/V there, mm/V here)", "L.MX (LREAL there, BOOL here)",
                                        "OLD.K (gone)", "HYST.P (of HY_HYSTERESIS_RO there, of HY_LAG here)",
                                        "N.CV (DINT there, LREAL here)", "STEPS (of 4 steps there, of 6 steps here)",
                                        "OLD.Y (V there, no unit here)", "N.Q (gone)", "LINE.X (not finite)"));
}

TEST(Carry, WhatIsNewIsToldFromWhatIsOtherwiseLeft) {
  EXPECT_TRUE(is_new("NEW.K (new)"));
  for (const char* const other :
       {"L.MX (5 is outside of its limits)", "OLD.K (gone)", "NEW.K", "A (newer there, b here)"}) {
    EXPECT_FALSE(is_new(other)) << other;
  }
  EXPECT_EQ(without_reason("L.MX (5 is outside of its limits)"), "L.MX");
}

TEST(Carry, RetainedInputsAreFoundByNameTypeUnitAndLimits) {
  const ProgramShape was{.inputs = {{.name = "A", .unit = "V"},
                                    {.name = "SPEED", .unit = "rpm"},
                                    {.name = "ON", .type = PointType::boolean},
                                    {.name = "MM", .unit = "mm"},
                                    {.name = "HIGH"}}};
  const std::vector<std::size_t> kept_inputs{1, 2, 3, 4};
  const KeptLayout kept = read_description(describe(was, kept_inputs), 0);
  const ProgramShape is{.inputs = {{.name = "HIGH", .high = 1.0},
                                   {.name = "ON", .type = PointType::boolean},
                                   {.name = "MM", .unit = "um"},
                                   {.name = "A", .unit = "V"},
                                   {.name = "SPEED", .unit = "rpm"}}};
  std::vector<std::string> left;
  const auto starts =
      carry_inputs(kept, std::vector{1500.0, 1.0, 2.0, 5.0}, is, std::vector<std::size_t>{0, 1, 2, 3}, left);
  EXPECT_THAT(starts, ElementsAre(std::nullopt, std::optional(1.0), std::nullopt, std::nullopt, std::nullopt))
      << "A was not retained, and SPEED is not to be";
  EXPECT_THAT(left, ElementsAre("HIGH (5 is outside of its limits)", "MM (mm there, um here)"));
}

TEST(Carry, ARetainedInputIsFoundWithoutRegardToCaseAndTheGoneAreSaid) {
  const ProgramShape was{.inputs = {{.name = "Y_REF", .unit = "mm"}, {.name = "OLD"}}};
  const KeptLayout kept = read_description(describe(was, std::vector<std::size_t>{0, 1}), 0);
  const ProgramShape is{.inputs = {{.name = "y_ref", .unit = "mm"}}};
  std::vector<std::string> left;
  EXPECT_THAT(carry_inputs(kept, std::vector{0.5, 2.0}, is, std::vector<std::size_t>{0}, left),
              ElementsAre(std::optional(0.5)));
  EXPECT_THAT(left, ElementsAre("OLD (gone)"));
}

/// The layout of a diagram does not say its units: bytes that fit mean something else then.
TEST(Carry, AnotherUnitOfTheSameValueIsSaid) {
  const auto whole = [] {
    ProgramShape shape = before();
    shape.inputs = {{.name = "X", .unit = "mm"}};
    return shape;
  };
  const std::vector<std::size_t> retained{0};
  const KeptLayout kept = read_description(describe(whole(), retained), size_before);
  EXPECT_EQ(other_unit(kept, whole(), retained), "");
  ProgramShape edited = whole();
  edited.parameters[0].unit = "mm/V";
  EXPECT_EQ(other_unit(kept, edited, retained), "HYST.C1 is in um/V there, mm/V here");
  edited = whole();
  edited.state[0].unit = "";
  EXPECT_EQ(other_unit(kept, edited, retained), "HYST.P is in um there, no unit here");
  edited = whole();
  edited.inputs[0].unit = "um";
  EXPECT_EQ(other_unit(kept, edited, retained), "X is in mm there, um here");
  EXPECT_EQ(other_unit(kept, edited, {}), "") << "an input that is not to be retained";
  edited.inputs[0].name = "Z";
  EXPECT_EQ(other_unit(kept, edited, retained), "");
  EXPECT_EQ(other_unit({}, edited, retained), "") << "a file of before there were names in it";
}

/// A delay of so many steps is another time then.
TEST(Carry, TheStateOfAnotherPeriodIsLeft) {
  ProgramShape shape = before();
  shape.period = 1'000'000;
  const KeptLayout kept = read_description(describe(shape), size_before);
  shape.period = 10'000'000;
  CarriedValues carried;
  std::vector<std::byte> state(size_before);
  carry_state(kept, state_before(), shape, state, carried);
  EXPECT_EQ(state, std::vector<std::byte>(size_before));
  EXPECT_THAT(carried.left, ElementsAre("the state (of steps of 1000000 ns there, 10000000 ns here)"));
}

TEST(Carry, ANumberIsNotFiniteWhereItWasFiniteAfterTheReset) {
  const ProgramShape shape{.state = {{.name = "LOW.Y", .block = "HY_MINIMUM"}, {.name = "LAG.Y", .offset = 8}}};
  std::vector<std::byte> reset(16);
  put(reset, 0, infinite);
  std::vector<std::byte> state = reset;
  EXPECT_EQ(not_finite(shape, state, reset), "") << "a running minimum begins so";
  put(state, 8, std::nan(""));
  EXPECT_EQ(not_finite(shape, state, reset), "LAG.Y");
}

/// The last sound state stays on the disk, however often a bad one is offered.
TEST(Carry, AStateThatIsNotFiniteIsNeverRetained) {
  class Memory final : public RetainFiles {
   public:
    std::optional<std::vector<std::byte>> read(std::size_t /*slot*/) override { return std::nullopt; }
    std::string write(std::size_t slot, std::span<const std::byte> bytes) override {
      slots.at(slot) = decode_slot(bytes).values;
      return {};
    }
    std::string put_aside(std::size_t /*slot*/) override { return {}; }
    std::string copy_aside(std::size_t /*slot*/) override { return {}; }
    std::array<RetainedValues, 2> slots{};
  };
  Memory files;
  test::Accumulator program;
  program.mutable_shape().state = {{.name = "SUM.Y", .block = "HY_INTEGRAL", .unit = "um"}};
  const std::vector<std::byte> after_reset(sizeof(double));
  Retainer retainer(files, program, {}, after_reset);
  std::vector<double> inputs{2.0};
  std::vector<double> outputs(2);
  program.step(inputs, outputs);
  retainer.offer(program, 1);
  ASSERT_TRUE(hysteron::test::soon([&] { return retainer.written() == 1; }));
  EXPECT_EQ(retainer.saved_commits(), 1U);
  inputs[0] = std::nan("");
  program.step(inputs, outputs);
  for (std::uint64_t i = 1; i < 4; ++i) {
    retainer.offer(program, 1 + i);
    ASSERT_TRUE(hysteron::test::soon([&] { return retainer.failures() == i; }));
  }
  EXPECT_EQ(retainer.written(), 1U);
  EXPECT_EQ(retainer.saved_commits(), 1U) << "a set is committed once it is on the disk";
  EXPECT_TRUE(hysteron::test::soon([&] { return retainer.problem() == "SUM.Y is not finite"; }));
  retainer.finish();
  EXPECT_EQ(get<double>(files.slots[0].state, 0), 2.0);
}

}  // namespace
}  // namespace hysteron::runtime
