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
