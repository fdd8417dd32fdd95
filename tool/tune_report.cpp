#include "tool/tune_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "codegen/cosimulation/fmu.hpp"
#include "codegen/interpreter/directions.hpp"
#include "records/csv.hpp"
#include "support/markup.hpp"
#include "tool/line_plot.hpp"

namespace hysteron::tool {
namespace {

std::string iterations_of(const OutputErrorFit& fit) {
  return fmt::format("{} iteration{}", fit.solution.iterations, fit.solution.iterations == 1 ? "" : "s");
}

using Eigen::Index;

std::string unit_behind(const std::string& unit) {
  return unit.empty() || unit == "1" ? std::string() : " " + unit;
}

std::string error_text(const LeastSquaresResult& solution, double standard_error, std::size_t unknown) {
  if (solution.at_bound[unknown] == AtBound::Lower || solution.at_bound[unknown] == AtBound::Upper) {
    return solution.at_bound[unknown] == AtBound::Lower ? "on its lower bound" : "on its upper bound";
  }
  if (std::isinf(standard_error)) {
    return "not determined";
  }
  return std::isnan(standard_error) ? "unknown" : fmt::format("{:.2g}", standard_error);
}

std::string share_of(double error, double range) {
  return range > 0.0 ? fmt::format(", {:.3g} % of the range", 100.0 * error / range) : std::string();
}

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

Signal residuals_of(const TuneReport& report, std::size_t record, std::size_t output) {
  Signal residuals = report.fit.model[record][output];
  const Signal& measured = report.problem.experiments[record].measured[output];
  for (std::size_t k = 0; k < residuals.size(); ++k) {
    residuals[k] -= measured[k];
  }
  return residuals;
}

std::string with_unit(const std::string& name, const std::string& unit) {
  return unit.empty() ? name : fmt::format("{} [{}]", name, unit);
}

std::string pictures_of(const TuneReport& report, std::size_t record) {
  const Experiment& experiment = report.problem.experiments[record];
  const Graph& graph = report.problem.program.graph;
  std::string html;
  for (std::size_t output = 0; output < report.problem.outputs.size(); ++output) {
    const Port& port = graph.outputs[report.problem.outputs[output]];
    const Signal& model = report.fit.model[record][output];
    const Signal& measured = experiment.measured[output];
    const Signal residuals = residuals_of(report, record, output);
    const Line over_time[] = {{"measured", "#000000", experiment.time, measured},
                              {"model", "#d55e00", experiment.time, model}};
    html += line_plot({port.name + " over time", "t [s]", with_unit(port.name, port.unit)}, over_time);
    const Line left[] = {{"model - measured", "#0072b2", experiment.time, residuals}};
    html += line_plot({"Residual of " + port.name, "t [s]", with_unit(port.name, port.unit)}, left);
    for (std::size_t input = 0; input < graph.inputs.size(); ++input) {
      const Signal& u = experiment.drive.inputs[input];
      if (graph.inputs[input].type == Type::Real && u.size() == measured.size()) {
        const Line loop[] = {{"measured", "#000000", u, measured}, {"model", "#d55e00", u, model}};
        html +=
            line_plot({fmt::format("{} over {}", port.name, graph.inputs[input].name),
                       with_unit(graph.inputs[input].name, graph.inputs[input].unit), with_unit(port.name, port.unit)},
                      loop);
      }
    }
  }
  return html;
}

std::string page(const TuneReport& report) {
  std::string html = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>Fit of {0}</title>\n"
      "<style>body{{font-family:sans-serif;max-width:900px;margin:2em auto;color:#222}}"
      "table{{border-collapse:collapse}}td,th{{padding:.25em .8em;border-bottom:1px solid #ccc;text-align:left}}"
      "svg{{max-width:100%;height:auto;display:block;margin:1em 0}}</style></head>\n<body><h1>Fit of {0}</h1>\n"
      "<p>{1} {2}, {3:.2g} s.</p>\n",
      escaped(report.problem.program.graph.name), escaped(report.fit.solution.message), iterations_of(report.fit),
      report.fit.seconds);
  html += "<table><tr><th>parameter</th><th>value</th><th>standard error</th><th>unit</th></tr>\n";
  for (std::size_t i = 0; i < report.fit.names.size(); ++i) {
    const auto j = static_cast<Index>(i);
    html += fmt::format("<tr><td>{}</td><td>{:.8g}</td><td>{}</td><td>{}</td></tr>\n", escaped(report.fit.names[i]),
                        report.fit.solution.x[j],
                        error_text(report.fit.solution, report.fit.covariance.standard_errors[j], i),
                        escaped(report.fit.units[i]));
  }
  html += "</table>\n<table><tr><th>output</th><th>RMSE in train</th><th>RMSE in test</th><th>range</th></tr>\n";
  for (const OutputScore& score : report.fit.scores) {
    const auto cell = [&](double error, double range) {
      return std::isnan(error) ? std::string("no samples")
                               : fmt::format("{:.4g}{}{}", error, unit_behind(score.unit), share_of(error, range));
    };
    html += fmt::format("<tr><td>{}</td><td>{}</td><td>{}</td><td>{:.4g}{}</td></tr>\n", escaped(score.output),
                        escaped(cell(score.train, score.range)), escaped(cell(score.test, score.test_range)),
                        score.range, escaped(unit_behind(score.unit)));
  }
  html += "</table>\n<ul>\n";
  for (const std::string& warning : report.fit.covariance.warnings) {
    html += fmt::format("<li>{}</li>\n", escaped(warning));
  }
  html += "</ul>\n";
  for (std::size_t record = 0; record < report.problem.experiments.size(); ++record) {
    html += fmt::format("<h2>{}</h2>\n", escaped(report.problem.experiments[record].name));
    html += pictures_of(report, record);
  }
  return html + "</body></html>\n";
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

nlohmann::json fmus_json(const Graph& graph) {
  auto list = nlohmann::json::array();
  for (const Node& node : graph.nodes) {
    if (node.block != nullptr && node.block->fmu != nullptr) {
      const auto& counts = node.block->fmu->counts();
      list.push_back({{"instance", node.path},
                      {"file", node.block->fmu->path()},
                      {"derivatives", "differences"},
                      {"relative_step", Directions::relative_step},
                      {"instances", counts.instances.load()},
                      {"steps", counts.steps.load()}});
    }
  }
  return list;
}

bool stays_at_start(const TuneReport& report) {
  const auto& free = report.problem.parameters;
  return std::ranges::all_of(
      free, [&](const FreeParameter& one) { return report.fit.solution.x[&one - free.data()] == one.start; });
}

}  // namespace

std::string as_text(const TuneReport& report) {
  const auto& [problem, fit] = report;
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
  text += fmus_text(problem.program.graph);
  if (stays_at_start(report)) {
    text += "Nothing better than the start was found: its values are kept.\n";
  }
  return text + fmt::format("{} {}, {:.2f} s.\n", fit.solution.message, iterations_of(fit), fit.seconds);
}

nlohmann::json as_json(const TuneReport& report) {
  const auto& [problem, fit] = report;
  nlohmann::json json = {{"diagram", problem.program.graph.name},
                         {"status", status_name(fit.solution.status)},
                         {"message", fit.solution.message},
                         {"iterations", fit.solution.iterations},
                         {"seconds", fit.seconds},
                         {"correlation_time_samples", number(fit.covariance.correlation_time)},
                         {"warnings", fit.covariance.warnings},
                         {"parameters", nlohmann::json::array()},
                         {"initial_states", nlohmann::json::array()},
                         {"outputs", nlohmann::json::array()},
                         {"correlation", nlohmann::json::array()},
                         {"start_costs", nlohmann::json::array()},
                         {"fmus", fmus_json(problem.program.graph)}};
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
  std::vector<std::string> contents{page(report), as_json(report).dump(2) + "\n"};
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
