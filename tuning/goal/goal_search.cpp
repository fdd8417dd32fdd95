#include "tuning/goal/goal_search.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <tuple>
#include <utility>

#include "support/errors.hpp"
#include "support/numbers.hpp"
#include "tuning/goal/constrained.hpp"
#include "tuning/goal/goal_message.hpp"
#include "tuning/goal/slowness.hpp"
#include "tuning/spread_start.hpp"

namespace hysteron {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// By what share of itself a limit is kept more than it asks for, so that what the exchange leaves does not break it.
constexpr double kept_by = 1e-4;
/// From which excess on a place counts from the beginning.
constexpr double near_limit = -0.3;
constexpr int most_exchanges = 12;
/// Of the excess, by which a further round has to make it smaller.
constexpr double least_gain = 1e-3;
constexpr int most_spread_points = 200;
constexpr double least_share = 0.01;  // of a contradiction
constexpr double is_active = 0.01;
/// Of its typical size: how near to its bound an interior point leaves a parameter that belongs there.
constexpr double near_bound = 1e-2;
constexpr double beside_bound = 1e-4;
constexpr double hardly_worse = 1e-3;  ///< as a share of the cost, or of the excess of a broken limit
constexpr double beside_slow = 0.02;   ///< as a share of the parameters: so near to loops that are too slow
constexpr double on_slow = 1e-4;       ///< nearer than this, the direction from the result to such a loop says nothing

struct Candidate {
  VectorXd x{};
  double cost = infinity;
  double excess = infinity;
  /// Kept limits first, then the cost; among broken ones the excess.
  [[nodiscard]] bool is_better_than(const Candidate& other) const {
    const bool kept = excess <= 0.0;
    const bool other_kept = other.excess <= 0.0;
    return kept != other_kept ? kept : kept ? cost < other.cost : excess < other.excess;
  }
};

class GoalSearch {
 public:
  GoalSearch(const GoalProblem& problem, const GoalOptions& options)
      : problem_(problem), options_(options), model_(problem) {
    const auto n = std::ssize(problem.parameters);
    for (VectorXd* vector : {&start_, &lower_, &upper_, &typical_}) {
      vector->resize(n);
    }
    for (Index j = 0; j < n; ++j) {
      const FreeParameter& free = problem.parameters[static_cast<std::size_t>(j)];
      std::tie(start_[j], lower_[j], upper_[j], typical_[j]) =
          std::tie(free.start, free.lower, free.upper, free.typical);
    }
  }

  GoalResult run() {
    const auto begun = std::chrono::steady_clock::now();
    result_.start_state = model_.evaluate(start_, false);
    result_.start_plant = model_.failed_plant();
    if (result_.start_state == LoopState::Settles) {
      if (const auto open = open_plant()) {
        refuse_open_loop(*open);
      }
      for (std::size_t plant = 0; plant < problem_.plants.size(); ++plant) {
        before_.emplace_back(model_.figures(plant));
      }
    } else {
      before_.resize(problem_.plants.size());
    }
    Candidate best;
    GoalStatus status = GoalStatus::NotConverged;
    for (int start = 0; start < std::max(1, options_.starts) && !cancelled_; ++start) {
      start_number_ = start;
      const auto from = settling_start(start);
      if (!from) {
        result_.start_errors.push_back(infinity);
        continue;
      }
      const GoalStatus ended = search_from(*from);
      result_.start_errors.push_back(best_.excess <= 0.0 ? std::sqrt(best_.cost) : not_a_number);
      if (best.x.size() == 0 || best_.is_better_than(best)) {
        best = best_;
        status = ended;
        shares_ = std::exchange(new_shares_, {});
        result_.best_start = start;
      }
    }
    if (best.x.size() == 0) {
      refuse_starts();
    }
    to_bounds(best);
    finish(best, cancelled_ ? GoalStatus::Cancelled : status);
    result_.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
    return std::move(result_);
  }

 private:
  // ---- starts -----------------------------------------------------------------------------------------------------

  [[nodiscard]] VectorXd spread(int point) const { return spread_start(point, start_, lower_, upper_, typical_); }

  /// The first plant whose loop is open at the last point: what is put in there is all that is ever seen of it.
  [[nodiscard]] std::optional<std::size_t> open_plant() const {
    for (std::size_t plant = 0; plant < problem_.plants.size(); ++plant) {
      const Signal& impulse = model_.response(plant).impulse;
      const bool comes_back =
          std::any_of(impulse.begin() + (impulse.empty() ? 0 : 1), impulse.end(), [](double h) { return h != 0.0; });
      if (!impulse.empty() && !comes_back) {
        return plant;
      }
    }
    return std::nullopt;
  }

  [[noreturn]] void refuse_open_loop(std::size_t plant) const {
    const auto& loop = *problem_.settings.loop;
    throw InputError(error::no_loop_there, loop.place,
                     fmt::format("What is put in at {} never comes back there: no loop passes it{}.", loop.text,
                                 problem_.with_plant(plant)),
                     "name a signal inside the loop. Where the controller stands at its bound when the test ends, "
                     "the loop is open: ask for a smaller step.");
  }

  /// The start, or where its loop does not settle, the best of a few points that do; none where none was found.
  std::optional<VectorXd> settling_start(int start) {
    const VectorXd own = spread(start);
    const LoopState of_own = model_.evaluate(own, false);
    if (of_own == LoopState::Settles && !open_plant()) {
      return own;
    }
    too_slow_ = too_slow_ || of_own == LoopState::TooSlow;
    constexpr int enough = 8;
    Candidate best;
    int found = 0;
    for (int point = 1; point <= most_spread_points && found < enough; ++point) {
      const VectorXd x = spread(point + start * most_spread_points);
      const LoopState state = model_.evaluate(x, false);
      ++points_tried_;
      too_slow_ = too_slow_ || state == LoopState::TooSlow;
      if (state != LoopState::Settles) {
        continue;
      }
      if (const auto open = open_plant()) {
        open_seen_ = open_seen_ ? open_seen_ : open;
        continue;
      }
      ++found;
      const Candidate candidate{x, model_.cost(), model_.largest_excess()};
      best = candidate.is_better_than(best) ? candidate : best;
    }
    return found > 0 ? std::optional(best.x) : std::nullopt;
  }

  /// Says why nothing was found to begin with.
  [[noreturn]] void refuse_starts() const {
    if (open_seen_) {
      refuse_open_loop(*open_seen_);
    }
    throw InputError(
        error::no_stable_loop, problem_.settings.place,
        fmt::format("The loop {} at the start{}, and at none of {} points spread over the bounds does it settle{}.",
                    what_it_does(result_.start_state), problem_.with_plant(result_.start_plant), points_tried_,
                    problem_.plants.size() == 1 ? "" : " with every plant"),
        too_slow_ ? fmt::format("let the test last longer than its {}: duration in [goal], or a longer record. Some of "
                                "these loops settle, only more slowly.",
                                length_of_test(problem_))
                  : "start from a controller with which the loop is stable, most often with a smaller gain, or narrow "
                    "the bounds around one.");
  }

  // ---- search -----------------------------------------------------------------------------------------------------

  GoalStatus search_from(const VectorXd& from) {
    best_ = {};
    places_.clear();
    (void)take(from, false);
    add_places(near_limit);
    if (best_.excess > 0.0) {
      is_feasibility_ = true;
      (void)descend_along_slow(from);
      if (best_.excess > 0.0) {
        return GoalStatus::Contradiction;
      }
    }
    is_feasibility_ = false;
    const FitStatus ended = descend_along_slow(VectorXd(best_.x));
    return ended == FitStatus::Converged || ended == FitStatus::NearlyConverged ? GoalStatus::Tuned
                                                                                : GoalStatus::NotConverged;
  }

  /// Evaluates a point, and remembers it where it is the best so far.
  bool take(const VectorXd& x, bool with_derivatives) {
    ++result_.evaluations;
    if (const LoopState state = model_.evaluate(x, with_derivatives); state != LoopState::Settles) {
      if (state == LoopState::TooSlow) {
        slow_points_.push_back(x);
      }
      return false;
    }
    const Candidate here{x, model_.cost(), model_.largest_excess()};
    if (here.is_better_than(best_)) {
      best_ = here;
    }
    return std::isfinite(here.cost);
  }

  /// The places of all limits, at the last point, that are not among those known; whether there were any.
  bool add_places(double least) {
    bool any = false;
    for (std::size_t limit = 0; limit < problem_.limits.size(); ++limit) {
      for (std::size_t plant = 0; plant < problem_.plants.size(); ++plant) {
        for (const LimitPlace& place : model_.places(limit, plant, least)) {
          const bool known = std::ranges::any_of(places_, [&](const LimitPlace& one) {
            return one.limit == limit && one.plant == plant && one.step == place.step && one.sign == place.sign &&
                   std::fabs(one.frequency - place.frequency) <= 1e-6 * place.frequency;
          });
          if (!known) {
            places_.push_back(place);
            any = true;
          }
        }
      }
    }
    return any;
  }

  /// A search ends before loops that are too slow. It goes on with their bound as one that it knows, along which it can
  /// slide.
  FitStatus descend_along_slow(const VectorXd& from) {
    FitStatus ended = descend(from);
    const bool is_done = is_feasibility_ && best_.excess <= 0.0;
    if (!is_done && !cancelled_ && is_held_by_test(best_)) {
      keeps_settling_ = true;
      ended = descend(VectorXd(best_.x));
      keeps_settling_ = false;
    }
    return ended;
  }

  /// Rounds of Ipopt, each with the places that the one before has brought up.
  FitStatus descend(VectorXd x) {
    for (int round = 0; round < most_exchanges && !cancelled_; ++round) {
      const double excess_before = best_.excess;
      const ConstrainedResult ended = solve_once(x, round > 0);
      x = ended.x.head(start_.size());
      if (is_feasibility_ && best_.excess <= 0.0) {
        return FitStatus::Converged;
      }
      if (!take(x, false)) {
        return FitStatus::Stalled;
      }
      const bool stands_still = is_feasibility_ && round > 0 && best_.excess > (1.0 - least_gain) * excess_before;
      if (!add_places(-0.5 * kept_by) || stands_still) {
        return ended.status;
      }
    }
    return cancelled_ ? FitStatus::Cancelled : FitStatus::IterationLimit;  // limits still move from place to place
  }

  [[nodiscard]] bool has_bound_on_cost() const {
    return !is_feasibility_ && problem_.plants.size() > 1 &&
           problem_.settings.robust == parameters::GoalSettings::Robust::Worst;
  }

  /// One run of Ipopt. A largest value is minimised as a further unknown that bounds all (the epigraph).
  ConstrainedResult solve_once(const VectorXd& x, bool is_near) {
    (void)take(x, false);
    const Index n = x.size();
    const bool bounded = is_feasibility_ || has_bound_on_cost();
    const auto costs = has_bound_on_cost() ? std::ssize(problem_.plants) : Index{0};
    cost_unit_ = std::max(model_.cost(), 1e-300);
    ConstrainedProblem problem;
    const Index settling = keeps_settling_ ? std::ssize(problem_.plants) : 0;
    problem.constraint_count = costs + std::ssize(places_) + settling;
    problem.start = extended(x, bounded, is_feasibility_ ? model_.largest_excess() : 1.0);
    problem.lower = extended(lower_, bounded, -infinity);
    problem.upper = extended(upper_, bounded, infinity);
    // A point that was looked for far away from the start is of another size.
    const VectorXd typical = typical_.cwiseMax(x.cwiseAbs());
    problem.typical = extended(typical, bounded, is_feasibility_ ? std::max(model_.largest_excess(), 0.1) : 1.0);
    problem.evaluate = [&](const VectorXd& at, ConstrainedPoint& point) {
      if (!take(at.head(n), true)) {
        return false;
      }
      point.gradient.setZero();
      point.jacobian.setZero();
      if (bounded) {
        point.cost = at[n];
        point.gradient[n] = 1.0;
      } else {
        point.cost = model_.cost() / cost_unit_;
        for (std::size_t plant = 0; plant < problem_.plants.size(); ++plant) {
          point.gradient += model_.cost_by(plant) / (cost_unit_ * static_cast<double>(problem_.plants.size()));
        }
      }
      for (Index plant = 0; plant < costs; ++plant) {
        point.constraints[plant] = model_.cost(static_cast<std::size_t>(plant)) / cost_unit_ - at[n];
        point.jacobian.row(plant).head(n) = model_.cost_by(static_cast<std::size_t>(plant)) / cost_unit_;
        point.jacobian(plant, n) = -1.0;
      }
      for (Index i = 0; i < std::ssize(places_); ++i) {
        const Margin excess = model_.excess(places_[static_cast<std::size_t>(i)]);
        point.constraints[costs + i] = excess.value + kept_by - (is_feasibility_ ? at[n] : 0.0);
        point.jacobian.row(costs + i).head(n) = excess.by;
        if (is_feasibility_) {
          point.jacobian(costs + i, n) = -1.0;
        }
      }
      for (Index plant = 0; plant < settling; ++plant) {
        const Margin slow = slowness(model_.response(static_cast<std::size_t>(plant)), steps_watched(problem_.drive));
        point.constraints[costs + std::ssize(places_) + plant] = slow.value;
        point.jacobian.row(costs + std::ssize(places_) + plant).head(n) = slow.by;
      }
      return true;
    };
    // What cannot be reached shows early; a search for it only creeps.
    ConstrainedOptions options{.max_iterations = is_feasibility_ ? 60 : 150, .barrier = is_near ? 1e-4 : 1e-1};
    const int before = result_.iterations;
    options.progress = [&](int iteration) {
      result_.iterations = before + iteration;
      cancelled_ = options_.progress && !options_.progress({.start = start_number_,
                                                            .iteration = result_.iterations,
                                                            .error = std::sqrt(best_.cost),
                                                            .excess = best_.excess});
      return !cancelled_ && !(is_feasibility_ && best_.excess <= 0.0);
    };
    ConstrainedResult ended = solve(problem, options);
    if (is_feasibility_) {
      keep_shares(ended.multipliers);
    }
    return ended;
  }

  static VectorXd extended(const VectorXd& vector, bool by_one, double value) {
    VectorXd result(vector.size() + (by_one ? 1 : 0));
    result.head(vector.size()) = vector;
    if (by_one) {
      result[vector.size()] = value;
    }
    return result;
  }

  /// The multipliers of the smallest largest excess sum to 1: each limit's share in that it is not smaller.
  void keep_shares(const VectorXd& multipliers) {
    new_shares_.assign(problem_.limits.size() * problem_.plants.size(), 0.0);
    const double sum = multipliers.head(std::ssize(places_)).cwiseMax(0.0).sum();
    for (std::size_t i = 0; i < places_.size() && sum > 0.0; ++i) {
      new_shares_[places_[i].limit * problem_.plants.size() + places_[i].plant] +=
          std::max(multipliers[static_cast<Index>(i)], 0.0) / sum;
    }
  }

  // ---- result -----------------------------------------------------------------------------------------------------

  /// An interior point ends beside the bound that it runs into. The bound itself is the result where it is no worse,
  /// and hardly worse where the point is all but on it.
  void to_bounds(Candidate& best) {
    for (Index j = 0; j < best.x.size(); ++j) {
      for (const double bound : {lower_[j], upper_[j]}) {
        const double distance = std::fabs(best.x[j] - bound);
        if (distance == 0.0 || !(distance <= near_bound * typical_[j])) {
          continue;
        }
        VectorXd x = best.x;
        x[j] = bound;
        ++result_.evaluations;
        if (model_.evaluate(x, false) != LoopState::Settles) {
          continue;
        }
        const Candidate there{x, model_.cost(), model_.largest_excess()};
        Candidate wanted = best;
        if (distance <= beside_bound * typical_[j]) {
          wanted.cost *= 1.0 + hardly_worse;
          wanted.excess *= wanted.excess > 0.0 ? 1.0 + hardly_worse : 1.0;
        }
        if (!wanted.is_better_than(there)) {
          best = there;
        }
      }
    }
  }

  /// The largest difference of a parameter, as a share of itself at `best`.
  [[nodiscard]] double distance(const VectorXd& best, const VectorXd& x) const {
    return ((x - best).array().abs() / best.array().abs().max(beside_slow * typical_.array())).maxCoeff();
  }

  /// Whether loops that are too slow lie beside the result, and it gets worse away from them: a bound that nobody gave.
  bool is_held_by_test(const Candidate& best) {
    const auto nearest = std::ranges::min_element(slow_points_, {}, [&](const VectorXd& x) {
      const double share = distance(best.x, x);
      return share < on_slow ? infinity : share;
    });
    if (nearest == slow_points_.end() || distance(best.x, *nearest) < on_slow) {
      return false;
    }
    const VectorXd step = std::min(1.0, beside_slow / distance(best.x, *nearest)) * (*nearest - best.x);
    result_.evaluations += 2;
    if (model_.evaluate(best.x + step, false) != LoopState::TooSlow) {
      return false;
    }
    const VectorXd away = (best.x - step).cwiseMax(lower_).cwiseMin(upper_);
    return model_.evaluate(away, false) != LoopState::Settles ||
           best.is_better_than({away, model_.cost(), model_.largest_excess()});
  }

  void finish(const Candidate& best, GoalStatus status) {
    result_.is_held_by_test = is_held_by_test(best);
    result_.x = best.x;
    result_.status = best.excess > 0.0 && status != GoalStatus::Cancelled ? GoalStatus::Contradiction : status;
    for (Index j = 0; j < best.x.size(); ++j) {
      // A bound on which the loop has no value, or breaks a limit, is held by a point beside it.
      const double near = beside_bound * typical_[j];
      result_.at_bound.push_back(best.x[j] - lower_[j] <= near   ? AtBound::Lower
                                 : upper_[j] - best.x[j] <= near ? AtBound::Upper
                                                                 : AtBound::Free);
    }
    (void)model_.evaluate(best.x, false);
    for (std::size_t plant = 0; plant < problem_.plants.size(); ++plant) {
      PlantResult one{.name = problem_.plants[plant].name,
                      .before = before_[plant],
                      .after = model_.figures(plant),
                      .response = model_.response(plant)};
      if (const Sensitivity* const sensitivity = model_.sensitivity(plant)) {
        one.frequencies = sensitivity->grid();
      }
      result_.plants.push_back(std::move(one));
    }
    for (std::size_t limit = 0; limit < problem_.limits.size(); ++limit) {
      for (std::size_t plant = 0; plant < problem_.plants.size(); ++plant) {
        const double value = model_.value_of(limit, plant);
        const double excess = excess_over(problem_.limits[limit].kind, value, problem_.limits[limit].limit);
        const double share = shares_.empty() || result_.status != GoalStatus::Contradiction
                                 ? 0.0
                                 : shares_[limit * problem_.plants.size() + plant];
        result_.limits.push_back({.limit = limit,
                                  .plant = plant,
                                  .value = value,
                                  .is_kept = excess <= 0.0,
                                  .is_active = std::fabs(excess) <= is_active,
                                  .against = excess > 0.0 && share >= least_share ? share : 0.0});
      }
    }
    result_.message = message_of(problem_, result_);
  }

  const GoalProblem& problem_;
  const GoalOptions& options_;
  GoalModel model_;
  VectorXd start_{};
  VectorXd lower_{};
  VectorXd upper_{};
  VectorXd typical_{};
  std::vector<std::optional<LoopFigures>> before_{};
  std::vector<LimitPlace> places_{};
  bool is_feasibility_ = false;
  bool cancelled_ = false;
  bool keeps_settling_ = false;  ///< the bound of loops that are too slow is a constraint
  int start_number_ = 0;
  int points_tried_ = 0;                    ///< where a start does not settle
  bool too_slow_ = false;                   ///< some loop dies away, but not within the test
  std::vector<VectorXd> slow_points_{};     ///< that the search met, and could not take
  std::optional<std::size_t> open_seen_{};  ///< the plant of the first point whose loop settles and is open
  double cost_unit_ = 1.0;
  Candidate best_{};
  std::vector<double> shares_{};      ///< by limit and plant, of the best start
  std::vector<double> new_shares_{};  ///< of the start at hand
  GoalResult result_{};
};

}  // namespace

GoalResult tune_for_goal(const GoalProblem& problem, const GoalOptions& options) {
  return GoalSearch(problem, options).run();
}

}  // namespace hysteron
