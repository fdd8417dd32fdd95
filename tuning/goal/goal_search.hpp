// Tunes a control loop for a goal.
//
// 1. A start whose loop does not settle is left: a point that settles is looked for, spread over the bounds.
// 2. Where a limit is broken, the largest excess over all limits is made as small as can be, until all are kept. Where
//    that ends above 0, the limits cannot be kept together as far as this search sees, and the multipliers say which
//    stand against each other.
// 3. From there the cost of goal_problem.hpp is minimised under the limits. Limits over time and frequency are kept at
//    their local maxima; where these move, the new ones are added and the search goes on (an exchange method, J. W.
//    Blankenship, J. E. Falk, J. Optim. Theory Appl. 19 (1976) 261).
// A point whose loop does not settle has no value, so that the search stays among stable loops. Where it met loops that
// settle too slowly for the test, it goes on with their bound as a constraint (slowness.hpp), along which it slides.
// The best point that was ever seen counts, the start among them.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "tuning/goal/goal_model.hpp"
#include "tuning/ipopt_problem.hpp"

namespace hysteron {

struct GoalProgress {
  int start = 0;
  int iteration = 0;
  double error = 0.0;   ///< √J of the best point
  double excess = 0.0;  ///< its largest; above 0: limits are still broken
};

struct GoalOptions {
  int starts = 1;
  std::function<bool(const GoalProgress&)> progress{};  ///< false ends the search with the best point so far
};

enum class GoalStatus : std::uint8_t {
  Tuned,
  NotConverged,   ///< the limits are kept; the search for the best ended early
  Contradiction,  ///< no loop that settles within the test was found to keep the limits; the least broken is the result
  Cancelled
};

struct PlantResult {
  std::string name{};
  std::optional<LoopFigures> before{};  ///< none where the loop has no value at the start, with this plant or another
  LoopFigures after{};
  LoopResponse response{};
  std::vector<FrequencyPoint> frequencies{};  ///< empty without a cut
};

struct LimitResult {
  std::size_t limit = 0;
  std::size_t plant = 0;
  double value = 0.0;
  bool is_kept = false;
  bool is_active = false;  ///< within a hundredth of the limit
  double against = 0.0;    ///< of a broken one, its share in a contradiction, 0 to 1; 0 where it has none
};

struct GoalResult {
  GoalStatus status = GoalStatus::NotConverged;
  std::string message{};  ///< one sentence
  Eigen::VectorXd x{};
  std::vector<AtBound> at_bound{};
  std::vector<PlantResult> plants{};
  std::vector<LimitResult> limits{};           ///< limit by limit, plant by plant
  LoopState start_state = LoopState::Settles;  ///< of the first plant that does not settle
  std::size_t start_plant = 0;                 ///< that plant
  /// The search ran against loops that settle too slowly for the length of the test: they have no value, and better
  /// ones may be among them.
  bool is_held_by_test = false;
  /// √J reached from each start; not a number where limits stay broken, infinite where no loop settles.
  std::vector<double> start_errors{};
  int best_start = 0;
  int iterations = 0;
  int evaluations = 0;
  double seconds = 0.0;  ///< wall-clock
};

/// Deterministic but for `seconds`.
/// @throws InputError HY531 where nothing comes back of what is put into the loop, HY532 where no point was found at
/// which the loop settles.
[[nodiscard]] GoalResult tune_for_goal(const GoalProblem& problem, const GoalOptions& options = {});

/// The parameter file with the tuned values in it, and what stands at the top of it and beside its values.
[[nodiscard]] parameters::ParameterFile tuned_file(parameters::ParameterFile file, const GoalProblem& problem,
                                                   const GoalResult& result);
[[nodiscard]] std::string tuned_heading(const GoalProblem& problem, const GoalResult& result);
[[nodiscard]] parameters::Remarks tuned_remarks(const GoalProblem& problem);

}  // namespace hysteron
