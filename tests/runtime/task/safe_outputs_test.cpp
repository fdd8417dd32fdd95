// Limits and slew limits hold whatever is wanted and whatever is wrong; each fault ends in the safe value.
#include "runtime/task/safe_outputs.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <random>

#include "runtime/task/watchdog.hpp"
#include "support/numbers.hpp"

namespace hysteron::runtime {
namespace {

SafeOutputs one(OutputSafety safety) {
  return {{safety}, 0.001};
}

double after(SafeOutputs& outputs, double wanted, Fault fault, int cycles = 1) {
  for (int i = 0; i < cycles; ++i) {
    outputs.step(std::array{wanted}, fault);
  }
  return outputs.values()[0];
}

TEST(SafeOutputs, PassWhatIsWantedWhileAllIsWell) {
  auto outputs = one({.low = -10.0, .high = 10.0});
  EXPECT_EQ(after(outputs, 3.25, Fault::none), 3.25);
  EXPECT_EQ(after(outputs, -11.0, Fault::none), -10.0);
  EXPECT_EQ(after(outputs, 1e300, Fault::none), 10.0);
  EXPECT_EQ(outputs.worst(), Fault::none);
}

TEST(SafeOutputs, HoldThenTakeTheSafeValue) {
  for (const Fault fault : {Fault::hang, Fault::crash, Fault::stale_input, Fault::lost_link, Fault::missed_cycle}) {
    auto outputs = one({.hold_cycles = 3, .value = -1.0});
    after(outputs, 5.0, Fault::none);
    EXPECT_EQ(after(outputs, 7.0, fault, 3), 5.0);
    EXPECT_FALSE(outputs.settled());
    EXPECT_EQ(after(outputs, 7.0, fault), -1.0);
    EXPECT_TRUE(outputs.settled());
    EXPECT_EQ(outputs.worst(), fault);
    EXPECT_EQ(after(outputs, 7.0, Fault::none), 7.0);
  }
}

TEST(SafeOutputs, NoWayIsLongerThanTheLongest) {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  const OutputSafety ramp{
      .low = -4.0, .high = 10.0, .action = SafeAction::ramp, .hold_cycles = 2000, .value = 1.0, .ramp = 0.5};
  EXPECT_EQ(longest_way(ramp, 0.001), 2.0 + 18.0);
  EXPECT_EQ(longest_way({.low = -4.0, .high = 1.0, .slew = 5.0, .value = 1.0}, 0.001), 1.0);
  EXPECT_EQ(longest_way({.slew = 5.0}, 0.001), infinite);
  EXPECT_EQ(longest_way({.hold_cycles = 5}, 0.001), 0.005);
  EXPECT_EQ(longest_way({.slew = 5.0, .action = SafeAction::hold, .hold_cycles = 5}, 0.001), 0.0);
  auto outputs = one(ramp);
  outputs.start_from(std::array{10.0});
  after(outputs, 0.0, Fault::stop, 20'000 - 2);
  EXPECT_FALSE(outputs.settled());
  EXPECT_FALSE(outputs.stuck());
  after(outputs, 0.0, Fault::stop, 3);
  EXPECT_TRUE(outputs.settled());
}

TEST(SafeOutputs, RampAtTheRateThatWasGivenAndNeverPastTheValue) {
  auto outputs = one({.action = SafeAction::ramp, .hold_cycles = 1, .value = 0.0, .ramp = 1000.0});
  after(outputs, 2.5, Fault::none);
  EXPECT_EQ(after(outputs, 0.0, Fault::lost_link), 2.5);
  EXPECT_EQ(after(outputs, 0.0, Fault::lost_link), 1.5);
  EXPECT_EQ(after(outputs, 0.0, Fault::lost_link, 2), 0.0);
  EXPECT_TRUE(outputs.settled());
  // A slew limit that is lower than the ramp holds here too.
  auto slow = one({.slew = 500.0, .action = SafeAction::ramp, .ramp = 1000.0});
  slow.start_from(std::array{2.0});
  EXPECT_EQ(after(slow, 0.0, Fault::hang), 1.5);
}

TEST(SafeOutputs, HoldForEverWhereAsked) {
  auto outputs = one({.action = SafeAction::hold, .value = 9.0});
  after(outputs, 4.0, Fault::none);
  EXPECT_EQ(after(outputs, 0.0, Fault::crash, 100'000), 4.0);
  EXPECT_TRUE(outputs.settled());
}

TEST(SafeOutputs, WhatIsNotFiniteIsAFaultOfThatOutputAlone) {
  SafeOutputs outputs({{.value = 1.0}, {.value = 2.0}}, 0.001);
  outputs.step(std::array{5.0, 6.0}, Fault::none);
  for (const double broken : {not_a_number, infinity, -infinity}) {
    outputs.step(std::array{broken, 7.0}, Fault::none);
    EXPECT_EQ(outputs.values()[0], 1.0);
    EXPECT_EQ(outputs.values()[1], 7.0);
    EXPECT_EQ(outputs.fault(0), Fault::not_finite);
    EXPECT_EQ(outputs.fault(1), Fault::none);
    EXPECT_EQ(outputs.worst(), Fault::not_finite);
  }
}

TEST(SafeOutputs, StartWithinTheLimitsAndGoOnFromFiniteValuesOnly) {
  auto outputs = one({.low = 2.0, .high = 3.0, .value = 0.0});
  EXPECT_EQ(outputs.values()[0], 2.0);
  outputs.start_from(std::array{not_a_number});
  EXPECT_EQ(outputs.values()[0], 2.0);
  outputs.start_from(std::array{8.0});
  EXPECT_EQ(outputs.values()[0], 3.0);
}

TEST(SafeOutputs, LimitsAndSlewHoldInAnyRun) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> anything(-20.0, 20.0);
  for (int run = 0; run < 200; ++run) {
    const double slew = run % 3 == 0 ? infinity : 2000.0 + 100.0 * run;
    auto outputs = one({.low = -10.0,
                        .high = 12.0,
                        .slew = slew,
                        .action = static_cast<SafeAction>(run % 3),
                        .hold_cycles = static_cast<std::uint64_t>(run % 5),
                        .value = anything(random),
                        .ramp = 5000.0});
    for (int cycle = 0; cycle < 300; ++cycle) {
      const double before = outputs.values()[0];
      const auto dice = random() % 20;
      const double wanted = dice == 0 ? not_a_number : dice == 1 ? infinity : dice == 2 ? -infinity : anything(random);
      const auto fault = dice >= 14 ? static_cast<Fault>(random() % 8) : Fault::none;
      const double now = after(outputs, wanted, fault);
      ASSERT_GE(now, -10.0);
      ASSERT_LE(now, 12.0);
      ASSERT_LE(std::abs(now - before), slew * 0.001 * (1.0 + 1e-12));
    }
  }
}

TEST(Watchdog, TripsAfterSoManyCyclesInARow) {
  Watchdog watchdog({.time = 100, .sensitivity = 3});
  EXPECT_FALSE(watchdog.finished(101));
  EXPECT_FALSE(watchdog.finished(200));
  EXPECT_FALSE(watchdog.finished(100));  // in time: counted anew
  EXPECT_FALSE(watchdog.finished(101));
  EXPECT_FALSE(watchdog.finished(101));
  EXPECT_TRUE(watchdog.finished(101));
}

TEST(Watchdog, TripsAtOnceBeyondTimeTimesSensitivity) {
  Watchdog watchdog({.time = 100, .sensitivity = 3});
  EXPECT_FALSE(watchdog.finished(300));
  EXPECT_TRUE(watchdog.finished(301));
  for (const std::uint32_t sensitivity : {0U, 1U}) {
    Watchdog strict({.time = 100, .sensitivity = sensitivity});
    EXPECT_FALSE(strict.finished(100));
    EXPECT_TRUE(strict.finished(101));
  }
}

TEST(Watchdog, IsOffWithoutATime) {
  Watchdog watchdog({});
  EXPECT_FALSE(watchdog.finished(std::numeric_limits<std::int64_t>::max()));
  EXPECT_EQ(WatchdogSettings{}.longest(), 0);
}

}  // namespace
}  // namespace hysteron::runtime
