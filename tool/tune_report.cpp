#include "tool/tune_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "codegen/cosimulation/fmu.hpp"
#include "codegen/graph/port_t.hpp"
#include "codegen/interpreter/directions.hpp"
#include "records/csv.hpp"
#include "support/rounded_text.hpp"
#include "tool/tune_page.hpp"
#include "tool/tune_words.hpp"
#include "tuning/fit_json.hpp"

namespace hysteron::tool {
namespace {

using Eigen::Index;

/// Which start was best, and what each left.
std::string starts_text(const OutputErrorFit& fit) {
  if (fit.start_costs.size() < 2) {
    return {};
  }
  const auto samples = static_cast<double>(fit.solution.residuals.size());
  std::string text =
      fmt::format("The best of {} starts was number {}. What each left, in % of the range{}:", fit.start_costs.size(),
                  fit.best_start + 1, fit.scores.size() > 1 ? "s" : "");
  for (std::size_t start = 0; start < fit.start_costs.size(); ++start) {
    const double cost = fit.start_costs[start];
    text += std::isnan(cost) ? fmt::format(" {} no value;", start + 1)
                             : fmt::format(" {} {:.3g};", start + 1, 100.0 * std::sqrt(2.0 * cost / samples));
  }
  text.back() = '.';
  return text + " Number 1 is the file's own.\n";
}

/// What an FMU cost, and where its derivatives are from.
std::string fmus_text(const Graph& graph) {
  std::string text;
  for (const Node& node : graph.nodes) {
    if (node.block == nullptr || node.block->fmu == nullptr) {
      continue;
    }
    const auto& counts = node.block->fmu->counts();
    text += fmt::format(
        "{} is an FMU, which gives no derivatives of a run: they are differences between instances of it, moved by {} "
        "of each parameter. {} took {} instances and {} steps.\n",
        node.path, Directions::relative_step, node.block->fmu->path(), counts.instances.load(), counts.steps.load());
  }
  return text;
}

bool stays_at_start(const TuneReport& report) {
  const auto& free = report.problem.parameters;
  return std::ranges::all_of(
      free, [&](const FreeParameter& one) { return report.fit.solution.x[&one - free.data()] == one.start; });
}

/// Records of which a good part is neither fitted nor tested: intervals of a shorter record, as of a template.
std::string unused_text(const TuneReport& report) {
  std::string text;
  for (const Experiment& experiment : report.problem.experiments) {
    std::size_t used = 0;
    for (const auto* const ranges : {&experiment.train, &experiment.test}) {
      for (const records::RowRange& range : *ranges) {
        used += range.size();
      }
    }
    const std::size_t samples = experiment.time.size();
    if (4 * used < 3 * samples) {
      text += fmt::format(
          "{} of the {} samples of {} are neither in train nor in test of [tune]: the record goes from {} s to {} s.\n",
          samples - used, samples, experiment.name, rounded_text(experiment.time.front()),
          rounded_text(experiment.time.back()));
    }
  }
  return text;
}

}  // namespace

std::string as_text(const TuneReport& report) {
  const OutputErrorFit& fit = report.fit;
  std::size_t widest = 9;
  for (const std::string& name : fit.names) {
    widest = std::max(widest, name.size());
  }
  std::string text = fmt::format("{:<{}}  {:<14}  {:<18}  unit\n", "parameter", widest, "value", "standard error");
  for (std::size_t i = 0; i < fit.names.size(); ++i) {
    const auto j = static_cast<Index>(i);
    text += fmt::format("{:<{}}  {:<14.8g}  {:<18}  {}\n", fit.names[i], widest, fit.solution.x[j],
                        error_text(fit.solution, fit.covariance.standard_errors[j], i), fit.units[i]);
  }
  for (const OutputScore& score : fit.scores) {
    const auto unit = unit_behind(score.unit);
    text += fmt::format("\n{}: range {:.4g}{}\n  RMSE in train  {:.4g}{}{} ({} samples; {:.4g}{} before the fit)\n",
                        score.output, score.range, unit, score.train, unit, share_of(score.train, score.range),
                        score.train_samples, score.before, unit);
    text += score.test_samples == 0 ? "  RMSE in test   no test intervals are given in [tune]\n"
                                    : fmt::format("  RMSE in test   {:.4g}{}{} ({} samples)\n", score.test, unit,
                                                  share_of(score.test, score.test_range), score.test_samples);
  }
  text += '\n' + unused_text(report);
  for (const std::string& warning : fit.covariance.warnings) {
    text += warning + '\n';
  }
  text += starts_text(fit);
  text += fmus_text(report.problem.program.graph);
  text += what_is_not_in_the_model(report);
  if (stays_at_start(report)) {
    text += "Nothing better than the start was found: its values are kept.\n";
  }
  return text + fmt::format("{} {}, {:.2f} s.\n", fit.solution.message, iterations_of(fit), fit.seconds);
}

nlohmann::json as_json(const TuneReport& report) {
  nlohmann::json json = fit_json(report.problem, report.fit);
  json["not_in_the_model"] = what_is_not_in_the_model(report);
  return json;
}

std::vector<std::filesystem::path> report_paths(const std::filesystem::path& folder, std::size_t records) {
  std::vector<std::filesystem::path> paths{folder / "report.html", folder / "report.json"};
  for (std::size_t record = 0; record < records; ++record) {
    paths.push_back(folder /
                    (record == 0 ? std::string("residuals.csv") : fmt::format("residuals-{}.csv", record + 1)));
  }
  return paths;
}

std::vector<OutputFile> report_files(const std::filesystem::path& folder, const TuneReport& report) {
  std::vector<std::string> contents{tune_page(report), as_json(report).dump(2) + "\n"};
  for (std::size_t record = 0; record < report.problem.experiments.size(); ++record) {
    const Experiment& experiment = report.problem.experiments[record];
    std::vector<records::Column> columns;
    for (std::size_t output = 0; output < report.problem.outputs.size(); ++output) {
      const Port& port = report.problem.program.graph.outputs[report.problem.outputs[output]];
      columns.push_back({port.name, port.unit, experiment.measured[output]});
      columns.push_back({port.name + "_MODEL", port.unit, report.fit.model[record][output]});
      columns.push_back({port.name + "_RESIDUAL", port.unit, residuals_of(report, record, output)});
    }
    records::Record residuals(experiment.time, experiment.drive.sample_time, std::move(columns), {});
    residuals.set_beside_t(port_called_t(report.problem.program.graph) != nullptr);
    contents.push_back(records::csv_text(residuals));
  }
  const auto paths = report_paths(folder, report.problem.experiments.size());
  std::vector<OutputFile> files;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    files.push_back({.path = paths[i], .contents = std::move(contents[i])});
  }
  return files;
}

}  // namespace hysteron::tool
