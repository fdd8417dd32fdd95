// A diagram run with many sets of parameters over the same inputs.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "codegen/compile.hpp"
#include "tool/built_program.hpp"
#include "tool/parameter_sets.hpp"
#include "tuning/simulation.hpp"

namespace hysteron::tool {

/// What a set makes of an output.
struct OutputFigures {
  double least = 0.0;
  double most = 0.0;
  double last = 0.0;  ///< in the last step
  double rms = 0.0;
  double rmse = 0.0;  ///< against the measured signal; 0 where there is none
};

struct BatchRequest {
  const Program* program = nullptr;
  const Drive* drive = nullptr;
  const ParameterSets* sets = nullptr;
  std::vector<const Signal*> measured{};  ///< by output; null where it is not measured
  unsigned threads = 1;
  bool fast = false;  ///< exp, log, pow and the like of libmvec: within 4 units in the last place
  std::function<void(double)> progress{};
};

/// By set and output. The bits are those of `interpret`, and the sums are taken from the first step to the last.
using BatchResult = std::vector<std::vector<OutputFigures>>;

/// The header of a batch and a main beside it, with the flags that a batch needs.
[[nodiscard]] ProgramSources batch_sources(const GeneratedFile& header, std::string main);

/// Eight sets at a time, by a program that the system's compiler makes. Throws InputError HY725, HY726, HY754.
[[nodiscard]] BatchResult run_compiled_batch(const BatchRequest& request);

/// One set after the other, by the interpreter.
[[nodiscard]] BatchResult run_interpreted_batch(const BatchRequest& request, bool float32);

/// Whether a program is worth being compiled: what it saves is more than the two seconds of the compiler.
[[nodiscard]] bool worth_compiling(const BatchRequest& request);

}  // namespace hysteron::tool
