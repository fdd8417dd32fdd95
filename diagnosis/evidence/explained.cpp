#include "diagnosis/evidence/explained.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
#include <utility>

#include "diagnosis/evidence/output_space.hpp"
#include "diagnosis/evidence/placed_laws.hpp"
#include "diagnosis/model/parallel.hpp"
#include "diagnosis/model/refusal.hpp"
#include "diagnosis/model/task.hpp"
#include "diagnosis/policy.hpp"
#include "diagnosis/search/expansion.hpp"
#include "diagnosis/search/stretches.hpp"

namespace hysteron::diagnosis {
namespace {

/// The known parameters as they go with the set, to first order.
VectorXd known_of(const Task& task, const SetFinding& set, const Explanation& calibrated) {
  VectorXd result = calibrated.fit.x.head(std::ssize(task.known));
  for (std::size_t j = 0; j < std::min(task.known.size(), set.known.size()); ++j) {
    result[static_cast<Index>(j)] = std::clamp(set.known[j], task.known[j].lower, task.known[j].upper);
  }
  return result;
}

/// What of the set has to be in the diagram, what closes most first.
std::vector<LawFinding> relevant_laws(const SetFinding& set, Rules& rules) {
  std::vector<LawFinding> result = set.laws;
  std::ranges::stable_sort(result, std::ranges::greater(), &LawFinding::closed);
  std::erase_if(result,
                [&](const LawFinding& law) { return set.laws.size() > 1 && law.closed < rules[policy::relevant]; });
  return result;
}

/// The diagram as the start has it; its frictions give so many times as far. Nothing is fitted.
Explanation begun(const Task& task, const Beginning& start, const Explanation& calibrated, double softer) {
  Explanation result{.variant = start.variant};
  Model model(task, *result.variant.program, result.variant.further);
  VectorXd& x = result.fit.x;
  x = start.x;
  for (const Index j : start.travels) {
    x[j] *= softer;
  }
  x.conservativeResize(model.unknowns());
  x.tail(model.unknowns() - start.x.size()) = calibrated.fit.x.tail(model.unknowns() - start.x.size());
  if (!model.residuals(x, result.fit.residuals)) {
    return {};
  }
  result.fit.cost = cost_of(model, x, result.fit.residuals, nullptr);
  return result;
}

Explanation fitted_from(const Task& task, Explanation one) {
  if (!std::isfinite(one.fit.cost)) {
    return one;
  }
  Model model(task, *one.variant.program, one.variant.further);
  one.fit = fit(model, one.fit.x, {.iterations = 25});
  keep_starts(one, model);
  finish(task, one, {.thoroughly = true});
  return one;
}

/// The best of the fits from there. A friction that lets go within a step has no derivative that would lead a fit:
/// softer ones are tried, too.
Explanation best_from(const Task& task, const std::vector<Beginning>& starts, const Explanation& calibrated,
                      unsigned threads) {
  constexpr std::array softer{1.0, 10.0, 100.0};
  std::vector<std::pair<const Beginning*, double>> tries;
  for (const Beginning& start : starts) {
    for (std::size_t i = 0; i < (start.travels.empty() ? 1 : softer.size()); ++i) {
      tries.emplace_back(&start, softer.at(i));
    }
  }
  std::vector<Explanation> fits(tries.size());
  in_parallel(tries.size(), threads, [&](std::size_t i) {
    fits[i] =
        unless_refused([&] { return fitted_from(task, begun(task, *tries[i].first, calibrated, tries[i].second)); });
  });
  return std::move(*std::ranges::min_element(fits, {}, cost_of_fit));
}

/// The set with one effect more, wherever that one closes most: of those whose costs are as good, within `as_much`, the
/// simplest. Evidence of a plant that was taken out of its loop says nothing of the rest of the loop. A sample too many
/// there outweighs all that the plant lacks, and a fit without it bends the plant to make up for it.
Explanation beside_the_plant(const Task& task, const std::string& top, Explanation begun, const Explanation& calibrated,
                             double as_much, const ExplainOptions& options) {
  constexpr std::size_t fitted = 6;
  if (!std::isfinite(begun.fit.cost)) {
    return {};
  }
  Model model(task, *begun.variant.program, begun.variant.further);
  (void)model.residuals(begun.fit.x, begun.fit.residuals, &begun.fit.jacobian);  // finite before
  const Footing footing{.calibrated = calibrated, .nominal = calibrated};
  const SearchOptions asked{.candidates = {.effects = options.effects, .columns = options.columns},
                            .threads = options.threads};
  Expansion expansion(task, top, footing, options.floor_cost, asked);
  std::vector<Explanation> found = expansion.of(begun, any_effect, fitted);
  if (found.empty()) {
    return {};
  }
  const double as_good = std::ranges::min(found, {}, cost_of_fit).fit.cost + as_much;
  std::erase_if(found, [&](const Explanation& one) { return one.fit.cost > as_good; });
  return std::ranges::min(found, {}, [](const Explanation& one) { return std::pair(one.parameters(), one.fit.cost); });
}

/// With the numbers of a fit to fewer of the effects, where it has them.
Beginning continued(const Beginning& found, const Explanation& fewer, Index known) {
  Beginning result = found;
  const Index fitted = known + fewer.parameters();
  result.x.head(fitted) = fewer.fit.x.head(fitted);
  std::erase_if(result.travels, [&](Index j) { return j < fitted; });
  return result;
}

/// The set with the first of its laws alone.
SetFinding part_of(const SetFinding& set, std::span<const LawFinding> laws) {
  SetFinding result = set;
  if (laws.size() < set.laws.size()) {
    result.laws.assign(laws.begin(), laws.end());
    result.closed = std::accumulate(laws.begin(), laws.end(), 0.0,
                                    [](double sum, const LawFinding& law) { return sum + law.closed; });
  }
  return result;
}

/// The cost of the largest set so far.
double left_by(const std::vector<FittedSet>& runs) {
  if (runs.empty()) {
    return std::numeric_limits<double>::infinity();
  }
  return runs.back().fitted.fit.cost;
}

}  // namespace

Explained explained(const Task& task, const std::string& top, const SetFinding& set, const Explanation& calibrated,
                    const ExplainOptions& options, Rules& rules) {
  const VectorXd known = known_of(task, set, calibrated);
  Beginning found{.variant = calibrated.variant, .x = known};
  std::vector<LawFinding> laws;  // that have a place
  std::vector<Beginning> ways;   // with the first of them, with two, up to all
  bool is_whole = true;          // all laws have a place and their own drivers
  for (const LawFinding& law : relevant_laws(set, rules)) {
    const std::size_t effects = found.variant.effects.size();
    is_whole = add_law(task, top, law, calibrated, options.columns, found) && is_whole;
    if (found.variant.effects.size() > effects) {
      laws.push_back(law);
      ways.push_back(found);
    }
  }
  if (ways.empty()) {
    return {};
  }
  Explained result;
  for (std::size_t i = options.is_open_loop ? ways.size() - 1 : 0; i < ways.size(); ++i) {
    std::vector<Beginning> starts;
    if (!result.runs.empty()) {
      starts.push_back(continued(ways[i], result.runs.back().fitted, known.size()));
    }
    if (result.runs.empty() || i + 1 == ways.size()) {
      starts.push_back(ways[i]);
      if (!options.is_open_loop) {  // there the loop hides which one is nearer
        starts.push_back(ways[i]);
        starts.back().x.head(known.size()) = calibrated.fit.x.head(known.size());
      }
    }
    Explanation best = best_from(task, starts, calibrated, options.threads);
    // With one law more and yet farther: that fit has lost its way.
    if (best.fit.cost < left_by(result.runs)) {
      result.runs.push_back({.set = part_of(set, std::span(laws).first(i + 1)), .fitted = std::move(best)});
    }
  }
  const double relevant = rules[policy::relevant] * (calibrated.fit.cost - options.floor_cost);
  const double left = left_by(result.runs);
  if (options.is_open_loop && left > relevant) {
    Explanation one = unless_refused([&] {
      return beside_the_plant(task, top, begun(task, found, calibrated, 1.0), calibrated, relevant, options);
    });
    if (left - one.fit.cost > relevant) {
      result.runs = {{.set = set, .fitted = std::move(one)}};
    }
  }
  if (result.runs.empty()) {
    return {};  // no run, no judge
  }
  // Fits over whole records that fall far short of what the stretches promise have lost their way, or they were wrong.
  const double least = result.runs.back().fitted.fit.residuals.squaredNorm();
  const double closed = 1.0 - least / calibrated.fit.residuals.squaredNorm();
  if (rules.is_above(policy::kept_promise, closed / std::max(set.closed, 1e-300))) {
    return result;
  }
  return {.refuted = is_whole && (set.space == OutputSpace::title || !in_stretches(task, calibrated))};
}

}  // namespace hysteron::diagnosis
