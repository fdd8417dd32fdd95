#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "fleet/report/analysis.hpp"
#include "fleet/report/fleet_data.hpp"
#include "fleet/report/fleet_page.hpp"
#include "fleet/report/prior_file.hpp"
#include "fleet/report/words.hpp"
#include "fleet/run_record.hpp"
#include "support/atomic_file.hpp"
#include "support/errors.hpp"
#include "support/overwriting.hpp"
#include "tool/commands.hpp"
#include "tool/option_values.hpp"
#include "tool/version.hpp"
#include "tool/writable.hpp"

namespace hysteron::tool {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view fleet_report_examples = R"(Examples:
  hysteron fleet-report fleet
  hysteron fleet-report fleet --out report.html --csv parameters.csv
  hysteron fleet-report fleet --json
  hysteron fleet-report fleet --prior prior.json --group valves

DIR is the folder of `hysteron fleet`. The report is of the records that its last manifest names, as far as they are worked:
which machines drift, in which parameter and since when, which stand out from their siblings, and which records have no result.
Siblings are the machines of a group, or of a diagram where the manifest has no groups. results.csv and fleet.sqlite are derived
anew. The page needs nothing beside itself; its links lead to the reports of the records in DIR.
Exit codes: 0 the report was made, whatever it says; 2 an error in the folder or the command line.
)";

struct FleetReportOptions {
  std::string folder;
  std::string output;
  std::string csv;
  std::string prior;
  std::string group;
  double false_share = 0.05;
  bool json = false;
};

/// The folder of the results, as a link from the page sees it.
fs::path seen_from(const std::string& page, const std::string& folder) {
  const fs::path from = fs::absolute(page).lexically_normal().parent_path();
  return fs::absolute(folder).lexically_normal().lexically_relative(from);
}

int report_fleet(const FleetReportOptions& options, Console& console) {
  for (const std::string& file : {options.output, options.csv, options.prior}) {
    if (!file.empty()) {
      refuse_unwritable(file);
    }
  }
  const auto runs = fleet::read_runs(options.folder);
  if (runs.empty()) {
    throw InputError(error::unreadable_file, {.file = options.folder}, "the folder holds no results of a fleet.",
                     "name the folder that `hysteron fleet MANIFEST --out DIR` was given.");
  }
  const fleet::Run& last = runs.back();
  const auto rows = fleet::write_table(last.units, last.keys, options.folder);
  const fleet::Analysis all = fleet::analysed(rows, options.false_share);
  std::vector<InputFile> inputs;
  for (const fleet::Run& run : runs) {
    inputs.push_back({.file = run.manifest});
    for (const fleet::Unit& unit : run.units) {
      inputs.insert(inputs.end(), {{.file = unit.diagram}, {.file = unit.parameters}, {.file = unit.log}});
    }
  }
  for (const std::string& file : {options.output, options.csv, options.prior}) {
    refuse_to_overwrite({.file = file}, inputs);
  }
  if (!options.output.empty()) {
    write_file_atomically(options.output, fleet::fleet_page(all, rows, seen_from(options.output, options.folder)));
  }
  if (!options.csv.empty()) {
    write_file_atomically(options.csv, fleet::report_csv(all));
  }
  if (!options.prior.empty()) {
    write_file_atomically(options.prior, fleet::prior_json(rows, options.group, options.folder));
  }
  if (options.json) {
    console.print(fleet::report_json(all, rows, version));
    return exit_ok;
  }
  std::string text;
  for (const std::string& one : fleet::headline(all, rows)) {
    text += (text.empty() ? "" : " ") + one;
  }
  text += "\n";
  for (const fleet::Finding& finding : all.findings) {
    text += fmt::format("  {}: {}\n", finding.machine, fleet::sentence(all, finding));
  }
  for (const std::string& file : {options.output, options.csv, options.prior}) {
    text += file.empty() ? "" : file + "\n";
  }
  console.print(text);
  return exit_ok;
}

}  // namespace

Action add_fleet_report(CLI::App& app) {
  const auto options = std::make_shared<FleetReportOptions>();
  app.add_option("DIR", options->folder, "The folder of `hysteron fleet`.")->required()->option_text(" ");
  app.add_option("--out", options->output, "The report as a page.")->option_text("REPORT.html");
  app.add_option("--csv", options->csv, "A line for each parameter of each machine.")->option_text("FILE.csv");
  app.add_option("--prior", options->prior,
                 "How often each family of effects is there, for `hysteron diagnose --prior`.")
      ->option_text("PRIOR.json");
  app.add_option("--group", options->group, "Of which siblings the prior is, where there are several groups.")
      ->option_text("NAME");
  app.add_option("--false-share", options->false_share,
                 "How many of the findings may be false on average, 0.05 without it.")
      ->check(number_between(1e-6, 0.5))
      ->option_text("SHARE");
  app.add_flag("--json", options->json, "Prints the report as JSON.");
  app.footer(std::string(fleet_report_examples));
  return [options](Console& console) { return report_fleet(*options, console); };
}

}  // namespace hysteron::tool
