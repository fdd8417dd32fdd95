#include "diagnosis/evidence/driver_signals.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "diagnosis/evidence/roles.hpp"
#include "tests/diagnosis/simulated_machine.hpp"

namespace hysteron::diagnosis {
namespace {

RecordSignals sine(std::size_t count, double sample_time, double noise_deviation) {
  test::Noise noise(2);
  Signal values(count);
  for (std::size_t k = 0; k < count; ++k) {
    values[k] = std::sin(test::two_pi * static_cast<double>(k) * sample_time) + noise_deviation * noise();
  }
  return {values};
}

TEST(DriverSignals, TheSlopeOfAParabolaIsExact) {
  Signal values(50);
  for (std::size_t k = 0; k < values.size(); ++k) {
    const double t = 0.02 * static_cast<double>(k);
    values[k] = 3.0 - 2.0 * t + 5.0 * t * t;
  }
  const RecordSignals rates = rates_of({values}, 0.02).values;
  for (std::size_t k = 1; k + 1 < values.size(); ++k) {
    EXPECT_NEAR(rates[0][k], -2.0 + 10.0 * 0.02 * static_cast<double>(k), 1e-9);
  }
}

TEST(DriverSignals, TheNoiseOfASlopeIsATenthOfTheSlopeAtMost) {
  constexpr double sample_time = 0.001;
  const RecordSignals rates = rates_of(sine(4000, sample_time, 1e-3), sample_time).values;
  double error = 0.0;
  for (std::size_t k = 300; k < 3700; ++k) {
    const double truth = test::two_pi * std::cos(test::two_pi * static_cast<double>(k) * sample_time);
    error += (rates[0][k] - truth) * (rates[0][k] - truth) / 3400.0;
  }
  EXPECT_LT(std::sqrt(error), 0.12 * test::two_pi / std::sqrt(2.0));
}

TEST(DriverSignals, ThirdDifferencesSeeTheNoiseAndNotTheMotion) {
  EXPECT_NEAR(noise_of(sine(5000, 0.001, 0.01)), 0.01, 0.001);
  EXPECT_LT(noise_of(sine(5000, 0.001, 0.0)), 1e-6);
}

TEST(Roles, AnAngleIsKnownByItsNameAndANumberIsNone) {
  EXPECT_TRUE(quantity_of("rad").position);
  EXPECT_TRUE(quantity_of("um").position);
  EXPECT_TRUE(quantity_of("mm/s").velocity);
  EXPECT_TRUE(quantity_of("rpm").velocity);
  EXPECT_TRUE(quantity_of("1").number);
  EXPECT_FALSE(quantity_of("1").position);
  EXPECT_TRUE(quantity_of("degC").thermal);
  EXPECT_FALSE(quantity_of("N").position || quantity_of("N").velocity || quantity_of("N").number);
  EXPECT_FALSE(quantity_of("").known);
}

TEST(Roles, AFrictionActsOnAForceAndIsDrivenByASpeed) {
  const EffectKind friction{.id = "coulomb_friction", .auxiliaries = {"V"}, .by_velocity = true};
  const auto on = [&](const char* unit) { return may_act_on(friction, {.unit = unit}); };
  EXPECT_TRUE(on("N"));
  EXPECT_TRUE(on("V"));
  EXPECT_TRUE(on(""));
  EXPECT_FALSE(on("mm"));
  EXPECT_FALSE(on("rad/s"));
  EXPECT_FALSE(on("degC"));
  EXPECT_TRUE(may_drive(friction, {.unit = "m/s"}, {}));
  EXPECT_FALSE(may_drive(friction, {.unit = "m"}, {}));
  EXPECT_FALSE(may_drive(friction, {.source = DriverSignal::Source::Column}, {}));
}

}  // namespace
}  // namespace hysteron::diagnosis
