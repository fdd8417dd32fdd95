#include "diagnosis/diagnose.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <thread>
#include <vector>

#include "diagnosis/effects/known_effects.hpp"
#include "diagnosis/model/ignored_columns.hpp"
#include "diagnosis/model/limits.hpp"
#include "diagnosis/report/diagnosis_files.hpp"
#include "diagnosis/report/verdict_json.hpp"
#include "support/errors.hpp"
#include "support/overwriting.hpp"
#include "support/progress.hpp"
#include "tool/commands.hpp"
#include "tool/diagnose_report.hpp"
#include "tool/diagram.hpp"
#include "tool/option_values.hpp"
#include "tool/record_options.hpp"
#include "tool/replayed.hpp"
#include "tool/writable.hpp"

namespace hysteron::tool {
namespace {

constexpr std::string_view diagnose_examples = R"(Examples:
  hysteron diagnose plant.st --log machine.csv --params tuned.toml --out diagnosis
  hysteron diagnose plant.st --log slow.csv --log fast.csv --params tuned.toml --out diagnosis --material 0.05
  hysteron diagnose plant.st --log machine.csv --params tuned.toml --out diagnosis --effects creep,lag,delay

  hysteron diagnose plant.st --log run.csv --params tuned.toml --out diagnosis --trace run.trace --controller feedforward.st

Where the diagram of a plant and a record of the machine differ, which effect causes it, and how far the gap shrinks once
that effect is added. The diagram is run from its reset over each whole record: columns are its inputs, and the outputs
of the same name are what it should meet. Parameters named under [fit] in P.toml are refitted first, those that are not 0
where none is named; what that closes is calibration and no effect.
DIR gets verdict.json, report.html, improved.st and improved.toml, traces.csv, where an experiment would tell more
next_experiment.csv, and where the improved diagram has an inverse feedforward.st.
A column that is named as a signal inside the diagram, H1 or LEVEL1.XOUT, cuts it there. With the trace of the runtime
that drove the machine, and the diagram that it ran, the controller's own part of the gap is told too.
Exit codes: 0 a verdict; 1 the record cannot be diagnosed, verdict.json says why; 2 an error in diagram, parameters,
records or command line, and nothing is written.
)";

struct DiagnoseOptions {
  DiagramOptions diagram;
  RecordOptions record;
  std::vector<std::string> logs;
  std::string output;
  std::vector<std::string> effects;
  std::vector<std::string> ignored;
  std::vector<std::string> limits;
  DiagramOptions controller;
  std::string trace;
  std::string prior;
  diagnosis::DiagnosisOptions diagnosis;
  bool json = false;
};

/// The controller's trace, replayed on its diagram.
diagnosis::ControllerFinding replayed(const DiagnoseOptions& options, Diagnostics& warnings) {
  const Replayed found = replay_trace(options.controller, options.trace, {}, warnings);
  diagnosis::ControllerFinding result{.steps = found.result.steps,
                                      .different = found.result.different,
                                      .first_different = found.result.first_different,
                                      .dropped = found.result.dropped};
  const auto& outputs = found.program->shape().outputs;
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    result.outputs.push_back({.name = outputs[i].name,
                              .unit = outputs[i].unit,
                              .difference_rms = found.result.difference_rms[i],
                              .limited_rms = found.result.limited_rms[i]});
  }
  return result;
}

/// What is found may take the place of no file that it is found from: often the folder is one of an earlier diagnosis,
/// whose improved diagram is diagnosed now. A folder of a name that cannot be made is refused too.
void prove_outputs(const DiagnoseOptions& options) {
  refuse_unwritable_folder(options.output);
  std::vector<InputFile> inputs = inputs_of(options.diagram);
  for (const std::string& log : options.logs) {
    inputs.push_back({.file = log, .named_by = "--log"});
  }
  inputs.push_back({.file = options.trace, .named_by = "--trace"});
  inputs.push_back({.file = options.prior, .named_by = "--prior"});
  inputs.push_back({.file = options.controller.file, .named_by = "--controller"});
  inputs.push_back({.file = options.controller.parameters, .named_by = "--controller-params"});
  std::error_code unknown;
  for (const auto& entry : std::filesystem::directory_iterator(options.output, unknown)) {
    if (diagnosis::is_diagnosis_file(entry.path().filename().string())) {
      refuse_to_overwrite({.file = entry.path().string(), .mend = "give another folder for --out."}, inputs);
    }
  }
}

int diagnose(DiagnoseOptions options, Console& console) {
  require_parameters(options.diagram, "diagnose",
                     "tune the diagram first, by `hysteron tune`, and name the file that it writes.");
  Diagnostics warnings;
  prove_outputs(options);
  if (options.trace.empty() != options.controller.file.empty()) {
    throw InputError(error::bad_usage, {}, "--trace and --controller belong together.",
                     "give the trace of `hysteron serve` and the diagram that it ran.");
  }
  const Program program = compile_file(options.diagram.file,
                                       {.top = options.diagram.top, .any_order = options.diagram.any_order}, warnings);
  diagnosis::refuse_undiagnosable(options.effects, program);
  diagnosis::DiagnosisInput input{.program = program, .text = *program.graph.source->text};
  input.file = parameters::read_parameter_file(options.diagram.parameters);
  input.records =
      read_and_told(options.logs, with_settings(options.record, input.file.record), program, false, warnings);
  for (const std::string& column : options.ignored) {
    input.file.diagnose.ignore.push_back({.text = column});
  }
  diagnosis::ignore_columns(input);
  options.diagnosis.effects = options.effects;
  options.diagnosis.limits = diagnosis::read_limits(program.graph, options.limits);
  if (!options.prior.empty()) {
    options.diagnosis.prior = diagnosis::read_prior(options.prior, options.logs);
  }
  std::optional<diagnosis::ControllerFinding> controller;
  if (!options.trace.empty()) {
    controller = replayed(options, warnings);
  }
  diagnosis::Diagnosis found;
  {
    Progress line("Diagnosing");
    options.diagnosis.progress = [&](double fraction, std::string_view text) { line.update(fraction, text); };
    found = diagnosis::diagnose(input, options.diagnosis);
    line.finish();
  }
  found.controller = std::move(controller);
  if (!options.prior.empty() && (found.siblings == 0 || found.evidence.families.empty())) {
    Console::note(options.prior, found.siblings == 0
                                     ? "no sibling in it has an effect, and it changes nothing"
                                     : "the families of effects were not weighed here, and it changes nothing");
  }
  write_diagnosis(options.output, found);
  console.print(options.json ? diagnosis::verdict_json(found) : diagnosis_text(found));
  console.report(warnings);
  return found.refusals.empty() ? exit_ok : exit_findings;
}

}  // namespace

Action add_diagnose(CLI::App& app) {
  const auto options = std::make_shared<DiagnoseOptions>();
  options->diagnosis.threads = std::max(1U, std::thread::hardware_concurrency());
  app.add_option("FILE", options->diagram.file, "The diagram of the plant, a file in Structured Text.")
      ->required()
      ->option_text("FILE.st");
  app.add_option("--log", options->logs, "A measured record; may be repeated.")
      ->required()
      ->option_text("LOG.csv")
      ->allow_extra_args(false);
  add_record_options(app, options->record);
  app.add_option("--params", options->diagram.parameters, "Its tuned parameters.")->option_text("P.toml");
  app.add_option("--out", options->output, "A folder for what is found.")->required()->option_text("DIR");
  app.add_option("--top", options->diagram.top, "The block to take, where the file has several that no other contains.")
      ->option_text("NAME");
  app.add_option("--material", options->diagnosis.material,
                 "The smallest gap that matters, RMS in the unit of the output; half the noise counts at least.")
      ->check(number_from_zero())
      ->option_text("SIZE");
  app.add_option("--effects", options->effects, "Tries these effects alone, by their identifiers.")
      ->delimiter(',')
      ->option_text("A,B,…");
  app.add_option("--ignore", options->ignored,
                 "Columns of the logs that drive nothing, as a set point beside a loop; also ignore = [\"SP\"] under "
                 "[diagnose] in P.toml.")
      ->delimiter(',')
      ->option_text("A,B,…");
  app.add_option("--most", options->diagnosis.most_effects, "The most effects that are combined.")
      ->check(CLI::Range(1, 4))
      ->option_text("N");
  app.add_option("--limit", options->limits,
                 "The largest size of an input in the next experiment, as U=5.0; its ends and fastest change: U.low, "
                 "U.high, U.rate.")
      ->option_text("INPUT=SIZE")
      ->allow_extra_args(false);
  app.add_option(
         "--effort", options->diagnosis.effort,
         "How long the search goes on: 2 is twice as long as without it. It is counted in simulated work, so that "
         "a slow or busy machine gives the same verdict.")
      ->check(number_above_zero())
      ->option_text("E");
  app.add_option("--time-limit", options->diagnosis.time_limit,
                 "Seconds after which no further effect is added. The verdict may then be another on another machine.")
      ->check(number_above_zero())
      ->option_text("SECONDS");
  app.add_option(
         "--prior", options->prior,
         "What siblings of the machine say, by `hysteron fleet-report --prior`: a family of effects that they have is "
         "more probable. The verdict tells the probability by this record alone, too.")
      ->option_text("PRIOR.json");
  app.add_flag("--explain", options->diagnosis.explain,
               "Tells which rules decided, as measured and against which threshold; in verdict.json, too.");
  app.add_option("--without", options->diagnosis.without, "Leaves a rule of the policy out, to see what it decides.")
      ->option_text("RULE")
      ->allow_extra_args(false);
  app.add_option("--trace", options->trace, "What `hysteron serve` recorded of the controller while the log was taken.")
      ->option_text("RUN.trace");
  app.add_option("--controller", options->controller.file, "The diagram that it ran.")->option_text("CONTROLLER.st");
  app.add_option("--controller-params", options->controller.parameters, "Its parameters.")->option_text("P.toml");
  app.add_option("--seed", options->diagnosis.seed, "Of the bootstrap.")->check(whole_number_from(0))->option_text("N");
  app.add_option("--threads", options->diagnosis.threads,
                 "How many threads work; all cores without it. The verdict is the same with any number.")
      ->check(CLI::Range(1, 1024))
      ->option_text("N");
  add_fmu_options(app);
  app.add_flag("--any-order", options->diagram.any_order, "The order of the statements means nothing.");
  app.add_flag("--json", options->json, "Prints verdict.json.");
  app.footer(std::string(diagnose_examples));
  return [options](Console& console) { return diagnose(*options, console); };
}

}  // namespace hysteron::tool
