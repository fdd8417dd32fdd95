// `hysteron run` with many sets of parameters.
#pragma once

#include <string>

#include "codegen/compile.hpp"
#include "records/record.hpp"
#include "support/diagnostic.hpp"
#include "tool/console.hpp"
#include "tool/parameter_sets.hpp"

namespace CLI {  // NOLINT(readability-identifier-naming): the library is so named
class App;
}

namespace hysteron::tool {

struct BatchOptions {
  SetOptions sets{};
  std::string engine{};  ///< empty: whichever is done sooner
  unsigned threads = 1;
  bool fast = false;

  [[nodiscard]] bool wanted() const { return !sets.file.empty() || !sets.sweeps.empty() || !sets.draws.empty(); }
};

/// The options --batch, --sweep, --draw, --sets, --seed, --engine, --threads and --fast.
void add_batch_options(CLI::App& app, BatchOptions& options);

/// Throws InputError HY730 where the options are for a batch and there is none, or the other way round.
void check_batch_options(const BatchOptions& options, bool traces, bool plot);

struct BatchOutput {
  std::string output{};  ///< a file; - for the standard output
  bool float32 = false;
};

/// Runs all sets, writes their table, and prints what they have in common. The exit code.
int run_batch(const BatchOptions& options, Program program, records::Record& record, const BatchOutput& output,
              Diagnostics& diagnostics, Console& console);

}  // namespace hysteron::tool
