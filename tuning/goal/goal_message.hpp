// What is said of a search for a goal in one sentence, and how long its test lasts.
#pragma once

#include <string>

#include "tuning/goal/goal_search.hpp"

namespace hysteron {

/// How long the test lasts from its step on, with its unit: 1.5 s.
[[nodiscard]] std::string length_of_test(const GoalProblem& problem);

/// Of a result that is otherwise complete.
[[nodiscard]] std::string message_of(const GoalProblem& problem, const GoalResult& result);

}  // namespace hysteron
