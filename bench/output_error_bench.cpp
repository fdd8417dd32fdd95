// Fits of output error: the paper's model to the measured PICMA record, as example 4 makes it, and six parameters of a
// machine with play, a resonance and creep to long simulated records.
#include <benchmark/benchmark.h>

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "bench/machine_record.hpp"
#include "codegen/parameters/parameter_file.hpp"
#include "records/data_folder.hpp"
#include "records/read.hpp"
#include "tuning/output_error.hpp"

namespace hysteron::bench {
namespace {

/// The parameters of a fit as counters p0, p1 and so on, and the sum of squares.
void time_fit(benchmark::State& state, const OutputErrorProblem& problem) {
  for (auto _ : state) {
    const OutputErrorFit fit = fit_output_error(problem);
    if (!fit.solution.converged()) {
      state.SkipWithError(fit.solution.message.c_str());
      return;
    }
    for (Eigen::Index j = 0; j < fit.solution.x.size(); ++j) {
      state.counters["p" + std::to_string(j)] = fit.solution.x[j];
    }
    state.counters["iterations"] = fit.solution.iterations;
  }
}

void of_picma(benchmark::State& state) {
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
  time_fit(state, output_error_problem(plant, file, std::span(&record, 1)));
}

void of_machine(benchmark::State& state) {
  const auto samples = static_cast<std::size_t>(state.range(0));
  MachineRecord numbers = machine_record(samples);
  auto record = records::Record::even(0.0, machine_period, samples);  // NOLINT(readability-suspicious-call-argument)
  record.add({.name = "U", .values = std::move(numbers.u)});
  record.add({.name = "Y", .values = std::move(numbers.y)});
  const auto file = parameters::parse_parameter_file("machine.toml", machine_parameters);
  time_fit(state, output_error_problem(machine_program(), file, std::span(&record, 1)));
}

BENCHMARK(of_picma)->Name("output_error/picma")->Unit(benchmark::kMillisecond);
BENCHMARK(of_machine)
    ->Name("output_error/machine")
    ->Arg(100'000)
    ->Arg(1'000'000)
    ->Iterations(1)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace hysteron::bench
