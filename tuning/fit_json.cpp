#include "tuning/fit_json.hpp"

#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "codegen/cosimulation/fmu.hpp"
#include "codegen/interpreter/directions.hpp"
#include "support/json_number.hpp"

namespace hysteron {
namespace {

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
    case FitStatus::WorseThanConstant:
      return "worse than a constant";
    case FitStatus::Unbounded:
      return "unbounded";
    case FitStatus::ModelFailed:
      return "model failed";
    case FitStatus::SolverFailed:
      return "solver failed";
  }
  return {};
}

/// What each FMU cost, and where its derivatives are from.
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

}  // namespace

nlohmann::json fit_json(const OutputErrorProblem& problem, const OutputErrorFit& fit) {
  nlohmann::json json = {{"diagram", problem.program.graph.name},
                         {"status", status_name(fit.solution.status)},
                         {"message", fit.solution.message},
                         {"iterations", fit.solution.iterations},
                         {"seconds", fit.seconds},
                         {"correlation_time_samples", number_or_null<nlohmann::json>(fit.covariance.correlation_time)},
                         {"warnings", fit.covariance.warnings},
                         {"parameters", nlohmann::json::array()},
                         {"initial_states", nlohmann::json::array()},
                         {"outputs", nlohmann::json::array()},
                         {"correlation", nlohmann::json::array()},
                         {"start_costs", nlohmann::json::array()}};
  for (std::size_t i = 0; i < fit.names.size(); ++i) {
    const auto j = static_cast<Eigen::Index>(i);
    json[i < problem.parameters.size() ? "parameters" : "initial_states"].push_back(
        {{"name", fit.names[i]},
         {"value", fit.solution.x[j]},
         {"standard_error", number_or_null<nlohmann::json>(fit.covariance.standard_errors[j])},
         {"unit", fit.units[i]},
         {"at_bound", bound_name(fit.solution.at_bound[i])}});
    nlohmann::json row = nlohmann::json::array();
    for (Eigen::Index k = 0; k < std::ssize(fit.names); ++k) {
      row.push_back(number_or_null<nlohmann::json>(fit.covariance.correlation(j, k)));
    }
    json["correlation"].push_back(std::move(row));
  }
  for (const OutputScore& score : fit.scores) {
    json["outputs"].push_back({{"name", score.output},
                               {"unit", score.unit},
                               {"range", score.range},
                               {"range_test", score.test_range},
                               {"rmse_train", number_or_null<nlohmann::json>(score.train)},
                               {"rmse_test", number_or_null<nlohmann::json>(score.test)},
                               {"rmse_before", number_or_null<nlohmann::json>(score.before)},
                               {"train_samples", score.train_samples},
                               {"test_samples", score.test_samples}});
  }
  for (const double cost : fit.start_costs) {
    json["start_costs"].push_back(number_or_null<nlohmann::json>(cost));
  }
  json["fmus"] = fmus_json(problem.program.graph);
  return json;
}

}  // namespace hysteron
