// hysteron replay: runs a recorded trace again and compares every bit; writes it as a record.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "runtime/task/trace_file.hpp"
#include "support/atomic_file.hpp"
#include "support/errors.hpp"
#include "support/numbers.hpp"
#include "support/text_file.hpp"
#include "tool/commands.hpp"
#include "tool/diagram.hpp"
#include "tool/serve_program.hpp"

namespace hysteron::tool {
namespace {

constexpr std::string_view examples = R"(Examples:
  hysteron replay feedforward.st --trace run.trace
  hysteron replay feedforward.st --trace run.trace --out record.csv
  hysteron diagnose plant.st --params plant.toml --log record.csv

Runs the diagram over the recorded inputs, from the recorded state and parameters, and compares every output, bit by bit.
The record has t, which counts steps, and inputs and outputs as they left, for run, tune and diagnose. The engine must
be the one that the trace was recorded with, for the bytes of its state.
Exit codes: 0 the same bits; 1 other bits, or steps that were dropped; 2 no trace of this diagram.
)";

struct Options {
  DiagramOptions diagram;
  std::string trace;
  std::string output;
  std::string engine;
};

int replay_trace(const Options& options, Console& console) {
  refuse_to_overwrite(options.output, {options.trace, options.diagram.file, options.diagram.parameters});
  Diagnostics found;
  const Program diagram = load_diagram(options.diagram, found);
  const auto program = step_program(diagram, engine_of(options.engine), options.diagram.float32);
  const auto& shape = program->shape();
  std::string csv = "t";
  for (const auto* const signals : {&shape.inputs, &shape.outputs}) {
    for (const runtime::ProgramSignal& signal : *signals) {
      csv += "," + signal.name + (signal.unit.empty() ? "" : " [" + signal.unit + "]");
    }
  }
  csv += "\n";
  const bool wants_record = !options.output.empty();
  const auto bytes = read_text_file(options.trace);
  runtime::ReplayResult result;
  const auto fault = runtime::replay(bytes, *program, result, [&](const runtime::TraceStep& step) {
    if (!wants_record) {
      return;
    }
    csv += number_text(static_cast<double>(static_cast<std::int64_t>(step.number) * shape.period) * 1e-9);
    for (const auto* const values : {&step.inputs, &step.outputs}) {
      for (const double value : *values) {
        csv += "," + number_text(value);
      }
    }
    csv += "\n";
  });
  if (!fault.empty()) {
    throw InputError(error::broken_trace, {.file = options.trace}, fmt::format("This cannot be replayed: {}.", fault),
                     "give the trace that `hysteron serve` wrote of this diagram, and the same --engine.");
  }
  if (wants_record) {
    write_file_atomically(options.output, csv);
  }
  if (result.different > 0) {
    found.error(error::replay_differs, {.file = options.trace},
                fmt::format("{} of {} steps give other bits, the first is step {}.", result.different, result.steps,
                            result.first_different),
                "replay with the libraries that it was recorded with; else look for what reaches the program besides "
                "its inputs.");
  }
  console.report(found);
  console.print(fmt::format("{} steps replayed, {} with other bits; {} dropped while recording{}\n", result.steps,
                            result.different, result.dropped, result.complete ? "" : "; the end is missing"));
  return result.different == 0 && result.without_state == 0 && result.dropped == 0 ? exit_ok : exit_findings;
}

}  // namespace

Action add_replay(CLI::App& app) {
  const auto options = std::make_shared<Options>();
  add_diagram_options(app, options->diagram);
  app.add_option("--trace", options->trace, "The trace.")->required()->option_text("RUN.trace");
  app.add_option("--out", options->output, "Writes the trace as a record.")->option_text("RECORD.csv");
  app.add_option("--engine", options->engine, "interpreter, or compiled: the default where there is a compiler.")
      ->check(CLI::IsMember({"interpreter", "compiled"}))
      ->option_text("NAME");
  app.footer(std::string(examples));
  return [options](Console& console) { return replay_trace(*options, console); };
}

}  // namespace hysteron::tool
