#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "records/read.hpp"
#include "support/atomic_file.hpp"
#include "support/names.hpp"
#include "support/numbers.hpp"
#include "support/progress.hpp"
#include "support/root_mean_square.hpp"
#include "support/rounded_text.hpp"
#include "support/text_file.hpp"
#include "tool/commands.hpp"
#include "tool/diagram.hpp"
#include "tool/output_record.hpp"
#include "tool/picture_file.hpp"
#include "tool/record_figures.hpp"
#include "tool/record_options.hpp"
#include "tool/run_batch.hpp"
#include "tool/writable.hpp"
#include "tuning/recorded_run.hpp"

namespace hysteron::tool {
namespace {

constexpr std::string_view run_examples = R"(Examples:
  hysteron run feedforward.st --in reference.csv --out voltage.csv
  hysteron run feedforward.st --in reference.csv --out voltage.csv --params tuned.toml --summary
  hysteron run feedforward.st --in reference.csv --out voltage.csv --trace INV.XOUT --trace BRANCH.Q
  hysteron run plant.st --in log.csv --out out.csv --plot fit.html
  hysteron run loop.st --in reference.csv --out voltage.csv --trace ERROR --trace PLANT.HYST.XOUT
  hysteron run feedforward.st --in - --out - < reference.csv | head
  hysteron run plant.st --in log.csv --out sets.csv --sweep INV.C1=0.04..0.06/21 --sweep INV.C3=0.6..0.8/21
  hysteron run plant.st --in log.csv --out sets.csv --draw 'INV.C1=normal(0.05,0.001)' --sets 10000 --fast
  hysteron run plant.st --in log.csv --out sets.csv --batch sets_of_parameters.csv

The columns of the record are matched to the inputs by name, without regard to case; t is in seconds, and its step is
the sample time that the diagram states with @ts. An input without a column keeps the default that the diagram gives
it. Written are t and the outputs, with the shortest numbers that read back to the same bits; TRUE is 1, FALSE is 0.
Many sets of parameters over one record (--batch, --sweep, --draw): written is a row for each set, with its values, and
the least, greatest and last value and the RMS of each output, and the RMSE where the record has its column.
Exit codes: 0 done; 1 done, but an output is not a finite number (nan and inf are written as such); 2 an error in the
diagram, the parameters or the record, and nothing is written.
)";

struct RunOptions {
  DiagramOptions diagram;
  RecordOptions record;
  std::string input;
  std::string output;
  std::vector<std::string> traces;
  std::string plot;
  BatchOptions batch;
  bool summary = false;
};

std::string column_summary(const std::string& name, const std::string& unit, const Signal& values,
                           const records::Column* recorded) {
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  const auto with_unit = unit.empty() ? std::string() : " " + unit;
  std::string text = fmt::format("  {:<16} {:.6g} to {:.6g}{}", name, *low, *high, with_unit);
  if (recorded != nullptr) {
    RootMeanSquare error;
    for (std::size_t k = 0; k < values.size(); ++k) {
      error.add(values[k] - recorded->values[k]);
    }
    const auto [least, most] = std::minmax_element(recorded->values.begin(), recorded->values.end());
    const double rms = error.value();
    text += fmt::format("; RMSE against the record's column {:.4g}{}", rms, with_unit);
    if (*most > *least) {
      text += fmt::format(", {:.3g} % of its range", 100.0 * rms / (*most - *least));
    }
  }
  return text + "\n";
}

std::string summary(const RecordedRun& run, const records::Record& record) {
  const auto& [program, drive, names, units, outputs] = run;
  const Graph& graph = program.graph;
  std::string text = fmt::format("{}: {} steps of {} s\ninputs\n", graph.name, drive.steps,
                                 rounded_text(graph.sample_time_ns > 0 ? graph.sample_time() : drive.sample_time));
  for (std::size_t i = 0; i < graph.inputs.size(); ++i) {
    const Port& input = graph.inputs[i];
    const bool recorded = record.find(input.name) != nullptr;
    text += recorded ? column_summary(input.name, input.unit, drive.inputs[i], nullptr)
                     : fmt::format("  {:<16} {}, its default\n", input.name, number_text(input.preset));
  }
  text += "outputs\n";
  for (std::size_t i = 0; i < graph.outputs.size(); ++i) {
    text +=
        column_summary(graph.outputs[i].name, graph.outputs[i].unit, outputs[i], record.find(graph.outputs[i].name));
  }
  std::string unused;
  for (const records::Column& column : record.columns()) {
    const auto same = [&](const Port& port) { return equal_ignoring_case(port.name, column.name); };
    if (std::none_of(graph.inputs.begin(), graph.inputs.end(), same) &&
        std::none_of(graph.outputs.begin(), graph.outputs.end(), same)) {
      unused += " " + column.name;
    }
  }
  return unused.empty() ? text : text + "columns not used:" + unused + "\n";
}

/// The record and the run of it, one over the other: the columns that the diagram has ports for.
std::vector<plots::Figure> figures_of(const RecordedRun& run, const records::Record& record) {
  const Graph& graph = run.program.graph;
  records::Record measured = record;
  for (const records::Column& column : record.columns()) {
    const auto same = [&](const Port& port) { return equal_ignoring_case(port.name, column.name); };
    if (std::ranges::none_of(graph.inputs, same) && std::ranges::none_of(graph.outputs, same)) {
      measured.remove(column.name);
    }
  }
  std::vector<records::Column> columns;
  for (std::size_t i = 0; i < run.names.size(); ++i) {
    columns.push_back({.name = run.names[i], .unit = run.units[i], .values = run.values[i]});
  }
  const std::vector<double> time(record.time().begin(), record.time().end());
  const std::vector<NamedRecord> both{
      {.name = "record", .record = std::move(measured)},
      {.name = "run", .record = {time, record.sample_time(), std::move(columns), {.file = "run"}}}};
  plots::Figure figure = figure_over_time(both);
  figure.title = fmt::format("{}: run of {}", graph.name, record.file());
  return {std::move(figure)};
}

int run_command(const RunOptions& options, Console& console) {
  check_batch_options(options.batch, !options.traces.empty(), !options.plot.empty());
  std::vector<InputFile> inputs = inputs_of(options.diagram);
  inputs.push_back({.file = options.input, .named_by = "--in"});
  inputs.push_back({.file = options.batch.sets.file, .named_by = "--batch"});
  refuse_to_overwrite({.file = options.output == "-" ? "" : options.output}, inputs);
  if (options.output != "-") {
    refuse_unwritable(options.output);
  }
  if (!options.plot.empty()) {
    std::vector<InputFile> taken = inputs;
    taken.push_back({.file = options.output == "-" ? "" : options.output, .named_by = "--out"});
    refuse_unfit_picture(options.plot, "--plot", taken);
  }
  Diagnostics diagnostics;
  Program program = load_diagram(options.diagram, diagnostics);
  const std::string log = read_text_file(options.input == "-" ? "/dev/stdin" : options.input);
  console.sources().put(options.input, log);
  const RecordOptions reading = with_settings_of(options.diagram.parameters, options.record);
  records::Record record = records::parse_record(options.input, log, drive_options(reading, program));
  if (options.batch.wanted()) {
    return run_batch(options.batch, std::move(program), record,
                     {.output = options.output, .float32 = options.diagram.float32}, diagnostics, console);
  }

  Progress progress("Running");
  const RecordedRun run = run_over(std::move(program), record,
                                   {.traces = options.traces,
                                    .float32 = options.diagram.float32,
                                    .progress = [&](double fraction) { progress.update(fraction); }},
                                   diagnostics);
  progress.finish();
  const auto text = output_csv(run.program.graph, record.time(), run.names, run.values, options.diagram.float32);
  if (options.output == "-") {
    console.print(text);
  } else {
    write_file_atomically(options.output, text);
  }
  if (!options.plot.empty()) {
    const auto figures = figures_of(run, record);
    write_file_atomically(options.plot, picture_bytes(options.plot, figures.front().title, figures));
  }
  console.report(diagnostics);
  say_what_was_read(record, run.program, !options.summary);
  if (options.summary) {
    console.print(summary(run, record));
  }
  return diagnostics.has_errors() ? exit_findings : exit_ok;
}

}  // namespace

Action add_run(CLI::App& app) {
  const auto options = std::make_shared<RunOptions>();
  add_diagram_options(app, options->diagram);
  app.add_option("--in", options->input, "The record that drives the inputs; - for the standard input.")
      ->required()
      ->option_text("LOG.csv");
  app.add_option("--out", options->output, "The record of the outputs; - for the standard output.")
      ->required()
      ->option_text("OUT.csv");
  app.add_option("--trace", options->traces,
                 "Writes a signal inside too: a variable, INSTANCE.PIN, or PLANT.INSTANCE.PIN; a vector is each of its "
                 "elements; may be repeated.")
      ->option_text("PATH")
      ->delimiter(',')
      ->allow_extra_args(false);
  add_record_options(app, options->record);
  app.add_option("--plot", options->plot, "Draws the run and its record: .svg, .png, or .html for a page with zoom.")
      ->option_text("FILE");
  add_batch_options(app, options->batch);
  add_fmu_options(app);
  app.add_flag("--summary", options->summary, "Prints ranges, and errors against columns of the outputs' names.");
  app.footer(std::string(run_examples));
  return [options](Console& console) {
    options->diagram.keep_names = !options->traces.empty();
    return run_command(*options, console);
  };
}

}  // namespace hysteron::tool
