#include "diagnosis/verdict/verdict.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "codegen/trace/block_type.hpp"
#include "diagnosis/verdict/seen_steps.hpp"
#include "tuning/covariance.hpp"

namespace hysteron::diagnosis {
namespace {

/// Edges that the record cannot tell apart.
constexpr double same_within = 3.0;
/// What a set has to gain over calibration beyond its penalties, nats.
constexpr double least_significance = 6.0;
/// What an effect has to gain on data held out, over what chance gives, where the mean of the blocks is no evidence.
constexpr double least_score = 4.0;
/// What a record is worth at least: what another formula of the same physics leaves is slow, but no noise.
constexpr double fewest_samples = 60.0;

/// And at most: the same physics in another discretisation leaves some thousandths of the noise, and so no evidence.
constexpr double most_samples = 2000.0;

/// Nor has a machine quite the formula of a textbook: by so much of what an effect does the two differ, in a line that
/// bends a few times over a record. Sets that differ within that are no nearer to the truth for it.
constexpr double formula_error = 0.03;
constexpr double bends = 8.0;
/// What an effect closes beside another one may be the error of that one's formula up to this share of the whole.
constexpr double may_be_formula = 0.1;

/// Nats that are the proof of an effect which the measured values show by themselves.
constexpr double seen = 100.0;

/// Nats between two ways to write one and the same effect.
constexpr double same_to_the_last = 0.02;

/// What makes one of two equal sets the less likely one: effects inside the diagram, where sensors and drives have
/// theirs at its ports; then values that their blocks keep from one step to the next. A user's own block counts for
/// none.
std::pair<std::ptrdiff_t, std::size_t> unlikely(const Explanation& one) {
  const std::vector<Applied>& effects = one.variant.effects;
  std::size_t remembered = 0;
  for (const Applied& applied : effects) {
    const BlockType* const type = find_block_type(applied.block);
    remembered += type == nullptr ? 0 : type->states.size();
  }
  return {std::ranges::count(effects, false, &Applied::at_port), remembered};
}

class Judge {
 public:
  Judge(const Task& task, const Search& search, double floor_cost)
      : task_(task),
        search_(search),
        floor_cost_(floor_cost),
        shows_steps_(search.calibrated.fit.residuals.size() > 0 && shows_steps(task, search.calibrated)) {}

  Judgement run() {
    Judgement result{.chosen = &search_.calibrated};
    const Explanation& best = search_.explanations.empty() ? search_.calibrated : search_.explanations.front();
    const double tau = correlation_time(best.fit.residuals);
    result.effective_samples =
        std::max(fewest_samples, static_cast<double>(best.fit.residuals.size()) / std::max(1.0, tau));
    samples_ = std::clamp(samples_by_formula(), fewest_samples, std::min(result.effective_samples, most_samples));
    result.weighing_samples = samples_;
    result.chosen = choose();
    result.held_out = unseen(*result.chosen);
    for (const Explanation& one : search_.explanations) {
      result.fitted.push_back({.explanation = &one, .support = support(one) - support(*result.chosen)});
    }
    std::ranges::stable_sort(result.fitted, [](const Weighed& a, const Weighed& b) { return a.support > b.support; });
    if (result.chosen == &search_.calibrated) {
      return result;
    }
    const double reference = support(*result.chosen);
    result.significance = reference - support(search_.calibrated);
    std::map<std::vector<std::string>, Weighed> by_names;
    for (const Explanation& one : search_.explanations) {
      const double here = support(one) - reference;
      if (one.names() == result.chosen->names() && &one != result.chosen && here > -same_within) {
        result.same.push_back({.explanation = &one, .support = here});
      }
      if (here > -rival_within && worth_its_size(one)) {
        const auto [found, first] = by_names.emplace(one.names(), Weighed{.explanation = &one, .support = here});
        if (!first && here > found->second.support) {
          found->second = {.explanation = &one, .support = here};
        }
      }
    }
    for (const Explanation& one : search_.explanations) {
      if (may_be_whole(one, *result.chosen)) {
        by_names.emplace(one.names(), Weighed{.explanation = &one, .support = support(one) - reference});
      }
    }
    by_names[result.chosen->names()] = {.explanation = result.chosen, .support = 0.0};
    for (const auto& [names, weighed] : by_names) {
      result.rivals.push_back(weighed);
    }
    std::ranges::stable_sort(result.rivals, [&](const Weighed& a, const Weighed& b) {
      return (a.explanation == result.chosen) != (b.explanation == result.chosen) ? a.explanation == result.chosen
                                                                                  : a.support > b.support;
    });
    return result;
  }

 private:
  /// Whether it has no quantiser where the record shows steps.
  [[nodiscard]] bool denies_steps(const Explanation& one) const {
    return shows_steps_ &&
           std::ranges::find(one.variant.effects, "quantization", &Applied::effect) == one.variant.effects.end();
  }

  [[nodiscard]] double support(const Explanation& one) const {
    return support_of(one.fit.cost, one.parameters(), one.variant.effects.size(), samples_, search_.tried) -
           (denies_steps(one) ? seen : 0.0);
  }

  /// As many as tell two formulas apart that are equally near to the machine.
  [[nodiscard]] double samples_by_formula() const {
    const double gap = search_.calibrated.fit.cost - floor_cost_;
    return gap > 0.0 ? bends / (formula_error * formula_error) * floor_cost_ / gap : most_samples;
  }

  /// Whether a set without one of the chosen effects may be all there is: what that one closes is little beside what
  /// the others do, and may be what their formulas miss.
  [[nodiscard]] bool may_be_whole(const Explanation& one, const Explanation& chosen) const {
    const std::vector<std::string> names = one.names();
    const std::vector<std::string> all = chosen.names();
    return !names.empty() && names.size() + 1 == all.size() && std::ranges::includes(all, names) &&
           one.fit.cost - chosen.fit.cost < may_be_formula * (search_.calibrated.fit.cost - chosen.fit.cost);
  }

  /// Whether each effect of a set closes enough beyond the best set with one effect fewer.
  [[nodiscard]] bool worth_its_size(const Explanation& one) const {
    const std::size_t size = one.variant.effects.size();
    double smaller = search_.calibrated.fit.cost;
    for (const Explanation& other : search_.explanations) {
      if (other.variant.effects.size() + 1 == size) {
        smaller = std::min(smaller, other.fit.cost);
      }
    }
    return smaller - one.fit.cost > least_gain(search_.calibrated.fit.cost, floor_cost_, size);
  }

  /// Each set is refitted to halves of the record once.
  const VectorXd& unseen(const Explanation& one) {
    const auto [found, first] = unseen_.try_emplace(&one);
    if (first) {
      found->second = held_out(task_, one);
    }
    return found->second;
  }

  /// On data that it was not fitted to: in the mean of the blocks, or by more than chance gives.
  [[nodiscard]] bool holds_on_unseen(const Explanation& simple, const Explanation& rich) {
    const VectorXd& before = unseen(simple);
    const VectorXd& after = unseen(rich);
    const std::vector<HeldOut> blocks_before = by_blocks(task_, before);
    const std::vector<HeldOut> blocks_after = by_blocks(task_, after);
    const Index rows = before.size() / std::ssize(task_.outputs);
    for (std::size_t output = 0; output < task_.outputs.size(); ++output) {
      const Index first = static_cast<Index>(output) * rows;
      if (gain_bound(blocks_before[output], blocks_after[output]) > 0.0 ||
          gain_score(before.segment(first, rows), after.segment(first, rows)) > least_score) {
        return true;
      }
    }
    return false;
  }

  /// The best set that deserves its size, from none upwards.
  [[nodiscard]] const Explanation* choose() {
    const Explanation* chosen = &search_.calibrated;
    for (std::size_t size = 1; size <= 4; ++size) {
      const Explanation* best = nullptr;
      for (const Explanation& one : search_.explanations) {
        if (one.variant.effects.size() == size && (best == nullptr || support(one) > support(*best))) {
          best = &one;
        }
      }
      if (best == nullptr) {
        break;
      }
      best = own_near(*simplest_near(*best));
      // Two of three effects may gain nothing without the third: each that a set has more than the one that stands so
      // far has to gain its part.
      const auto more = static_cast<double>(size - chosen->variant.effects.size());
      const bool better = support(*best) - support(*chosen) > more * least_significance;
      const bool notable =
          chosen->fit.cost - best->fit.cost > more * least_gain(search_.calibrated.fit.cost, floor_cost_, size);
      const bool has_its_steps = denies_steps(*chosen) && !denies_steps(*best);
      if (better && notable && (has_its_steps || holds_on_unseen(*chosen, *best))) {
        chosen = best;
      }
    }
    return chosen;
  }

  /// Of the sets of one size that the record does not rule out against the best, the one with the fewest parameters: a
  /// friction with a falling part that is 0 is a friction without. Of two that are the same to the last digits, a
  /// constant before an integrator and a ramp of the clock behind it, the likelier one.
  [[nodiscard]] const Explanation* simplest_near(const Explanation& best) const {
    const Explanation* simplest = &best;
    for (const Explanation& one : search_.explanations) {
      if (one.variant.effects.size() != best.variant.effects.size()) {
        continue;
      }
      const bool fewer =
          one.parameters() < simplest->parameters() && support(one) > support(best) - 0.75 * rival_within;
      const bool same =
          one.parameters() == simplest->parameters() && std::abs(support(one) - support(*simplest)) < same_to_the_last;
      if (fewer || (same && unlikely(one) < unlikely(*simplest))) {
        simplest = &one;
      }
    }
    return simplest;
  }

  /// Parameters of blocks that the diagram has go before effects that are added to it, where these close no more than
  /// would have to be named beside them: noise of a logged input that makes a branching detector chatter is quieted by
  /// a quantiser in front of it too, and by its dead band with an extreme that the noise has shifted.
  [[nodiscard]] const Explanation* own_near(const Explanation& best) const {
    const auto own = [](const Explanation& one) {
      return std::ranges::count(one.variant.effects, true, &Applied::is_own);
    };
    const std::size_t size = best.variant.effects.size();
    const double unnamed = least_gain(search_.calibrated.fit.cost, floor_cost_, 2);
    const Explanation* nearest = &best;
    for (const Explanation& one : search_.explanations) {
      if (one.variant.effects.size() == size && own(one) > own(*nearest) && one.fit.cost < best.fit.cost + unnamed) {
        nearest = &one;
      }
    }
    return nearest;
  }

  const Task& task_;
  const Search& search_;
  double floor_cost_;
  bool shows_steps_;
  double samples_ = 1.0;
  std::map<const Explanation*, VectorXd> unseen_{};
};

}  // namespace

void choose_instead(const Task& task, const Explanation& one, Judgement& judgement) {
  judgement.chosen = &one;
  judgement.held_out = held_out(task, one);
  judgement.same.clear();
  judgement.rivals = {{.explanation = &one, .support = 0.0}};
}

std::vector<double> probabilities(std::span<const Weighed> rivals) {
  std::vector<double> result;
  double total = 0.0;
  for (const Weighed& one : rivals) {
    result.push_back(one.weight());
    total += result.back();
  }
  for (double& probability : result) {
    probability /= total;
  }
  return result;
}

double probability_of_cause(const Judgement& judgement) {
  const auto alike = [](const Applied& a, const Applied& b) {
    return a.effect == b.effect || a.holds(b) || b.holds(a);
  };
  const std::vector<Applied>& chosen = judgement.chosen->variant.effects;
  const std::vector<double> probability = probabilities(judgement.rivals);
  double sum = judgement.rivals.empty() ? 1.0 : 0.0;
  for (std::size_t i = 0; i < probability.size(); ++i) {
    const std::vector<Applied>& rival = judgement.rivals[i].explanation->variant.effects;
    const bool same = rival.size() == chosen.size() && std::ranges::all_of(chosen, [&](const Applied& one) {
                        return std::ranges::any_of(rival, [&](const Applied& other) { return alike(one, other); });
                      });
    sum += same ? probability[i] : 0.0;
  }
  return sum;
}

double support_of(double cost, Index parameters, std::size_t effects, double samples, std::size_t tried) {
  const double penalty = 0.5 * static_cast<double>(parameters) * std::log(std::max(2.0, samples)) +
                         static_cast<double>(effects) * std::log(static_cast<double>(std::max<std::size_t>(2, tried)));
  return -0.5 * samples * std::log(std::max(cost, 1e-300)) - penalty;
}

Judgement judge(const Task& task, const Search& search, double floor_cost) {
  return Judge(task, search, floor_cost).run();
}

}  // namespace hysteron::diagnosis
