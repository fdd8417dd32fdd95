// What is said where the limits of a goal were not kept together.
#pragma once

#include "support/diagnostic.hpp"
#include "tuning/goal/goal_search.hpp"

namespace hysteron {

/// HY533: which limits stand against which, with what was reached of each, and the bounds that hold the controller
/// back.
void report_contradiction(const GoalProblem& problem, const GoalResult& result, Diagnostics& diagnostics);

}  // namespace hysteron
