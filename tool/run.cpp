#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "records/read.hpp"
#include "support/atomic_file.hpp"
#include "support/errors.hpp"
#include "support/names.hpp"
#include "support/numbers.hpp"
#include "support/progress.hpp"
#include "support/root_mean_square.hpp"
#include "support/text_file.hpp"
#include "tool/commands.hpp"
#include "tool/diagram.hpp"
#include "tool/output_record.hpp"
#include "tool/record_options.hpp"
#include "tool/writable.hpp"
#include "tuning/record_units.hpp"
#include "tuning/simulation.hpp"

namespace hysteron::tool {
namespace {

constexpr std::string_view run_examples = R"(Examples:
  hysteron run feedforward.st --in reference.csv --out voltage.csv
  hysteron run feedforward.st --in reference.csv --out voltage.csv --params tuned.toml --summary
  hysteron run feedforward.st --in reference.csv --out voltage.csv --trace INV.XOUT --trace BRANCH.Q
  hysteron run loop.st --in reference.csv --out voltage.csv --trace ERROR --trace PLANT.HYST.XOUT
  hysteron run feedforward.st --in - --out - < reference.csv | head

The columns of the record are matched to the inputs by name, without regard to case; t is in seconds, and its step is
the sample time that the diagram states with @ts. An input without a column keeps the default that the diagram gives
it. Written are t and the outputs, with the shortest numbers that read back to the same bits; TRUE is 1, FALSE is 0.
Exit codes: 0 done; 1 done, but an output is not a finite number (nan and inf are written as such); 2 an error in the
diagram, the parameters or the record, and nothing is written.
)";

struct RunOptions {
  DiagramOptions diagram;
  RecordOptions record;
  std::string input;
  std::string output;
  std::vector<std::string> traces;
  bool summary = false;
};

/// Variables, ports of nested blocks, and the outputs of instances, as INSTANCE.PIN.
std::vector<std::string> signal_names(const Graph& graph) {
  std::vector<std::string> names;
  for (const NamedWire& named : graph.named) {
    names.push_back(named.path);
  }
  for (const Node& node : graph.nodes) {
    for (std::size_t i = 0; node.block != nullptr && i < node.block->outputs.size(); ++i) {
      names.push_back(fmt::format("{}.{}", node.path, node.block->outputs[i].name));
    }
  }
  return names;
}

Wire find_signal(const Graph& graph, const std::string& path) {
  for (const NamedWire& named : graph.named) {
    if (equal_ignoring_case(named.path, path)) {
      return named.wire;
    }
  }
  const auto dot = path.rfind('.');
  for (std::uint32_t index = 0; dot != std::string::npos && index < graph.nodes.size(); ++index) {
    const Node& node = graph.nodes[index];
    if (node.block == nullptr || !equal_ignoring_case(node.path, path.substr(0, dot))) {
      continue;
    }
    for (std::size_t i = 0; i < node.block->outputs.size(); ++i) {
      if (equal_ignoring_case(node.block->outputs[i].name, path.substr(dot + 1))) {
        return {Wire::From::Node, node.block->outputs[i].type, static_cast<std::uint16_t>(i), index};
      }
    }
  }
  const auto names = signal_names(graph);
  const auto near = nearest_name(path, names);
  throw InputError(error::unknown_signal, {.file = graph.source->path},
                   fmt::format("{} has no signal {}.", graph.name, path),
                   near.empty() ? "name a variable, an output of an instance, as INSTANCE.XOUT, or either inside a "
                                  "nested block, as PLANT.HYST.XOUT."
                                : fmt::format("did you mean {}?", near));
}

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

std::string summary(const Program& program, const Drive& drive, const records::Record& record,
                    const std::vector<Signal>& outputs) {
  const Graph& graph = program.graph;
  std::string text = fmt::format("{}: {} steps of {} s\ninputs\n", graph.name, drive.steps,
                                 number_text(graph.sample_time_ns > 0 ? graph.sample_time() : drive.sample_time));
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

int run(const RunOptions& options, Console& console) {
  std::vector<InputFile> inputs = inputs_of(options.diagram);
  inputs.push_back({.file = options.input, .named_by = "--in"});
  refuse_to_overwrite({.file = options.output == "-" ? "" : options.output}, inputs);
  if (options.output != "-") {
    refuse_unwritable(options.output);
  }
  Diagnostics diagnostics;
  Program program = load_diagram(options.diagram, diagnostics);
  refuse_ports_named_as_time(diagnostics);
  const std::string log = read_text_file(options.input == "-" ? "/dev/stdin" : options.input);
  console.sources().put(options.input, log);
  const RecordOptions reading = with_settings_of(options.diagram.parameters, options.record);
  records::Record record = records::parse_record(options.input, log, read_options(reading, &program));
  convert_units(record, program, diagnostics);
  settle_sample_time(record, program, diagnostics);
  const Drive drive = drive_from(record, program, {}, diagnostics);

  std::vector<std::string> names;
  std::vector<Place> places;
  for (const Port& output : program.graph.outputs) {
    names.push_back(output.name);
    places.push_back(program.graph.place(output.span));
  }
  std::vector<Wire> watched = output_wires(program.graph);
  for (const std::string& path : options.traces) {
    watched.push_back(find_signal(program.graph, path));
    places.push_back({.file = options.diagram.file});
    // A variable T would stand in a second column t.
    names.push_back(equal_ignoring_case(path, "t") ? in_capitals(program.graph.name + "." + path) : in_capitals(path));
  }
  if (diagnostics.has_errors()) {
    throw InputError(diagnostics);
  }

  Progress progress("Running");
  const auto values =
      interpret(program, drive, watched, options.diagram.float32, [&](double fraction) { progress.update(fraction); });
  progress.finish();
  check_finite(places, record.time(), names, values, diagnostics);
  const auto text = output_csv(record.time(), names, values, options.diagram.float32);
  if (options.output == "-") {
    console.print(text);
  } else {
    write_file_atomically(options.output, text);
  }
  console.report(diagnostics);
  say_what_was_read(record, program, !options.summary);
  if (options.summary) {
    console.print(summary(program, drive, record, values));
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
                 "Writes a signal inside too: a variable, INSTANCE.PIN, or PLANT.INSTANCE.PIN; may be repeated.")
      ->option_text("PATH")
      ->delimiter(',')
      ->allow_extra_args(false);
  add_record_options(app, options->record);
  add_fmu_options(app);
  app.add_flag("--summary", options->summary, "Prints ranges, and errors against columns of the outputs' names.");
  app.footer(std::string(run_examples));
  return [options](Console& console) {
    options->diagram.keep_names = !options->traces.empty();
    return run(*options, console);
  };
}

}  // namespace hysteron::tool
