// The same random inputs for the interpreter and for a program that a back-end wrote, and what comes of them.
#pragma once

#include <gtest/gtest.h>

#include <bit>
#include <cfenv>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include "codegen/interpreter/machine.hpp"
#include "support/single.hpp"

namespace hysteron::testing {

/// Rows of six inputs and of the outputs of a RandomDiagram: X1, X2, X3, B1, B2, N1 and Y0 to Y3, Q, N.
struct RecordedRun {
  static constexpr std::size_t columns = 6;
  std::vector<double> inputs{};
  std::vector<double> outputs{};
  /// The first step in which the interpreter divided by 0, left the range of numbers, or met what is not a number.
  std::size_t first_exception = std::numeric_limits<std::size_t>::max();
  /// The first step with an input so large that 3.4E38, which stands for infinity in the portable dialect, is not
  /// infinite beside it: what is divided by it shows in the last digits.
  std::size_t first_large = std::numeric_limits<std::size_t>::max();

  [[nodiscard]] std::size_t steps() const { return inputs.size() / columns; }
};

/// Random inputs, of which some are 0 and some are equal to others, so that divisions by 0 and ties happen.
inline std::vector<double> random_rows(std::size_t steps, std::uint64_t seed) {
  std::uint64_t state = 88172645463325252ULL ^ (seed * 0x9E3779B97F4A7C15ULL);
  const auto next = [&] {
    state ^= state << 13U;
    state ^= state >> 7U;
    state ^= state << 17U;
    return state;
  };
  std::vector<double> rows;
  for (std::size_t k = 0; k < steps; ++k) {
    for (std::size_t i = 0; i < 3; ++i) {
      const double fine = static_cast<double>(next() >> 11U) * 0x1p-53 * 6.0 - 3.0;
      const double coarse = static_cast<double>(static_cast<int>(next() % 7) - 3);
      rows.push_back(nearest_single(next() % 8 == 0 ? coarse : fine));
    }
    rows.push_back(static_cast<double>(next() % 2));
    rows.push_back(static_cast<double>(next() % 8 == 0));
    rows.push_back(static_cast<double>(next() % 5));
  }
  return rows;
}

/// With a reset before the step in the middle.
template <class Real>
RecordedRun record(const Program& program, std::size_t steps, std::uint64_t seed) {
  RecordedRun run{.inputs = random_rows(steps, seed)};
  Machine<Real> machine(program);
  for (std::size_t k = 0; k < steps; ++k) {
    if (k == steps / 2) {
      machine.reset();  // inputs too begin anew
    }
    for (std::size_t i = 0; i < RecordedRun::columns; ++i) {
      machine.set_input(i, static_cast<Real>(run.inputs[k * RecordedRun::columns + i]));
    }
    std::feclearexcept(FE_ALL_EXCEPT);
    machine.step();
    if (std::fetestexcept(FE_DIVBYZERO | FE_INVALID | FE_OVERFLOW) != 0) {
      run.first_exception = std::min(run.first_exception, k);
    }
    for (std::size_t i = 0; i < program.graph.outputs.size(); ++i) {
      run.outputs.push_back(static_cast<double>(machine.output(i)));
    }
  }
  return run;
}

inline void write_doubles(const std::string& file, const std::vector<double>& values) {
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(values.data()),
             static_cast<std::streamsize>(values.size() * sizeof(double)));
}

inline std::vector<double> read_doubles(const std::string& file) {
  std::ifstream stream(file, std::ios::binary | std::ios::ate);
  std::vector<double> values(static_cast<std::size_t>(std::max<std::streamoff>(stream.tellg(), 0)) / sizeof(double));
  stream.seekg(0);
  stream.read(reinterpret_cast<char*>(values.data()), static_cast<std::streamsize>(values.size() * sizeof(double)));
  return values;
}

/// All not-a-numbers are one.
inline bool same_bits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b) || (a != a && b != b);
}

/// How many steps have the interpreter's bits, from the first on. `zeros_are_one`: 0 and -0 are the same.
inline std::size_t equal_steps(const RecordedRun& run, const std::vector<double>& outputs, bool zeros_are_one = false) {
  if (outputs.size() != run.outputs.size()) {
    return 0;
  }
  const std::size_t width = run.outputs.size() / run.steps();
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    if (!same_bits(outputs[i], run.outputs[i]) && !(zeros_are_one && outputs[i] == 0.0 && run.outputs[i] == 0.0)) {
      return i / width;
    }
  }
  return run.steps();
}

}  // namespace hysteron::testing
