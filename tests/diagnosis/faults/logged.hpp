// Signals as a logger leaves them, for the tests of what loggers and sensors do.
#pragma once

#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "tests/diagnosis/simulated_machine.hpp"
#include "tuning/output_error.hpp"

namespace hysteron::test {

/// One record of one output.
inline std::vector<Experiment> experiments_of(std::vector<double> values) {
  Experiment one;
  one.drive.steps = values.size();
  one.measured = {std::move(values)};
  return {one};
}

inline std::vector<double> noisy(std::vector<double> values, double deviation, std::uint64_t seed) {
  const auto noise = Noise(seed).white(values.size(), deviation);
  for (std::size_t k = 0; k < values.size(); ++k) {
    values[k] += noise[k];
  }
  return values;
}

inline std::vector<double> rounded(std::vector<double> values, double quantum) {
  for (double& value : values) {
    value = quantum * std::round(value / quantum);
  }
  return values;
}

}  // namespace hysteron::test
