// Block tests as Structured Text: a FUNCTION_BLOCK that runs them on the PLC, a step in each cycle, and leaves in its
// outputs what failed.
//
//   |got - expected| <= abs + rel*|expected|     LREAL and REAL, computed in LREAL
//   got = expected                               BOOL, DINT, WORD
//   an output that is infinite, or no number, fails in any step
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "codegen/backends/shared/generated_file.hpp"
#include "codegen/backends/st/dialect.hpp"
#include "codegen/compile.hpp"
#include "support/diagnostic.hpp"

namespace hysteron {

/// What one output is held against.
struct StExpectation {
  std::size_t output = 0;
  std::map<std::size_t, double> values{};  ///< by step
  Place place{};
};

struct StBenchCase {
  std::string name{};
  Place place{};
  const Program* diagram = nullptr;  ///< as it stands
  const Program* program = nullptr;  ///< the same with the parameters of the case
  bool float32 = false;
  std::size_t steps = 0;
  std::vector<std::vector<double>> inputs{};  ///< by input: one value, or one for each step
  std::vector<StExpectation> expected{};
  double absolute = 0.0;
  double relative = 0.0;
};

struct StBench {
  std::string name{};  ///< of the block that runs the tests
  std::vector<StBenchCase> cases{};
};

/// The block under test, that of the tests and, where the dialect has files for both, a program that calls it: one
/// file, or a file each where the dialect wants that. Throws InputError: HY728 with each value that the dialect cannot
/// write, and what generate_st throws.
[[nodiscard]] std::vector<GeneratedFile> generate_st_bench(const StBench& bench, const StDialect& dialect);

}  // namespace hysteron
