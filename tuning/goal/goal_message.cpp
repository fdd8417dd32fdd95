#include "tuning/goal/goal_message.hpp"

#include <fmt/format.h>

namespace hysteron {

std::string length_of_test(const GoalProblem& problem) {
  return fmt::format("{:.4g} s", static_cast<double>(problem.drive.steps - problem.begin) * problem.drive.sample_time);
}

std::string message_of(const GoalProblem& problem, const GoalResult& result) {
  const std::string held = result.is_held_by_test
                               ? fmt::format(" Beside it the loop {}, {}: let the test last longer.",
                                             what_it_does(LoopState::TooSlow), length_of_test(problem))
                               : "";
  switch (result.status) {
    case GoalStatus::Tuned:
      return (problem.limits.empty() ? "The loop is tuned." : "The loop is tuned, and all limits are kept.") + held;
    case GoalStatus::NotConverged:
      return fmt::format("The search ended before it converged; the best point is kept{}.{}",
                         problem.limits.empty() ? "" : ", and all limits are kept", held);
    case GoalStatus::Contradiction:
      return result.is_held_by_test
                 ? "The limits were not kept together by a loop that settles within the test. Of these loops, the "
                   "one that breaks them least is the result." +
                       held
                 : "The limits were not kept together; the point that breaks them least is the result.";
    case GoalStatus::Cancelled:
      return "The search was cancelled; the best point so far is kept.";
  }
  return {};
}

}  // namespace hysteron
