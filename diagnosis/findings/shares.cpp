#include "diagnosis/findings/shares.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "diagnosis/model/task.hpp"

namespace hysteron::diagnosis {
namespace {

/// ½Σr² of the best set with exactly these identifiers; NaN where none was fitted.
double cost_of_names(const Search& search, std::vector<std::string> names) {
  std::ranges::sort(names);
  if (names.empty()) {
    return search.calibrated.fit.cost;
  }
  for (const Explanation& one : search.explanations) {  // best first
    if (one.names() == names) {
      return one.fit.cost;
    }
  }
  return std::nan("");
}

/// What it costs to leave one effect out of a set, all else as it was fitted.
double cost_without(const Task& task, const Explanation& chosen, const Applied& effect) {
  Model model(task, *chosen.variant.program, chosen.variant.further);
  VectorXd x = chosen.fit.x;
  for (std::size_t j = 0; j < effect.paths.size(); ++j) {
    const std::optional<Index> at = place_in_fit(task, chosen, effect.paths[j]);
    if (at && effect.parameters[j].strength) {
      x[*at] = effect.parameters[j].field.neutral;
    }
  }
  VectorXd residuals;
  (void)model.residuals(x, residuals);
  return std::max(0.0, 0.5 * residuals.squaredNorm() - 0.5 * chosen.fit.residuals.squaredNorm());
}

/// Lines of one disturbance have the same name, and so no sets that would tell them apart: what they close together
/// goes to each by what leaving it out costs.
void share_among_lines(const Task& task, const Explanation& chosen, std::vector<double>& shares) {
  const std::vector<Applied>& effects = chosen.variant.effects;
  std::map<std::string, std::vector<std::size_t>> by_name;
  for (std::size_t i = 0; i < effects.size(); ++i) {
    by_name[effects[i].effect].push_back(i);
  }
  for (const auto& [name, lines] : by_name) {
    if (lines.size() < 2) {
      continue;
    }
    double together = 0.0;
    double costs = 0.0;
    std::vector<double> cost(effects.size(), 0.0);
    for (const std::size_t i : lines) {
      cost[i] = cost_without(task, chosen, effects[i]);
      costs += cost[i];
      together += shares[i];
    }
    for (const std::size_t i : lines) {
      shares[i] = costs > 0.0 ? together * cost[i] / costs : shares[i];
    }
  }
}

}  // namespace

std::vector<double> shares_of(const Findings& findings, const Explanation& chosen) {
  const Search& search = findings.search;
  const std::size_t count = chosen.variant.effects.size();
  std::vector<std::string> names;
  for (const Applied& applied : chosen.variant.effects) {
    names.push_back(applied.effect);
  }
  std::vector<double> shares(count, 0.0);
  std::vector<std::size_t> order(count);
  for (std::size_t i = 0; i < count; ++i) {
    order[i] = i;
  }
  double orders = 0.0;
  do {
    std::vector<std::string> set;
    double before = search.calibrated.fit.cost;
    for (const std::size_t i : order) {
      set.push_back(names[i]);
      const double fitted = set.size() == count ? findings.chosen_cost : cost_of_names(search, set);
      const double after = std::isnan(fitted) ? before : std::min(before, fitted);
      shares[i] += before - after;
      before = after;
    }
    orders += 1.0;
  } while (std::ranges::next_permutation(order).found);
  const double gap = std::max(1e-300, gap_energy(findings));
  double total = 0.0;
  for (double& share : shares) {
    share = std::clamp(share / orders / gap, 0.0, 1.0);
    total += share;
  }
  for (double& share : shares) {
    share /= std::max(1.0, total);  // a smaller set whose fit went further
  }
  share_among_lines(findings.task, chosen, shares);
  return shares;
}

double gap_energy(const Findings& findings) {
  const double calibrated = findings.search.calibrated.fit.cost;
  const double kept = &findings.kept == findings.judgement.chosen ? findings.chosen_cost : findings.kept.fit.cost;
  return std::max(0.0, calibrated - std::min(findings.floor_cost, kept));
}

double add_share(std::vector<EffectFinding>& effects, double gap, EffectFinding more, double energy) {
  const double whole = gap + energy;
  for (EffectFinding& effect : effects) {
    effect.share *= gap / whole;
  }
  more.share = energy / whole;
  effects.push_back(std::move(more));
  return whole;
}

GapSplit split_of(const std::vector<EffectFinding>& effects, const std::vector<Edge>& edges,
                  const std::vector<std::string>& ports) {
  static const std::set<std::string, std::less<>> of_wires{"delay", "clock", "quantization", "glitches"};
  std::set<std::string> wires;
  for (const std::string& port : ports) {
    if (const Edge* const edge = find_edge(edges, port)) {
      wires.insert(edge->name);
    }
  }
  GapSplit split{.open = 1.0};
  for (const EffectFinding& effect : effects) {
    if (effect.around_plant) {
      continue;
    }
    const bool at_port =
        wires.contains(effect.edge) ||
        std::ranges::any_of(effect.same_edges, [&](const std::string& same) { return wires.contains(same); });
    (at_port && of_wires.contains(effect.id) ? split.input_output : split.plant) += effect.share;
    split.open -= effect.share;
  }
  split.open = std::max(0.0, split.open);
  return split;
}

}  // namespace hysteron::diagnosis
