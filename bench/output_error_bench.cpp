// The output-error fit of the paper's model to the measured PICMA record, as example 4 makes it.
#include <benchmark/benchmark.h>

#include <filesystem>
#include <span>

#include "codegen/parameters/parameter_file.hpp"
#include "records/data_folder.hpp"
#include "records/read.hpp"
#include "tuning/output_error.hpp"

namespace hysteron::bench {
namespace {

void output_error_fit(benchmark::State& state) {
  const auto path = records::find_record("piezo-picma-dbo/identify_1hz.csv", HYSTERON_SOURCE_DIR);
  if (!path) {
    state.SkipWithError("left out: no measured record (set HYSTERON_DATA)");
    return;
  }
  const records::Record record = records::read_record(path->string());
  const std::string example = HYSTERON_SOURCE_DIR "/examples/04_piezo_stack/";
  Diagnostics warnings;
  const Program plant = compile_file(example + "plant.st", {}, warnings);
  const auto file = parameters::read_parameter_file(example + "plant.toml");
  const OutputErrorProblem problem = output_error_problem(plant, file, std::span(&record, 1));
  for (auto _ : state) {
    const OutputErrorFit fit = fit_output_error(problem);
    if (!fit.solution.converged()) {
      state.SkipWithError("the fit did not converge");
    }
    state.counters["share_of_range"] = fit.scores.front().train / fit.scores.front().range;
  }
}

BENCHMARK(output_error_fit)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace hysteron::bench
