// Sensor faults: what was put there is found with its rows, and what machines and sound sensors do is left alone.
#include "diagnosis/faults/sensor_faults.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "tests/diagnosis/faults/logged.hpp"

namespace hysteron::diagnosis {
namespace {

using testing::IsEmpty;
using testing::SizeIs;
using Kind = SensorFault::Kind;

std::vector<double> motion() {
  std::vector<double> values;
  for (std::size_t k = 0; k < 2000; ++k) {
    values.push_back(20.0 + 10.0 * std::sin(0.01 * static_cast<double>(k)));
  }
  return values;
}

std::vector<double> held(std::vector<double> values, std::size_t first, std::size_t last) {
  std::fill(values.begin() + static_cast<std::ptrdiff_t>(first), values.begin() + static_cast<std::ptrdiff_t>(last),
            values[first]);
  return values;
}

std::vector<SensorFault> faults(const std::vector<double>& measured, const std::vector<double>& model = motion()) {
  return find_sensor_faults(measured, model, {});
}

TEST(SensorFaults, AStuckSensorIsFoundWithItsRows) {
  const auto found = faults(held(test::noisy(motion(), 0.05, 1), 1000, 1200));
  ASSERT_THAT(found, SizeIs(1));
  EXPECT_EQ(found[0].kind, Kind::Stuck);
  EXPECT_EQ(found[0].rows.first, 1000U);
  EXPECT_EQ(found[0].rows.last, 1200U);
  EXPECT_THAT(faults(held(test::noisy(motion(), 0.05, 1), 1000, 2000)), SizeIs(1));  // to the end
}

TEST(SensorFaults, DropoutsAreFoundWithTheirRows) {
  auto values = test::noisy(motion(), 0.05, 1);
  std::fill(values.begin() + 700, values.begin() + 730, 0.0);
  std::fill(values.begin() + 1500, values.begin() + 1505, 0.0);
  const auto found = faults(values);
  ASSERT_THAT(found, SizeIs(2));
  EXPECT_EQ(found[0].kind, Kind::Dropout);
  EXPECT_EQ(found[0].rows.first, 700U);
  EXPECT_EQ(found[0].rows.last, 730U);
  EXPECT_EQ(found[1].rows.first, 1500U);
  EXPECT_EQ(found[1].rows.last, 1505U);
  EXPECT_EQ(found[0].value, 0.0);
}

TEST(SensorFaults, RowsThatAreMissingLeap) {
  auto values = test::noisy(motion(), 0.05, 1);
  values.erase(values.begin() + 1000, values.begin() + 1300);
  auto model = motion();
  model.resize(values.size());
  const auto found = faults(values, model);
  ASSERT_THAT(found, SizeIs(1));
  EXPECT_EQ(found[0].kind, Kind::Leap);
  EXPECT_EQ(found[0].rows.first, 1000U);
}

TEST(SensorFaults, SoundSensorsPass) {
  EXPECT_THAT(faults(test::noisy(motion(), 0.05, 1)), IsEmpty());
  EXPECT_THAT(faults(test::rounded(motion(), 0.5)), IsEmpty());
  EXPECT_THAT(faults(test::rounded(test::noisy(motion(), 0.05, 1), 0.1)), IsEmpty());
}

TEST(SensorFaults, AClippedSensorIsNotStuck) {
  auto values = test::noisy(motion(), 0.05, 1);
  for (double& v : values) {
    v = std::min(v, 25.0);
  }
  EXPECT_THAT(faults(values), IsEmpty());
}

TEST(SensorFaults, AMachineThatSticksPasses) {
  // It stands at each reversal, without noise and with a coarse sensor, and starts to move again from where it stood.
  std::vector<double> values{20.0};
  for (const double driven : motion()) {
    const double off = driven - values.back();
    values.push_back(std::abs(off) > 1.0 ? driven - std::copysign(1.0, off) : values.back());
  }
  values.pop_back();
  EXPECT_THAT(faults(values), IsEmpty());
  EXPECT_THAT(faults(test::rounded(values, 0.05)), IsEmpty());
  EXPECT_THAT(faults(test::noisy(values, 0.05, 1)), IsEmpty());
}

/// A machine that drives, waits and drives on, with waits of many lengths.
std::vector<double> with_waits(std::size_t waits) {
  std::vector<double> values{20.0};
  for (std::size_t k = 1; k < 2000; ++k) {
    const bool is_waiting = k % (2000 / waits) < 90;
    values.push_back(values.back() + (is_waiting ? 0.0 : 0.1 * std::cos(0.005 * static_cast<double>(k))));
  }
  return values;
}

/// Noisy where it moves and exact where it rests, as a speed that is computed from an encoder.
std::vector<double> noisy_in_motion(const std::vector<double>& moved, double deviation) {
  std::vector<double> values = test::noisy(moved, deviation, 1);
  for (std::size_t k = 1; k + 1 < moved.size(); ++k) {
    if (moved[k] == moved[k - 1] && moved[k] == moved[k + 1]) {
      values[k] = moved[k];
    }
  }
  return values;
}

TEST(SensorFaults, ASensorThatIsExactAtRestPassesWhereTheModelRestsToo) {
  for (const std::size_t waits : {1U, 2U, 4U}) {
    const auto moved = with_waits(waits);
    EXPECT_THAT(faults(noisy_in_motion(moved, 0.05), moved), IsEmpty()) << waits;
    EXPECT_THAT(faults(noisy_in_motion(moved, 0.05), motion()), testing::Not(IsEmpty()))
        << "a model that moves on: it may as well be stuck";
  }
}

/// Linear interpolation invents readings between the steps of an encoder, and leaves it standing where it stood.
TEST(SensorFaults, ACoarseSensorThatWasResampledPassesThoughTheModelMovesOn) {
  std::vector<double> moved{motion().front() - 4.0};  // sticks at each turn of a force, where the model without friction swings on
  for (const double driven : motion()) {
    const double off = driven - moved.back();
    moved.push_back(std::abs(off) > 4.0 ? driven - std::copysign(4.0, off) : moved.back());
  }
  const std::vector<double> coarse = test::rounded(moved, 0.15);
  const std::vector<double> jitter = test::Noise(4).white(coarse.size(), 0.15);
  std::vector<double> resampled;
  for (std::size_t k = 0; k < 2000; ++k) {
    const double at = std::clamp(static_cast<double>(k) + jitter[k], 0.0, 1999.0);
    const auto left = static_cast<std::size_t>(at);
    resampled.push_back(std::lerp(coarse[left], coarse[left + 1], at - static_cast<double>(left)));
  }
  EXPECT_THAT(faults(resampled), IsEmpty());
}

TEST(SensorFaults, ASwitchedSignalPasses) {
  std::vector<double> values;
  for (std::size_t k = 0; k < 2000; ++k) {
    values.push_back(k / 250 % 2 == 0 ? 0.0 : 24.0);
  }
  EXPECT_THAT(faults(values), IsEmpty());
  std::vector<double> step(2000, 0.0);
  std::fill(step.begin() + 500, step.end(), 5.0);
  EXPECT_THAT(faults(test::noisy(step, 0.05, 1), step), IsEmpty());  // the model steps as well
}

}  // namespace
}  // namespace hysteron::diagnosis
