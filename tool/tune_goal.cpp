#include "tool/tune_goal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "codegen/compile.hpp"
#include "support/atomic_file.hpp"
#include "support/progress.hpp"
#include "tool/commands.hpp"
#include "tool/goal_report.hpp"
#include "tuning/goal/contradiction.hpp"
#include "tuning/goal/goal_json.hpp"

namespace hysteron::tool {
namespace {

std::string progress_text(const GoalProgress& progress) {
  return progress.excess > 0.0
             ? fmt::format("iteration {}, a limit is broken by {:.3g} % of itself", progress.iteration,
                           100.0 * progress.excess)
             : fmt::format("iteration {}, error {:.3g} %", progress.iteration, 100.0 * progress.error);
}

}  // namespace

int tune_goal(const TuneOptions& options, const parameters::ParameterFile& file, Console& console) {
  prove_outputs(options, goal_report_paths(options.report, std::max<std::size_t>(file.goal.plants.size(), 1)));
  Diagnostics warnings;
  const Program program =
      compile_file(options.diagram.file,
                   {.top = options.diagram.top, .any_order = options.diagram.any_order, .keep_names = true}, warnings);
  const std::vector<records::Record> records =
      options.logs.empty()
          ? std::vector<records::Record>()
          : read_and_told(options.logs, with_settings(options.record, file.record), program, true, warnings,
                          file.goal.wished ? std::string_view(file.goal.wished->text) : std::string_view());
  const GoalProblem problem = goal_problem(program, file, records);
  for (const std::string& note : problem.notes) {
    Console::note(records.front().file(), note);
  }
  warnings.add_all(problem.found);
  GoalResult result;
  {
    const InterruptWatch watch;
    Progress line("Tuning");
    GoalOptions tuning{.starts = options.starts};
    tuning.progress = [&](const GoalProgress& progress) {
      // How many iterations are left nobody knows; most searches take some fifty.
      const double within = std::min(0.95, static_cast<double>(progress.iteration) / 50.0);
      line.update((progress.start + within) / std::max(1, options.starts), progress_text(progress));
      return !watch.interrupted();
    };
    result = tune_for_goal(problem, tuning);
    line.finish();
  }
  std::vector<OutputFile> files =
      options.report.empty() ? std::vector<OutputFile>() : goal_report_files(options.report, problem, result);
  files.push_back({.path = options.output,
                   .contents = parameters::parameter_text(tuned_file(file, problem, result), tuned_remarks(problem),
                                                          tuned_heading(problem, result))});
  write_files_atomically(files);
  console.print(options.json ? goal_json(problem, result).dump(2) + "\n" : goal_text(problem, result));
  if (result.status == GoalStatus::Contradiction) {
    report_contradiction(problem, result, warnings);
  }
  console.report(warnings);
  if (result.status == GoalStatus::Cancelled) {
    return exit_interrupted;
  }
  return result.status == GoalStatus::Tuned ? exit_ok : exit_findings;
}

}  // namespace hysteron::tool
