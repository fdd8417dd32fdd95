#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "support/atomic_file.hpp"
#include "support/errors.hpp"
#include "support/progress.hpp"
#include "support/shell_words.hpp"
#include "tool/commands.hpp"
#include "tool/diagram.hpp"
#include "tool/record_options.hpp"
#include "tool/tune_goal.hpp"
#include "tool/tune_options.hpp"
#include "tool/tune_report.hpp"
#include "tool/tune_words.hpp"

namespace hysteron::tool {
namespace {

constexpr std::string_view tune_examples = R"(Examples:
  hysteron tune plant.st --log sine.csv --params plant.toml --out tuned.toml
  hysteron tune plant.st --log sine.csv --log steps.csv --params plant.toml --out tuned.toml --report report
  hysteron tune plant.st --log sine.csv --params plant.toml --out tuned.toml --start 10 --json
  hysteron tune loop.st --params pid.toml --out tuned.toml --report report

The parameter file says what may change, and on which part of the records:
  [parameters.HYST]
  C1 = 8.0
  [fit.HYST]
  C1 = {min = 0.1}            min, max, start and scale may be given; {} takes the block's own range
  [tune]
  train = [1.0, 21.0]         seconds; several as [[1.0, 5.0], [9.0, 21.0]]
  test = [21.0, 40.0]
  loss = "huber"              outliers pull with constant force
  initial_states = ["SUM.SUM"]  fitted too, for each record
  [initial.SUM]
  SUM = 0.0                   where a state begins, instead of its reset
A file with [goal] tunes the controller of a closed loop instead, and needs no record:
  [goal]
  settling_time = 0.5         the wished response, in seconds to 2 %; or rise_time, or wished = "COLUMN" of a record
  loop = "PID.XOUT"           where the loop is cut for its margins; also the effort, where none is named
  plants = ["light.toml", "heavy.toml"]  the worst of them counts; robust = "mean" for their mean
  [goal.limits]
  effort = 10.0               also effort_rate, overshoot_percent, gain_margin_db, phase_margin_deg, sensitivity
The diagram is run from its reset over each whole record: columns are its inputs, and the outputs of the same name are
what it is to meet. TUNED.toml is P.toml with the fitted values, and with your comments; run, generate and tune take it.
The initial states of a single record stand there under [initial], those of several in the heading alone. Ctrl-C ends
the fit and writes the best so far.
Exit codes: 0 fitted; 1 the fit did not converge, or limits of a goal are broken, the best is written; 2 an error in
diagram, parameters or records, and nothing is written; 130 ended by Ctrl-C, the best is written.
)";

/// Which output the progress line speaks of: the only one, with its unit; else the share of the ranges.
std::string progress_text(const OutputErrorProblem& problem, const OutputErrorOptions& options, int start,
                          const FitProgress& progress) {
  return fmt::format("{}iteration {}, RMSE {:.3g} % of the range{}",
                     options.starts > 1 ? fmt::format("start {} of {}, ", start + 1, options.starts) : std::string(),
                     progress.iteration, 100.0 * progress.rms, problem.outputs.size() > 1 ? "s" : "");
}

/// What looks for the cause of what this fit leaves.
std::string diagnose_command(const TuneOptions& options) {
  std::string command = "hysteron diagnose " + shell_word(options.diagram.file);
  command += options.diagram.top.empty() ? "" : " --top " + shell_word(options.diagram.top);
  for (const std::string& log : options.logs) {
    command += " --log " + shell_word(log);
  }
  std::vector<std::string> inputs = options.logs;
  inputs.insert(inputs.end(), {options.diagram.file, options.output});
  return command + fmt::format(" --params {} --out {}{}", shell_word(options.output),
                               folder_beside("diagnosis", inputs), record_arguments(options.record));
}

int tune(const TuneOptions& options, Console& console) {
  require_parameters(options.diagram, "tune", "write one, and name it.");
  const auto file = parameters::read_parameter_file(options.diagram.parameters);
  if (file.goal.is_given()) {
    return tune_goal(options, file, console);
  }
  if (options.logs.empty()) {
    throw InputError(error::bad_usage, {.file = options.diagram.parameters},
                     "tune has nothing to tune for: no record is given, and the parameter file has no [goal].",
                     "give a measured record as --log LOG.csv to fit it, or a [goal] for a control loop.");
  }
  prove_outputs(options, report_paths(options.report, options.logs.size()));
  Diagnostics warnings;
  const Program program = compile_file(options.diagram.file,
                                       {.top = options.diagram.top, .any_order = options.diagram.any_order}, warnings);
  const std::vector<records::Record> records =
      read_and_told(options.logs, with_settings(options.record, file.record), program, true, warnings);
  const OutputErrorProblem problem = output_error_problem(program, file, records);

  OutputErrorFit fit;
  {
    const InterruptWatch watch;
    Progress line("Fitting");
    OutputErrorOptions fitting{.starts = options.starts};
    fitting.progress = [&](int start, const FitProgress& progress) {
      // How many iterations are left nobody knows; most fits take some thirty.
      const double within = std::min(0.95, static_cast<double>(progress.iteration) / 30.0);
      line.update((start + within) / std::max(1, options.starts), progress_text(problem, fitting, start, progress));
      return !watch.interrupted();
    };
    fit = fit_output_error(problem, fitting);
    line.finish();
  }

  TuneReport report{.problem = problem, .fit = fit, .diagnose_command = diagnose_command(options)};
  for (std::size_t output = 0; output < problem.outputs.size(); ++output) {
    report.floors.push_back(diagnosis::noise_floor(problem.experiments, output));
  }
  std::vector<OutputFile> files =
      options.report.empty() ? std::vector<OutputFile>() : report_files(options.report, report);
  files.push_back({.path = options.output,
                   .contents = parameters::parameter_text(tuned_file(file, problem, fit), tuned_remarks(problem, fit),
                                                          tuned_heading(problem, fit))});
  write_files_atomically(files);
  console.print(options.json ? as_json(report).dump(2) + "\n" : as_text(report));
  console.report(warnings);
  if (fit.solution.status == FitStatus::Cancelled) {
    return exit_interrupted;
  }
  return fit.solution.converged() ? exit_ok : exit_findings;
}

}  // namespace

Action add_tune(CLI::App& app) {
  const auto options = std::make_shared<TuneOptions>();
  app.add_option("FILE", options->diagram.file, "The diagram, a file in Structured Text.")
      ->required()
      ->option_text("FILE.st");
  app.add_option("--log", options->logs,
                 "A measured record; may be repeated. None for a [goal] with a signal of its own.")
      ->option_text("LOG.csv")
      ->allow_extra_args(false);
  add_record_options(app, options->record);
  add_fmu_options(app);
  app.add_option("--params", options->diagram.parameters, "Parameters, with those to be fitted in tables [fit].")
      ->option_text("P.toml");
  app.add_option("--out", options->output, "The same with fitted values.")->required()->option_text("TUNED.toml");
  app.add_option("--report", options->report, "A folder for report.html, report.json and residuals.csv.")
      ->option_text("DIR");
  app.add_option("--top", options->diagram.top, "The block to take, where the file has several that no other contains.")
      ->option_text("NAME");
  app.add_option("--start", options->starts, "Fits from N points spread over the bounds, and keeps the best.")
      ->check(CLI::Range(1, 1000000))
      ->option_text("N");
  app.add_flag("--any-order", options->diagram.any_order, "The order of the statements means nothing.");
  app.add_flag("--json", options->json, "Prints JSON.");
  app.footer(std::string(tune_examples));
  return [options](Console& console) { return tune(*options, console); };
}

}  // namespace hysteron::tool
