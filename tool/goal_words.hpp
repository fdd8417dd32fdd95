// What a tuning for a goal says, in words and in rows: shared by its text and its page.
#pragma once

#include <string>
#include <vector>

#include "tuning/goal/goal_search.hpp"

namespace hysteron::tool {

/// "Y follows SP, a step of 1 um, as a response that settles in 0.5 s."
[[nodiscard]] std::string goal_sentence(const GoalProblem& problem);

/// A table with its heads; every row has as many cells.
struct TextTable {
  std::vector<std::string> heads{};
  std::vector<std::vector<std::string>> rows{};
};

[[nodiscard]] TextTable tuned_table(const GoalProblem& problem, const GoalResult& result);
/// Two rows for each plant: what the loop does, and what it did at the start.
[[nodiscard]] TextTable figure_table(const GoalProblem& problem, const GoalResult& result);
[[nodiscard]] TextTable limit_table(const GoalProblem& problem, const GoalResult& result);

/// What else is to be said: of the start, of the starts, of what the effort limits.
[[nodiscard]] std::vector<std::string> goal_remarks(const GoalProblem& problem, const GoalResult& result);

/// Columns under their heads.
[[nodiscard]] std::string as_text(const TextTable& table);

}  // namespace hysteron::tool
