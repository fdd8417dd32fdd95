// hysteron replay: runs a recorded trace again and compares every bit; writes it as a record.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "support/atomic_file.hpp"
#include "support/errors.hpp"
#include "support/numbers.hpp"
#include "support/time_heading.hpp"
#include "tool/commands.hpp"
#include "tool/diagram.hpp"
#include "tool/replayed.hpp"

namespace hysteron::tool {
namespace {

constexpr std::string_view serve_replay_examples = R"(Examples:
  hysteron replay feedforward.st --trace run.trace
  hysteron replay feedforward.st --trace run.trace --out record.csv
  hysteron diagnose plant.st --params plant.toml --log record.csv

Runs the diagram over the recorded inputs, from the recorded state and parameters, and compares every output, bit by bit.
The record has the time, which counts steps, and inputs and outputs as they left, for run, tune and diagnose. It runs by
the engine that the trace was recorded with, for the bytes of its state.
Exit codes: 0 the same bits; 1 other bits, steps that were dropped or cannot be replayed, or no step; 2 no trace of this
diagram.
)";

struct ServeReplayOptions {
  DiagramOptions diagram;
  std::string trace;
  std::string output;
  std::string engine;
};

std::string header_of(const runtime::ProgramShape& shape) {
  std::string header;
  bool has_t = false;
  for (const auto* const signals : {&shape.inputs, &shape.outputs}) {
    for (const runtime::ProgramSignal& signal : *signals) {
      header += fmt::format(",{}{}", signal_heading(signal.name), signal.unit.empty() ? "" : " [" + signal.unit + "]");
      has_t = has_t || is_called_t(signal.name);
    }
  }
  return fmt::format("{}{}\n", time_heading(has_t), header);
}

std::string row_of(const runtime::ProgramShape& shape, const runtime::TraceStep& step) {
  std::string row = number_text(static_cast<double>(static_cast<std::int64_t>(step.number) * shape.period) * 1e-9);
  for (const auto* const values : {&step.inputs, &step.outputs}) {
    for (const double value : *values) {
      row += "," + number_text(value);
    }
  }
  return row + "\n";
}

int replay(const ServeReplayOptions& options, Console& console) {
  std::vector<InputFile> inputs = inputs_of(options.diagram);
  inputs.push_back({.file = options.trace, .named_by = "--trace"});
  refuse_to_overwrite({.file = options.output}, inputs);
  Diagnostics found;
  const bool wants_record = !options.output.empty();
  std::string rows;
  const Replayed replayed = replay_trace(options.diagram, options.trace, options.engine, found,
                                         [&](const runtime::ProgramShape& shape, const runtime::TraceStep& step) {
                                           rows += wants_record ? row_of(shape, step) : "";
                                         });
  const runtime::ReplayResult& result = replayed.result;
  if (wants_record) {
    write_file_atomically(options.output, header_of(replayed.program->shape()) + rows);
  }
  if (result.different > 0) {
    found.error(error::replay_differs, {.file = options.trace},
                fmt::format("{} of {} steps give other bits, the first is step {}.", result.different, result.steps,
                            result.first_different),
                "replay with the libraries that it was recorded with; else look for what reaches the program besides "
                "its inputs.");
  }
  console.report(found);
  const std::string before_state =
      result.without_state == 0
          ? ""
          : fmt::format("; {} stand before the first state and cannot be replayed", result.without_state);
  console.print(fmt::format("{} steps replayed, {} with other bits; {} dropped while recording{}{}{}\n", result.steps,
                            result.different, result.dropped, before_state,
                            result.complete ? "" : "; the end is missing",
                            result.steps > 0 ? "" : "; there is nothing to compare"));
  const bool is_whole = result.different == 0 && result.without_state == 0 && result.dropped == 0 && result.steps > 0;
  return is_whole ? exit_ok : exit_findings;
}

}  // namespace

Action add_replay(CLI::App& app) {
  const auto options = std::make_shared<ServeReplayOptions>();
  add_diagram_options(app, options->diagram);
  app.add_option("--trace", options->trace, "The trace.")->required()->option_text("RUN.trace");
  app.add_option("--out", options->output, "Writes the trace as a record.")->option_text("RECORD.csv");
  app.add_option("--engine", options->engine, "interpreter or compiled; the default, that of the trace.")
      ->check(CLI::IsMember({"interpreter", "compiled"}))
      ->option_text("NAME");
  app.footer(std::string(serve_replay_examples));
  return [options](Console& console) { return replay(*options, console); };
}

}  // namespace hysteron::tool
