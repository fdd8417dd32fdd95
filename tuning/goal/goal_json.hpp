// A tuning for a goal as JSON: what `hysteron tune --json` prints of a file with [goal].
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "tuning/goal/goal_search.hpp"

namespace hysteron {

[[nodiscard]] nlohmann::json goal_json(const GoalProblem& problem, const GoalResult& result);

}  // namespace hysteron
