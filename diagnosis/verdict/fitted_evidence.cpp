#include "diagnosis/verdict/fitted_evidence.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "diagnosis/effects/effects.hpp"
#include "diagnosis/evidence/output_space.hpp"
#include "diagnosis/evidence/roles.hpp"
#include "diagnosis/model/parallel.hpp"
#include "diagnosis/policy.hpp"
#include "diagnosis/verdict/held_out.hpp"

namespace hysteron::diagnosis {
namespace {

/// A fitted set, with what it leaves of blocks that its fits did not see.
struct Contender {
  const Explanation* set = nullptr;
  std::set<std::string> families{};
  std::vector<HeldOut> left{};  ///< by output
  double probability = 0.0;
};

/// ln of the mean square over the outputs, each in its own scale, of blocks with these weights.
double log_square(const Contender& one, const std::vector<double>& weights) {
  double sum = 0.0;
  for (const HeldOut& output : one.left) {
    double squares = 0.0;
    double counts = 0.0;
    for (std::size_t b = 0; b < output.squares.size(); ++b) {
      squares += weights[b] * output.squares[b];
      counts += weights[b] * output.counts[b];
    }
    sum += std::log(std::max(squares, 1e-300) / std::max(counts, 1e-300));
  }
  return sum / static_cast<double>(one.left.size());
}

double log_square(const Contender& one) {
  return log_square(one, std::vector<double>(one.left.front().squares.size(), 1.0));
}

std::map<std::string, EffectKind> kinds_by_effect(const Explanation& calibrated) {
  Diagnostics none;  // the text compiled before
  const auto source =
      std::make_shared<const language::SourceFile>(language::parse("text", calibrated.variant.text, none));
  std::map<std::string, EffectKind> result;
  for (EffectKind& kind : effect_kinds(define(source, none))) {
    result.emplace(kind.id, std::move(kind));
  }
  return result;
}

/// Whether each effect of a set is in a place that makes sense for it, and one of them is no law.
class Sensible {
 public:
  Sensible(const std::map<std::string, EffectKind>& kinds, const std::vector<Space::Place>& places)
      : kinds_(kinds), places_(places) {}

  bool operator()(const Explanation& set) const {
    const std::vector<Applied>& effects = set.variant.effects;
    return std::ranges::all_of(effects, [&](const Applied& one) { return may_be(one, effects); }) &&
           std::ranges::any_of(effects, [&](const Applied& one) { return !is_law(kinds_.at(one.effect)); });
  }

 private:
  [[nodiscard]] bool may_be(const Applied& effect, const std::vector<Applied>& effects) const {
    const std::string edge = in_the_diagram(effect.edge, effects);
    const auto place = std::ranges::find_if(places_, [&](const Space::Place& one) { return one.edge.name == edge; });
    return kinds_.contains(effect.effect) && place != places_.end() && may_act_on(kinds_.at(effect.effect), *place);
  }

  const std::map<std::string, EffectKind>& kinds_;
  const std::vector<Space::Place>& places_;
};

/// The best of each combination of effects that leaves less than a given cost and is sensible.
std::vector<const Explanation*> better_than(const Search& search, double cost, const Sensible& is_sensible) {
  std::vector<const Explanation*> result;
  for (const Explanation& one : search.explanations) {  // best first
    const bool is_known =
        std::ranges::any_of(result, [&](const Explanation* other) { return other->names() == one.names(); });
    if (one.fit.cost < cost && !is_known && is_sensible(one) &&
        result.size() < static_cast<std::size_t>(policy::runs.value)) {
      result.push_back(&one);
    }
  }
  return result;
}

void vote(std::vector<Contender>& contenders, std::uint64_t seed, const Rules& rules) {
  std::mt19937_64 random(seed);
  std::exponential_distribution<double> weight(1.0);
  std::normal_distribution<double> error(0.0, 1.0);
  std::vector<double> weights(contenders.front().left.front().squares.size());
  const auto count = static_cast<int>(policy::draws.value);
  for (int draw = 0; draw < count; ++draw) {
    std::ranges::generate(weights, [&] { return weight(random); });
    std::map<std::set<std::string>, double> errors;  // of a formula: the same for all sets of the same families
    Contender* best = nullptr;
    double least = std::numeric_limits<double>::infinity();
    for (Contender& one : contenders) {
      const auto [found, is_new] = errors.emplace(one.families, 0.0);
      if (is_new) {
        found->second = rules[policy::model_error] * error(random);
      }
      const double left = log_square(one, weights) + found->second +
                          rules[policy::price] * static_cast<double>(one.set->variant.effects.size());
      if (left < least) {
        least = left;
        best = &one;
      }
    }
    best->probability += 1.0 / policy::draws.value;
  }
}

/// ½Σr² of the cheapest fitted set that has none of the effects of these names, out of those of a set.
double cost_without(const Search& search, const Explanation& set, const std::string& name) {
  double least = search.calibrated.fit.cost;
  const std::vector<std::string> names = set.names();
  for (const Explanation& one : search.explanations) {
    const bool is_part = std::ranges::all_of(one.variant.effects, [&](const Applied& effect) {
      return effect.effect != name && std::ranges::find(names, effect.effect) != names.end();
    });
    least = is_part ? std::min(least, one.fit.cost) : least;
  }
  return least;
}

SetFinding described(const Contender& one, const Search& search, double bare,
                     const std::map<std::string, EffectKind>& kinds) {
  SetFinding result{.space = std::string(OutputSpace::title),
                    .probability = one.probability,
                    .closed = std::clamp(1.0 - std::exp(log_square(one) - bare), 0.0, 1.0)};
  double sum = 0.0;
  for (const Applied& effect : one.set->variant.effects) {
    LawFinding law{.effect = effect.effect,
                   .family = kinds.at(effect.effect).family,
                   .edge = in_the_diagram(effect.edge, one.set->variant.effects)};
    for (const auto& [pin, wire] : effect.wires) {
      law.drivers.push_back(wire);
    }
    law.closed = std::max(0.0, cost_without(search, *one.set, effect.effect) - one.set->fit.cost);
    sum += law.closed;
    result.laws.push_back(std::move(law));
  }
  for (LawFinding& law : result.laws) {
    law.closed = sum > 0.0 ? result.closed * law.closed / sum : result.closed / static_cast<double>(result.laws.size());
  }
  return result;
}

std::vector<FamilyFinding> families_of(const std::vector<SetFinding>& sets) {
  std::map<std::string, FamilyFinding> found;
  for (const SetFinding& set : sets) {  // most probable first
    std::set<std::string> own;
    for (const LawFinding& law : set.laws) {
      own.insert(law.family);
    }
    for (const std::string& family : own) {
      const auto law = std::ranges::find(set.laws, family, &LawFinding::family);
      const auto [at, is_new] = found.emplace(family, FamilyFinding{.family = family});
      if (is_new) {
        at->second.effect = law->effect;
        at->second.edge = law->edge;
        at->second.member = set.probability;
        for (const LawFinding& one : set.laws) {
          at->second.closed += one.family == family ? one.closed : 0.0;
        }
        at->second.alone = at->second.closed;
      } else if (law->effect == at->second.effect) {
        at->second.member += set.probability;
      }
      at->second.probability += set.probability;
    }
  }
  std::vector<FamilyFinding> result;
  for (auto& [name, one] : found) {
    one.member = one.probability > 0.0 ? one.member / one.probability : 0.0;
    result.push_back(std::move(one));
  }
  std::ranges::stable_sort(result, std::ranges::greater(),
                           [](const FamilyFinding& one) { return one.probability * one.closed; });
  return result;
}

}  // namespace

std::optional<FittedEvidence> fitted_evidence(const Task& task, const Search& search, const Explanation& of_laws,
                                              const FittedEvidenceOptions& options, const Rules& rules) {
  const bool any_is_better =
      std::ranges::any_of(search.explanations, [&](const Explanation& one) { return one.fit.cost < of_laws.fit.cost; });
  if (!any_is_better) {
    return std::nullopt;  // and no diagram has to be run for its places
  }
  const std::map<std::string, EffectKind> kinds = kinds_by_effect(search.calibrated);
  const OutputSpace outputs(task, options.top, search.calibrated, {}, options.threads);
  const std::vector<const Explanation*> better =
      better_than(search, of_laws.fit.cost, Sensible(kinds, outputs.places()));
  if (better.empty()) {
    return std::nullopt;
  }
  std::vector<Contender> contenders{{.set = &of_laws}};
  for (const Explanation* one : better) {
    contenders.push_back({.set = one});
  }
  in_parallel(contenders.size(), options.threads, [&](std::size_t i) {
    Contender& one = contenders[i];
    for (const Applied& effect : one.set->variant.effects) {
      one.families.insert(kinds.at(effect.effect).family);
    }
    one.left = by_blocks(task, held_out(task, *one.set));
  });
  vote(contenders, options.seed, rules);
  const double of_the_laws = contenders.front().probability;
  const Contender bare{.set = &search.calibrated, .left = by_blocks(task, held_out(task, search.calibrated))};
  std::ranges::stable_sort(contenders, std::ranges::greater(), &Contender::probability);
  if (contenders.front().set == &of_laws || contenders.front().probability <= of_the_laws) {
    return std::nullopt;
  }
  FittedEvidence result;
  for (const Contender& one : contenders) {
    if (one.probability > 0.0) {
      result.evidence.sets.push_back(described(one, search, log_square(bare), kinds));
    }
  }
  result.evidence.families = families_of(result.evidence.sets);
  const std::string& family = result.evidence.families.front().family;
  if (is_law(kinds.at(result.evidence.families.front().effect))) {
    return std::nullopt;
  }
  const auto first =
      std::ranges::find_if(contenders, [&](const Contender& one) { return one.families.contains(family); });
  result.chosen = first->set;
  return result;
}

}  // namespace hysteron::diagnosis
