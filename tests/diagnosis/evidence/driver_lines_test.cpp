#include "diagnosis/evidence/driver_lines.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/diagnosis/simulated_machine.hpp"

namespace hysteron::diagnosis {
namespace {

using testing::ElementsAre;

constexpr double sample_time = 0.002;

DriverSignal sine(double frequency, double offset) {
  Signal values;
  for (int k = 0; k < 4000; ++k) {
    values.push_back(offset + std::sin(test::two_pi * frequency * sample_time * k + 0.4));
  }
  return {.name = "U", .values = {values}};
}

/// A line of a driver and of its harmonics is what the machine was driven with, however far the signal is from 0.
TEST(DriverLines, ALineOfADriverAndItsHarmonicsAreNoDisturbanceInTime) {
  std::vector<double> frequencies{3.0, 9.0, 18.0, 21.5, 40.0};
  bar_lines_of({sine(3.0, 100.0)}, sample_time, frequencies);
  EXPECT_THAT(frequencies, ElementsAre(21.5, 40.0));  // 6·3 is the last harmonic
}

TEST(DriverLines, ASignalThatStandsBarsNothing) {
  std::vector<double> frequencies{3.0, 21.5};
  bar_lines_of({{.name = "U", .values = {Signal(4000, 5.0), {}}}}, sample_time, frequencies);
  EXPECT_THAT(frequencies, ElementsAre(3.0, 21.5));
}

}  // namespace
}  // namespace hysteron::diagnosis
