#include "diagnosis/stages/proposals.hpp"

#include <algorithm>
#include <functional>
#include <limits>
#include <numeric>
#include <optional>
#include <set>
#include <utility>

#include "diagnosis/effects/known_effects.hpp"
#include "diagnosis/findings/control_loop.hpp"

namespace hysteron::diagnosis {
namespace {

/// How many fitted sets of a search are held against what the evidence tells.
constexpr std::size_t most_of_search = 40;

/// What stands for the search: its fitted sets, where one of them was chosen.
std::vector<const Explanation*> searched_sets(const Judged& judged) {
  std::vector<const Explanation*> result;
  if (judged.chosen().variant.effects.empty()) {
    return result;
  }
  result.push_back(&judged.chosen());
  for (const Weighed& one : judged.judgement().fitted) {
    const bool is_fitted = one.explanation->fit.residuals.size() == judged.calibrated().fit.residuals.size();
    if (result.size() < most_of_search && is_fitted && one.explanation != result.front() &&
        !one.explanation->variant.effects.empty()) {
      result.push_back(one.explanation);
    }
  }
  return result;
}

RunSet run_of(const Explanation& one, const VectorXd& residuals, const std::map<std::string, std::string>& family_of) {
  const std::vector<Applied>& effects = one.variant.effects;
  std::set<std::string> families;
  for (const Applied& effect : effects) {
    families.insert(family_of.at(effect.effect));
  }
  return {.residuals = residuals,
          .families = {families.begin(), families.end()},
          .effects = effects.size(),
          .displaced = static_cast<std::size_t>(std::ranges::count(effects, true, &Applied::is_displaced))};
}

/// Of what was told and has no run: what cannot be run is no nearer to the record than the calibrated diagram.
RunSet unrun(const Evidence& told, const RunSet& calibrated) {
  const SetFinding& first = told.sets.front();
  std::set<std::string> families;
  for (const LawFinding& law : first.laws) {
    families.insert(law.family);
  }
  return {
      .residuals = calibrated.residuals, .families = {families.begin(), families.end()}, .effects = first.laws.size()};
}

std::size_t best_between(const std::vector<double>& votes, std::size_t from, std::size_t to) {
  const auto begin = votes.begin();
  return static_cast<std::size_t>(
      std::max_element(begin + static_cast<std::ptrdiff_t>(from), begin + static_cast<std::ptrdiff_t>(to)) - begin);
}

double sum_between(const std::vector<double>& votes, std::size_t from, std::size_t to) {
  const auto begin = votes.begin();
  return std::accumulate(begin + static_cast<std::ptrdiff_t>(from), begin + static_cast<std::ptrdiff_t>(to), 0.0);
}

bool holds(const RunSet& set, const std::string& family) {
  return std::ranges::find(set.families, family) != set.families.end();
}

/// Of the search's votes for a family, those for sets that hold this member of it.
double part_of_family(const Runs& runs, const std::string& family, const std::string& effect) {
  double all = 0.0;
  double own = 0.0;
  for (std::size_t i = 0; i < runs.searched.size(); ++i) {
    if (holds(runs.sets[runs.told() + i], family)) {
      const double votes = runs.votes[runs.told() + i];
      all += votes;
      own += std::ranges::count(runs.searched[i]->variant.effects, effect, &Applied::effect) > 0 ? votes : 0.0;
    }
  }
  return all > 0.0 ? own / all : 0.0;
}

/// The families of a set of the search, each with its part of what the set closes, by what each closes alone.
void add_searched(const Runs& runs, std::size_t set, const Explanation& fitted, Evidence& evidence) {
  const std::vector<std::string>& families = runs.sets[set].families;
  double sum = 0.0;
  for (const std::string& family : families) {
    sum += runs.alone(family);
  }
  for (const std::string& family : families) {
    if (std::ranges::find(evidence.families, family, &FamilyFinding::family) != evidence.families.end()) {
      continue;
    }
    const double alone = runs.alone(family);
    FamilyFinding finding{.family = family, .alone = alone};
    finding.closed = runs.closed[set] * (sum > 0.0 ? alone / sum : 1.0 / static_cast<double>(families.size()));
    for (const Applied& one : fitted.variant.effects) {
      if (runs.family_of.at(one.effect) == family) {
        finding.effect = one.effect;
        finding.edge = in_the_diagram(one.edge, fitted.variant.effects);
        break;
      }
    }
    finding.member = part_of_family(runs, family, finding.effect);
    evidence.families.push_back(std::move(finding));
  }
}

/// The laws of a set by effect and edge, sorted.
std::vector<std::pair<std::string, std::string>> names_of(const SetFinding& set) {
  std::vector<std::pair<std::string, std::string>> result;
  for (const LawFinding& law : set.laws) {
    result.emplace_back(law.effect, law.edge);
  }
  std::ranges::sort(result);
  return result;
}

}  // namespace

double Runs::votes_of(std::size_t view) const {
  return sum_between(votes, begins[view], begins[view + 1]);
}

std::size_t Runs::best_told() const {
  std::size_t best = 0;
  for (std::size_t view = 1; view + 1 < begins.size(); ++view) {
    best = votes_of(view) > votes_of(best) ? view : best;
  }
  return best;
}

std::size_t Runs::best_set_of(std::size_t view) const {
  return best_between(votes, begins[view], begins[view + 1]);
}

std::size_t Runs::best_searched() const {
  return best_between(votes, told(), nothing());
}

bool Runs::are_for_told() const {
  const double of_search = sum_between(votes, told(), nothing());
  return told() > 0 && votes_of(best_told()) >= std::max(of_search, votes[nothing()]);
}

double Runs::alone(const std::string& family) const {
  double result = 0.0;
  for (std::size_t i = 0; i < sets.size(); ++i) {
    if (sets[i].families.size() == 1 && sets[i].families.front() == family) {
      result = std::max(result, closed[i]);
    }
  }
  return result;
}

Runs runs_of(const std::vector<Told>& told, const Judged& judged, const DiagnosisOptions& options, const Rules& rules) {
  const Explanation& calibrated = judged.calibrated();
  Runs result{.searched = searched_sets(judged), .family_of = families_by_effect(*calibrated.variant.program)};
  const RunSet nothing{.residuals = calibrated.fit.residuals};
  for (const Told& one : told) {
    result.begins.push_back(result.sets.size());
    for (const FittedSet& run : one.runs) {
      result.sets.push_back(run_of(run.fitted, run.fitted.fit.residuals, result.family_of));
    }
    if (one.runs.empty()) {
      result.sets.push_back(unrun(one.evidence, nothing));
    }
  }
  result.begins.push_back(result.sets.size());
  for (const Explanation* const one : result.searched) {
    const bool is_chosen = one == result.searched.front();
    result.sets.push_back(run_of(*one, is_chosen ? judged.residuals() : one->fit.residuals, result.family_of));
    result.sets.back().is_own_choice = !told.empty();
  }
  result.sets.push_back(nothing);
  result.votes = votes_of_runs(judged.record.task, result.sets, options.seed, options.prior, rules);
  for (const RunSet& one : result.sets) {
    result.closed.push_back(1.0 - one.residuals.squaredNorm() / nothing.residuals.squaredNorm());
  }
  return result;
}

void weigh_by_loop(const LoopFinding& loop, Runs& runs) {
  double sum = 0.0;
  for (std::size_t i = 0; i < runs.sets.size(); ++i) {
    const bool sticks = std::ranges::any_of(runs.sets[i].families, is_sticking);
    runs.votes[i] *= sticks ? loop.oddness : 1.0 - loop.oddness;
    sum += runs.votes[i];
  }
  for (double& one : runs.votes) {
    one = sum > 0.0 ? one / sum : 0.0;
  }
}

Evidence evidence_of_search(const Runs& runs, const Task& task) {
  Evidence result;
  std::vector<std::size_t> order;
  for (std::size_t i = runs.told(); i < runs.nothing(); ++i) {
    if (runs.votes[i] > 0.0) {
      order.push_back(i);
    }
  }
  std::ranges::stable_sort(order, std::ranges::greater(), [&](std::size_t i) { return runs.votes[i]; });
  for (const std::size_t i : order) {
    const Explanation& fitted = *runs.searched[i - runs.told()];
    add_searched(runs, i, fitted, result);
    SetFinding set{.space = "runs", .probability = runs.votes[i], .closed = runs.closed[i]};
    for (const Applied& one : fitted.variant.effects) {
      LawFinding law{.effect = one.effect,
                     .family = runs.family_of.at(one.effect),
                     .edge = in_the_diagram(one.edge, fitted.variant.effects)};
      for (const auto& [pin, driver] : one.wires) {
        law.drivers.push_back(driver);
      }
      for (std::size_t j = 0; j < one.paths.size(); ++j) {
        if (const std::optional<Index> at = place_in_fit(task, fitted, one.paths[j])) {
          law.values.push_back({.name = one.parameters[j].name,
                                .value = fitted.fit.x[*at],
                                .error = std::numeric_limits<double>::quiet_NaN(),  // of a fit to all blocks
                                .unit = one.parameters[j].unit});
        }
      }
      const auto family = std::ranges::find(result.families, law.family, &FamilyFinding::family);
      law.closed = family == result.families.end() ? 0.0 : family->closed;
      set.laws.push_back(std::move(law));
    }
    result.sets.push_back(std::move(set));
  }
  return result;
}

void weigh_families(const Runs& runs, const std::vector<Told>& told, Evidence& evidence) {
  for (FamilyFinding& family : evidence.families) {
    double probability = 0.0;
    double by_record = 0.0;
    for (std::size_t view = 0; view < told.size(); ++view) {
      const std::vector<FamilyFinding>& there = told[view].evidence.families;
      if (const auto found = std::ranges::find(there, family.family, &FamilyFinding::family); found != there.end()) {
        probability += runs.votes_of(view) * found->probability;
        by_record += runs.votes_of(view) * found->by_record;
      }
    }
    for (std::size_t i = runs.told(); i < runs.sets.size(); ++i) {
      if (holds(runs.sets[i], family.family)) {
        probability += runs.votes[i];
        by_record += runs.votes[i];
      }
    }
    family.probability = probability;
    family.by_record = by_record;
  }
  std::ranges::stable_sort(evidence.families, std::ranges::greater(), weight_of_family);
}

void put_first(const SetFinding& set, std::vector<SetFinding>& sets) {
  const auto found = std::ranges::find(sets, names_of(set), names_of);
  if (found != sets.end()) {
    std::rotate(sets.begin(), found, found + 1);
  } else {
    sets.insert(sets.begin(), set);
  }
}

}  // namespace hysteron::diagnosis
