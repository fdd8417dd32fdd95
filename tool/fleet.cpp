#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "codegen/graph/fmu_block.hpp"
#include "codegen/language/syntax.hpp"
#include "codegen/parameters/parameter_file.hpp"
#include "diagnosis/prior.hpp"
#include "fleet/manifest.hpp"
#include "fleet/run.hpp"
#include "fleet/share.hpp"
#include "fleet/table.hpp"
#include "support/errors.hpp"
#include "support/numbers.hpp"
#include "support/overwriting.hpp"
#include "support/progress.hpp"
#include "tool/commands.hpp"
#include "tool/option_values.hpp"
#include "tool/version.hpp"
#include "tool/writable.hpp"
#include "tuning/goal/goal_problem.hpp"

namespace hysteron::tool {
namespace {

constexpr std::string_view fleet_examples = R"(Examples:
  hysteron fleet fleet.csv --out fleet
  hysteron fleet fleet.csv --out fleet --workers 8 --time-limit 120 --retry
  hysteron fleet fleet.csv --out fleet --command tune
  hysteron fleet fleet.csv --out fleet --share 1/2

MANIFEST is CSV with a line for each record. Its columns are machine,diagram,params,log and, if wanted, when,group,command;
names of files are relative to it. `tune` of parameters with [goal] needs no log. Each record is diagnosed, tuned or
checked by a process of its own, with limits of time and memory. DIR gets results.csv, fleet.sqlite, and a folder for each record with what its command writes, result.json and
messages.txt. `hysteron fleet-report DIR` says which machines drift or stand out.
A second run does what has changed: machine, time, diagram and FMUs, parameters, record, command, options or version. It may be
killed at any moment; the same command goes on. Several commands may work in one folder at once, each on its share or all on
the whole. Under mpirun, srun and in a job array of Slurm each takes its share by itself.
Exit codes: 0 each record of the share has a result; 1 some have none, results.csv says why; 2 an error in manifest or command line.
)";

struct FleetOptions {
  std::string manifest;
  std::string command = "diagnose";
  std::string output;
  std::string share;
  std::string prior;
  double effort = 1.0;
  double material = 0.0;
  fleet::RunOptions run;
  bool json = false;
};

/// The files that a diagram names (`@file`), which decide what comes of it.
std::vector<std::string> files_named_in(const std::string& diagram) {
  Diagnostics unused;  // the command of the unit says what is wrong with it
  const auto source = language::parse_file(diagram, unused);
  std::vector<std::string> files;
  for (const auto& block : source.blocks) {
    for (const auto& variable : block.variables) {
      for (const auto& annotation : variable.annotations) {
        if (annotation.key == "file") {
          files.push_back(fmu_path(source, annotation.value));
        }
      }
    }
  }
  return files;
}

/// The plants of a goal, which a tuning depends on.
std::vector<std::string> plants_named_in(const std::string& parameter_file) {
  std::vector<std::string> files;
  try {
    for (const auto& plant : parameters::read_parameter_file(parameter_file).goal.plants) {
      files.push_back(file_of_plant(parameter_file, plant.text));
    }
  } catch (const InputError&) {  // the command of the unit says what is wrong with it
  }
  return files;
}

/// The share that is asked for, or that MPI or Slurm gives.
void choose_share(FleetOptions& options) {
  const auto share = options.share.empty() ? fleet::share_from([](const char* name) { return std::getenv(name); })
                                           : std::optional(fleet::share_of(options.share));
  if (!share) {
    return;
  }
  options.run.share = share->part;
  options.run.shares = share->parts;
  if (options.share.empty()) {
    Console::note(options.manifest, fmt::format("works share {}/{} by {}", share->part, share->parts, share->from));
  }
}

int run_fleet(FleetOptions options, Console& console) {
  refuse_unwritable_folder(options.output);
  refuse_to_overwrite({.file = options.output + "/results.csv", .mend = "give another folder for --out."},
                      {{.file = options.manifest}});
  choose_share(options);
  const auto units = fleet::read_manifest(options.manifest, *fleet::command_named(options.command));
  // One thread each: the workers are what runs at once.
  options.run.options = {"--threads", "1", "--effort", number_text(options.effort)};
  if (options.material > 0.0) {
    options.run.options.insert(options.run.options.end(), {"--material", number_text(options.material)});
  }
  options.run.program = std::filesystem::read_symlink("/proc/self/exe").string();
  options.run.version = version;
  options.run.output = options.output;
  if (!options.prior.empty()) {
    (void)diagnosis::read_prior(options.prior, {});  // told once, not by each record
    options.run.options.insert(options.run.options.end(), {"--prior", options.prior});
  }
  options.run.named_files = {.by_diagram =
                                 [&](const std::string& diagram) {
                                   std::vector<std::string> files = files_named_in(diagram);
                                   if (!options.prior.empty()) {
                                     files.push_back(options.prior);
                                   }
                                   return files;
                                 },
                             .by_parameters = plants_named_in};
  Progress line("Working");
  options.run.progress = [&](std::size_t done, std::size_t all, const fleet::Unit& last) {
    line.update(static_cast<double>(done) / static_cast<double>(all),
                fmt::format("{} of {}, {}", done, all, last.machine));
  };
  const fleet::Worked worked = fleet::work_off(units, options.manifest, options.run);
  line.finish();
  const auto rows = fleet::write_table(units, worked.keys, options.output);
  const auto counts = fleet::counts_of(rows);
  if (options.json) {
    console.print(fleet::table_json(rows, options.run.version));
  } else {
    console.print(fmt::format("{} of {} records have a result, {} refused, {} failed, {} open; {} worked now\n",
                              counts[1], rows.size(), counts[2], counts[3], counts[0], worked.ran));
    for (const fleet::Row& row : rows) {
      if (!row.result.reason.empty()) {
        console.print(fmt::format("  {}{}{}: {}: {}\n", row.unit.machine, row.unit.when.empty() ? "" : " of ",
                                  row.unit.when, name_of(row.result.status), row.result.reason));
      }
    }
    console.print(fmt::format("{0}/results.csv\n{0}/fleet.sqlite\n", options.output));
  }
  for (std::size_t i = options.run.share - 1; i < rows.size(); i += options.run.shares) {
    if (rows[i].result.status != fleet::Status::Done) {
      return exit_findings;
    }
  }
  return exit_ok;
}

}  // namespace

Action add_fleet(CLI::App& app) {
  const auto options = std::make_shared<FleetOptions>();
  options->run.workers = std::max(1U, std::thread::hardware_concurrency());
  app.add_option("MANIFEST", options->manifest, "The manifest, CSV.")->required()->option_text("MANIFEST.csv");
  app.add_option("--out", options->output, "A folder for the results.")->required()->option_text("DIR");
  app.add_option("--command", options->command, "For lines that name none: diagnose (the default), tune or check.")
      ->check(CLI::IsMember({"diagnose", "tune", "check"}))
      ->option_text("COMMAND");
  app.add_option("--workers", options->run.workers, "How many processes at once; as many as cores without it.")
      ->check(CLI::Range(1, 1024))
      ->option_text("N");
  app.add_option("--time-limit", options->run.time_limit, "Seconds for each record, 600 without it.")
      ->check(number_between(0.001, 1e6))
      ->option_text("SECONDS");
  app.add_option("--memory", options->run.megabytes, "Megabytes of address space for each record, 4096 without it.")
      ->check(CLI::Range(1, 1 << 20))
      ->option_text("MB");
  app.add_option("--effort", options->effort, "As of `hysteron diagnose`.")
      ->check(number_above_zero())
      ->option_text("E");
  app.add_option("--material", options->material, "As of `hysteron diagnose`.")
      ->check(number_from_zero())
      ->option_text("SIZE");
  app.add_option("--prior", options->prior, "As of `hysteron diagnose`.")->option_text("PRIOR.json");
  app.add_option("--share", options->share, "Works the records K, K + N, K + 2 N, … alone; else MPI or Slurm say it.")
      ->option_text("K/N");
  app.add_flag("--retry", options->run.retry, "Does records that had failed again, as after a larger limit.");
  app.add_flag("--json", options->json, "Prints the results as JSON.");
  app.footer(std::string(fleet_examples));
  return [options](Console& console) { return run_fleet(*options, console); };
}

}  // namespace hysteron::tool
