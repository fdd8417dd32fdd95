#include "tool/tune_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "records/csv.hpp"
#include "tool/tune_page.hpp"

namespace hysteron::tool {
namespace {

using Eigen::Index;

/// JSON has no infinities: what is not known is null.
nlohmann::json number(double value) {
  return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json(nullptr);
}

std::string status_name(FitStatus status) {
  switch (status) {
    case FitStatus::Converged:
      return "converged";
    case FitStatus::NearlyConverged:
      return "nearly converged";
    case FitStatus::IterationLimit:
      return "iteration limit";
    case FitStatus::Cancelled:
      return "cancelled";
    case FitStatus::Stalled:
      return "stalled";
    case FitStatus::NoInfluence:
      return "no influence";
    case FitStatus::Diverging:
      return "diverging";
    case FitStatus::ModelFailed:
      return "model failed";
    case FitStatus::SolverFailed:
      return "solver failed";
  }
  return {};
}

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

bool stays_at_start(const TuneReport& report) {
  const auto& free = report.problem.parameters;
  return std::ranges::all_of(
      free, [&](const FreeParameter& one) { return report.fit.solution.x[&one - free.data()] == one.start; });
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
  text += '\n';
  for (const std::string& warning : fit.covariance.warnings) {
    text += warning + '\n';
  }
  text += starts_text(fit);
  text += what_is_not_in_the_model(report);
  if (stays_at_start(report)) {
    text += "Nothing better than the start was found: its values are kept.\n";
  }
  return text + fmt::format("{} {}, {:.2f} s.\n", fit.solution.message, iterations_of(fit), fit.seconds);
}

nlohmann::json as_json(const TuneReport& report) {
  const OutputErrorProblem& problem = report.problem;
  const OutputErrorFit& fit = report.fit;
  nlohmann::json json = {{"diagram", problem.program.graph.name},
                         {"status", status_name(fit.solution.status)},
                         {"message", fit.solution.message},
                         {"iterations", fit.solution.iterations},
                         {"seconds", fit.seconds},
                         {"correlation_time_samples", number(fit.covariance.correlation_time)},
                         {"warnings", fit.covariance.warnings},
                         {"not_in_the_model", what_is_not_in_the_model(report)},
                         {"parameters", nlohmann::json::array()},
                         {"initial_states", nlohmann::json::array()},
                         {"outputs", nlohmann::json::array()},
                         {"correlation", nlohmann::json::array()},
                         {"start_costs", nlohmann::json::array()}};
  for (std::size_t i = 0; i < fit.names.size(); ++i) {
    const auto j = static_cast<Index>(i);
    const AtBound bound = fit.solution.at_bound[i];
    json[i < problem.parameters.size() ? "parameters" : "initial_states"].push_back(
        {{"name", fit.names[i]},
         {"value", fit.solution.x[j]},
         {"standard_error", number(fit.covariance.standard_errors[j])},
         {"unit", fit.units[i]},
         {"at_bound", bound == AtBound::Lower   ? "lower"
                      : bound == AtBound::Upper ? "upper"
                                                : ""}});
    nlohmann::json row = nlohmann::json::array();
    for (Index k = 0; k < std::ssize(fit.names); ++k) {
      row.push_back(number(fit.covariance.correlation(j, k)));
    }
    json["correlation"].push_back(std::move(row));
  }
  for (const OutputScore& score : fit.scores) {
    json["outputs"].push_back({{"name", score.output},
                               {"unit", score.unit},
                               {"range", score.range},
                               {"range_test", score.test_range},
                               {"rmse_train", number(score.train)},
                               {"rmse_test", number(score.test)},
                               {"rmse_before", number(score.before)},
                               {"train_samples", score.train_samples},
                               {"test_samples", score.test_samples}});
  }
  for (const double cost : fit.start_costs) {
    json["start_costs"].push_back(number(cost));
  }
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
    contents.push_back(records::csv_text({experiment.time, experiment.drive.sample_time, std::move(columns), {}}));
  }
  const auto paths = report_paths(folder, report.problem.experiments.size());
  std::vector<OutputFile> files;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    files.push_back({.path = paths[i], .contents = std::move(contents[i])});
  }
  return files;
}

}  // namespace hysteron::tool
