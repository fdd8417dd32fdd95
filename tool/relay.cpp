#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>

#include "records/read.hpp"
#include "support/atomic_file.hpp"
#include "support/errors.hpp"
#include "support/overwriting.hpp"
#include "tool/commands.hpp"
#include "tool/record_options.hpp"
#include "tool/tune_words.hpp"
#include "tool/writable.hpp"
#include "tuning/relay_experiment.hpp"
#include "tuning/relay_json.hpp"

namespace hysteron::tool {
namespace {

constexpr std::string_view relay_examples = R"(Examples:
  hysteron relay relay.csv --u U --y Y
  hysteron relay relay.csv --u U --y Y --controller PID --out start.toml
  hysteron relay relay.csv --u U --y Y --json

The record is that of a relay in place of the controller: U jumps between two levels, Y oscillates, and at least four
oscillations are in it. Where it begins at rest, and the relay is not symmetric about that, the static gain is told too,
and with it a lag with a dead time. Gains are in the units of the record's columns: those of the diagram have to be the
same, or --column U=NAME[mV] states them. --out writes the values of a PID to begin with, as a file for `hysteron tune`.
Exit codes: 0 done; 2 no relay experiment, or bad usage.
)";

struct RelayOptions {
  std::string file;
  std::string u;
  std::string y;
  std::string controller = "PID";
  std::string output;
  RecordOptions record;
  bool json = false;
};

std::string controller_text(const std::string& name, const ControllerStart& start, const std::string& unit) {
  return fmt::format("{:<4} KP = {:.4g}{}, TR = {:.4g} s{}\n", name, start.gain, unit_behind(unit), start.reset_time,
                     start.rate_time > 0.0 ? fmt::format(", TD = {:.4g} s", start.rate_time) : "");
}

std::string relay_text(const RelayExperiment& relay) {
  const std::string& y_unit = relay.y_unit;
  const std::string of_process = unit_behind(relay.process_unit());
  const std::string of_controller = relay.controller_unit();
  std::string text = fmt::format(
      "relay       {:.4g} to {:.4g}{}, {:.0f} % of the time high, hysteresis {:.3g}{}\n"
      "oscillation {} cycles of {:.4g} s (spread {:.1f} %), amplitude {:.4g}{}\n"
      "process     gain {:.4g}{} at {:.4g} rad/s, phase {:.1f} deg{}\n"
      "ultimate    gain Ku = {:.4g}{}, period Tu = {:.4g} s\n",
      relay.low, relay.high, unit_behind(relay.u_unit), 100.0 * relay.duty, relay.hysteresis, unit_behind(y_unit),
      relay.cycles, relay.period, 100.0 * relay.spread, relay.amplitude, unit_behind(y_unit), relay.gain, of_process,
      2.0 * std::numbers::pi / relay.period, relay.phase, relay.direction < 0.0 ? ", and it falls with the relay" : "",
      relay.ultimate_gain, unit_behind(of_controller), relay.ultimate_period);
  text += relay.model ? fmt::format("model       K = {:.4g}{}, T = {:.4g} s, dead time {:.4g} s\n", relay.model->gain,
                                    of_process, relay.model->time, relay.model->dead_time)
                      : fmt::format("model       none: {}\n", relay.why_no_model);
  return text + "start       " + controller_text("PI", relay.pi(), of_controller) + "            " +
         controller_text("PID", relay.pid(), of_controller);
}

int relay(const RelayOptions& options, Console& console) {
  if (!options.output.empty()) {
    refuse_to_overwrite({.file = options.output}, {{.file = options.file, .named_by = "the record"}});
    refuse_unwritable(options.output);
  }
  const records::Record record = records::read_record(options.file, read_options(options.record));
  for (const std::string& note : record.notes()) {
    Console::note(record.file(), note);
  }
  const RelayExperiment found = relay_experiment(record, options.u, options.y);
  const std::string parameters = relay_parameters(found, options.controller, options.file);
  if (!options.output.empty()) {
    write_files_atomically({{.path = options.output, .contents = parameters}});
  }
  console.print(options.json ? relay_json(found).dump(2) + "\n" : relay_text(found));
  return exit_ok;
}

}  // namespace

Action add_relay(CLI::App& app) {
  const auto options = std::make_shared<RelayOptions>();
  app.add_option("LOG", options->file, "The record of the experiment.")->required()->option_text("LOG");
  app.add_option("--u", options->u, "The column of what the relay wrote.")->required()->option_text("NAME");
  app.add_option("--y", options->y, "The column of the process value.")->required()->option_text("NAME");
  add_record_options(app, options->record);
  app.add_option("--controller", options->controller, "The controller in the diagram, for --out; PID by default.")
      ->option_text("NAME");
  app.add_option("--out", options->output, "Parameters to begin with, as a file for `hysteron tune`.")
      ->option_text("START.toml");
  app.add_flag("--json", options->json, "Prints JSON.");
  app.footer(std::string(relay_examples));
  return [options](Console& console) { return relay(*options, console); };
}

}  // namespace hysteron::tool
