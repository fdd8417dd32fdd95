#include "diagnosis/verdict/run_votes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <random>
#include <set>

#include "codegen/graph/definition.hpp"
#include "diagnosis/policy.hpp"
#include "diagnosis/verdict/held_out.hpp"

namespace hysteron::diagnosis {

std::vector<double> votes_of_runs(const Task& task, std::span<const RunSet> sets, std::uint64_t seed,
                                  const Prior& prior, const Rules& rules) {
  std::mt19937_64 random(seed);
  std::exponential_distribution<double> weight(1.0);
  std::normal_distribution<double> error(0.0, 1.0);
  std::vector<std::vector<HeldOut>> energies;
  for (const RunSet& one : sets) {
    energies.push_back(by_blocks(task, one.residuals));
  }
  std::vector<double> votes(sets.size(), 0.0);
  double sum = 0.0;
  for (int draw = 0; draw < static_cast<int>(policy::draws.value) && !sets.empty(); ++draw) {
    std::vector<double> weights(energies.front().front().squares.size());
    std::ranges::generate(weights, [&] { return weight(random); });
    std::map<std::vector<std::string>, double> errors;  // of a formula: the same for all sets of the same families
    std::size_t best = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < sets.size(); ++i) {
      const auto [found, first] = errors.emplace(sets[i].families, 0.0);
      if (first) {
        found->second = rules[policy::model_error] * error(random);
      }
      double left = found->second + rules[policy::price] * static_cast<double>(sets[i].effects);
      for (const HeldOut& output : energies[i]) {
        double squares = 0.0;
        double counts = 0.0;
        for (std::size_t block = 0; block < weights.size(); ++block) {
          squares += weights[block] * output.squares[block];
          counts += weights[block] * output.counts[block];
        }
        left +=
            std::log(std::max(squares / std::max(counts, 1e-300), 1e-300)) / static_cast<double>(energies[i].size());
      }
      if (left < least) {
        least = left;
        best = i;
      }
    }
    const double counts = prior.weight_of_set(sets[best].families);
    votes[best] += counts;
    sum += counts;
  }
  for (double& one : votes) {
    one /= sum;
  }
  return votes;
}

std::vector<EffectKind> kinds_in(const Variant& variant) {
  Diagnostics none;  // the text compiled before
  const auto source = std::make_shared<const language::SourceFile>(language::parse("text", variant.text, none));
  return effect_kinds(define(source, none));
}

std::string family_of(const std::vector<EffectKind>& kinds, const Applied& effect) {
  const auto kind = std::ranges::find(kinds, effect.effect, &EffectKind::id);
  return kind == kinds.end() ? effect.effect : kind->family;
}

std::vector<std::string> families_of(const Variant& variant) {
  const std::vector<EffectKind> kinds = kinds_in(variant);
  std::set<std::string> families;
  for (const Applied& one : variant.effects) {
    families.insert(family_of(kinds, one));
  }
  return {families.begin(), families.end()};
}

}  // namespace hysteron::diagnosis
