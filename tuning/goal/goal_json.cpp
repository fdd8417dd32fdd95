#include "tuning/goal/goal_json.hpp"

#include <nlohmann/json.hpp>
#include <string>

#include "support/json_number.hpp"

namespace hysteron {
namespace {

using nlohmann::json;

std::string status_name(GoalStatus status) {
  switch (status) {
    case GoalStatus::Tuned:
      return "tuned";
    case GoalStatus::NotConverged:
      return "not converged";
    case GoalStatus::Contradiction:
      return "contradiction";
    case GoalStatus::Cancelled:
      return "cancelled";
  }
  return {};
}

std::string state_name(LoopState state) {
  switch (state) {
    case LoopState::Settles:
      return "settles";
    case LoopState::NotFinite:
      return "not finite";
    case LoopState::Unstable:
      return "unstable";
    case LoopState::TooSlow:
      return "too slow";
  }
  return {};
}

json margin_json(const Margin& margin) {
  return {{"value", number_or_null<json>(margin.value)}, {"frequency", margin.frequency}};
}

json figures_json(const LoopFigures& figures) {
  json result = {{"error", figures.error},
                 {"overshoot_percent", number_or_null<json>(figures.overshoot)},
                 {"rise_time", number_or_null<json>(figures.rise_time)},
                 {"settling_time", number_or_null<json>(figures.settling_time)},
                 {"effort", number_or_null<json>(figures.effort)},
                 {"effort_rate", number_or_null<json>(figures.rate)},
                 {"margins", nullptr}};
  if (figures.margins) {
    result["margins"] = {{"gain_margin_db", margin_json(figures.margins->gain)},
                         {"phase_margin_deg", margin_json(figures.margins->phase)},
                         {"sensitivity", margin_json(figures.margins->sensitivity)},
                         {"crossover", figures.margins->crossover}};
  }
  return result;
}

}  // namespace

json goal_json(const GoalProblem& problem, const GoalResult& result) {
  json list = {{"diagram", problem.graph().name},
               {"status", status_name(result.status)},
               {"message", result.message},
               {"input", problem.graph().inputs[problem.input].name},
               {"output", problem.graph().outputs[problem.output].name},
               {"start", state_name(result.start_state)},
               {"iterations", result.iterations},
               {"evaluations", result.evaluations},
               {"seconds", result.seconds},
               {"parameters", json::array()},
               {"plants", json::array()},
               {"limits", json::array()},
               {"start_errors", json::array()}};
  for (std::size_t j = 0; j < problem.parameters.size(); ++j) {
    const FreeParameter& free = problem.parameters[j];
    list["parameters"].push_back({{"name", free.name},
                                  {"value", result.x[static_cast<Eigen::Index>(j)]},
                                  {"start", free.start},
                                  {"unit", free.unit},
                                  {"at_bound", bound_name(result.at_bound[j])}});
  }
  for (const PlantResult& plant : result.plants) {
    list["plants"].push_back({{"name", plant.name},
                              {"before", plant.before ? figures_json(*plant.before) : json(nullptr)},
                              {"after", figures_json(plant.after)}});
  }
  for (const LimitResult& limit : result.limits) {
    list["limits"].push_back({{"name", text_of(problem.limits[limit.limit].kind).key.name},
                              {"plant", problem.plants[limit.plant].name},
                              {"limit", problem.limits[limit.limit].limit},
                              {"value", number_or_null<json>(limit.value)},
                              {"kept", limit.is_kept},
                              {"active", limit.is_active},
                              {"against", limit.against}});
  }
  for (const double error : result.start_errors) {
    list["start_errors"].push_back(number_or_null<json>(error));
  }
  return list;
}

}  // namespace hysteron
