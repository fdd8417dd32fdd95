// A sensor whose clock runs fast.
#include "diagnosis/faults/fast_clock.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "diagnosis/model/least_squares.hpp"
#include "diagnosis/model/task.hpp"
#include "tests/diagnosis/simulated_machine.hpp"

namespace hysteron::diagnosis {
namespace {

constexpr std::size_t samples = 2000;
constexpr double noise = 0.002;

/// A record of the axis whose sensor reads at (1 + skew)·t, straight between samples.
records::Record read_ahead(double skew, const test::Effect& effect = {}, double deviation = noise) {
  const records::Record driven = test::measured(
      test::program_of(test::axis(effect)), test::record_of("FORCE", test::rich_force(samples + samples / 50)), 0.0);
  const std::vector<double>& speed = driven.column("V").values;
  test::Noise random(5);
  std::vector<double> read;
  for (std::size_t k = 0; k < samples; ++k) {
    const double place = static_cast<double>(k) * (1.0 + skew);
    const auto below = static_cast<std::size_t>(place);
    read.push_back(std::lerp(speed[below], speed[below + 1], place - static_cast<double>(below)) +
                   deviation * random());
  }
  records::Record record = test::record_of("FORCE", test::rich_force(samples));
  record.add({.name = "V", .values = std::move(read)});
  return record;
}

Diagnosis found_in(const records::Record& record, std::vector<std::string> effects) {
  return diagnose(test::input_of(test::axis(), test::axis_parameters, {record}), {.effects = std::move(effects)});
}

TEST(FastClock, IsNamedByWhatTheRecordHoldsAhead) {
  for (const double skew : {0.004, 0.015}) {
    const Diagnosis found = found_in(read_ahead(skew), {"clock", "delay", "lag", "gain_drift", "load"});
    ASSERT_EQ(found.effects.size(), 1U) << found.summary;
    EXPECT_EQ(found.effects[0].id, "clock");
    EXPECT_EQ(found.verdict, Verdict::Named);
    const ParameterFinding& clock = found.effects[0].parameters.at(0);
    EXPECT_EQ(clock.name, "SKEW");
    EXPECT_NEAR(clock.value, -skew, 3.0 * std::max(clock.high - clock.value, 1e-5));
    EXPECT_LT(clock.high, 0.0);
    EXPECT_GT(found.gap.nominal, 2.0 * found.gap.floor.value);
    EXPECT_LT(found.gap.improved, 1.1 * noise);
    EXPECT_GT(found.gap.closed, 0.9);
    EXPECT_THAT(found.warnings, testing::Contains(testing::HasSubstr("The clock of V runs fast by")));
  }
}

TEST(FastClock, IsFoundWhereReadingBetweenSamplesMissesMoreThanTheNoise) {
  constexpr double quiet = 2e-5;
  const DiagnosisInput input = test::input_of(test::axis(), test::axis_parameters, {read_ahead(0.004, {}, quiet)});
  Task task = task_of(input);
  task.scales = {quiet};
  const std::optional<FastClock> found = fast_clock(task, input.program);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->finding.parameters.at(0).value, -0.004, 1e-5);
  Model mended(found->task, input.program);
  EXPECT_GT(fit(mended, mended.start(), {}).residuals.squaredNorm(), 1.5 * samples) << "or nothing was missed";
}

TEST(FastClock, IsNoneWhereTheCauseIsAnotherOrTheClockIsNotAskedFor) {
  const auto mended = testing::Contains(testing::HasSubstr("runs fast"));
  EXPECT_THAT(found_in(read_ahead(0.01), {"delay"}).warnings, testing::Not(mended));
  for (const test::Effect& effect : {test::Effect{"HY_DEAD_TIME := (DEAD_TIME := 0.03)", "FORCE"},
                                     test::Effect{"HY_ODD_NONLINEARITY := (SIZE := 0.3, REFERENCE := 3.0)", "FORCE"},
                                     test::Effect{"HY_CLOCK := (SKEW := 0.002)", "SPEED.XOUT"},
                                     test::Effect{"HY_GAIN_DRIFT := (RATE := 0.03)", "FORCE"}}) {
    const Diagnosis found = found_in(read_ahead(0.0, effect), {"clock", "delay", "odd_nonlinearity", "gain_drift"});
    EXPECT_THAT(found.warnings, testing::Not(mended)) << effect.block;
    EXPECT_FALSE(found.effects.empty()) << effect.block;
  }
}

}  // namespace
}  // namespace hysteron::diagnosis
