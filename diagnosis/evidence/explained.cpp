#include "diagnosis/evidence/explained.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "diagnosis/effects/starts.hpp"
#include "diagnosis/evidence/output_space.hpp"
#include "diagnosis/model/refusal.hpp"
#include "diagnosis/policy.hpp"
#include "diagnosis/search/stretches.hpp"

namespace hysteron::diagnosis {
namespace {

/// The name of the wire that a driver of a law is, as a candidate has it: of a measured output what computes it.
std::string wire_name(const Graph& graph, const std::string& driver) {
  const Port* const output = find_port(graph.outputs, driver);
  if (output == nullptr || output->wire.from != Wire::From::Node || graph.nodes[output->wire.index].block == nullptr) {
    return driver;
  }
  const Node& node = graph.nodes[output->wire.index];
  return node.path + "." + std::string(node.block->outputs[output->wire.port].name);
}

/// Of candidates the one on the law's edge with its drivers; of a driver that no wire carries, a rate, any.
const Candidate* fitting(const std::vector<Candidate>& list, const Graph& graph, const LawFinding& law) {
  const Candidate* best = nullptr;
  int best_rank = 0;
  for (const Candidate& one : list) {
    const std::string edge = in_the_diagram(one.own().edge, one.variant.effects);
    if (!language::same_name(edge, law.edge)) {
      continue;
    }
    const bool driven = one.own().wires.empty() == law.drivers.empty();
    const bool same = driven && (law.drivers.empty() || language::same_name(one.own().wires.front().second,
                                                                            wire_name(graph, law.drivers.front())));
    const int rank = same ? 2 : driven ? 1 : 0;
    if (rank > best_rank) {
      best_rank = rank;
      best = &one;
    }
  }
  return best;
}

/// Whether the candidate has the law's drivers, each of them.
bool is_driven_alike(const Candidate& one, const Graph& graph, const LawFinding& law) {
  return std::ranges::equal(
      one.own().wires, law.drivers,
      [](const std::string& a, const std::string& b) { return language::same_name(a, b); },
      [](const auto& wire) { return wire.second; },
      [&](const std::string& driver) { return wire_name(graph, driver); });
}

double value_of(const LawFinding& law, const EffectParameter& parameter, double otherwise) {
  const auto found = std::ranges::find(law.values, parameter.name, &LawValue::name);
  return found == law.values.end() ? otherwise : found->value;
}

}  // namespace

Explained explained(const Task& task, const std::string& top, const SetFinding& set, const Explanation& calibrated,
                    const std::vector<std::string>& columns, Rules& rules) {
  Explanation result{.variant = calibrated.variant};
  bool is_whole = true;        // all laws have a place and their own drivers
  std::vector<Index> travels;  // of frictions: how far they give
  VectorXd start = calibrated.fit.x.head(std::ssize(task.known));
  for (std::size_t j = 0; j < std::min(task.known.size(), set.known.size()); ++j) {
    const auto at = static_cast<Index>(j);
    start[at] = std::clamp(start[at] + set.known[j], task.known[j].lower, task.known[j].upper);
  }
  for (const LawFinding& law : set.laws) {
    if (law.closed < rules[policy::relevant] && set.laws.size() > 1) {
      continue;
    }
    CandidateOptions options{.effects = {law.effect}, .columns = columns, .again = true};
    for (std::size_t i = 1; i < law.drivers.size(); ++i) {
      options.loads.push_back(wire_name(calibrated.variant.program->graph, law.drivers[i]));
    }
    const std::vector<Candidate> list = candidates_of(result.variant, top, options);
    const Candidate* const found = fitting(list, calibrated.variant.program->graph, law);
    if (found == nullptr) {
      is_whole = false;
      continue;
    }
    is_whole = is_whole && is_driven_alike(*found, calibrated.variant.program->graph, law);
    Variant variant = found->variant;
    Applied& own = variant.effects.back();
    for (std::size_t j = 0; j < own.parameters.size(); ++j) {
      const EffectParameter& parameter = own.parameters[j];
      const double value =
          value_of(law, parameter, parameter.strength ? parameter.field.neutral : parameter.field.preset);
      if (parameter.role == Role::Reference || !std::isfinite(value)) {
        own.settings.emplace_back(own.paths[j], value);
        continue;
      }
      variant.further.push_back(unknown_of(parameter, own.paths[j], {.values = {value}}));
      start.conservativeResize(start.size() + 1);
      start[start.size() - 1] = value;
      if (parameter.is_travel()) {
        travels.push_back(start.size() - 1);
      }
    }
    std::erase_if(own.settings, [](const auto& setting) { return !std::isfinite(setting.second); });
    result.variant = std::move(variant);
    result.variant.program = compiled(result.variant, top);
  }
  if (result.variant.effects.size() == calibrated.variant.effects.size()) {
    return {};
  }
  // A friction that lets go within a step has no derivative that would lead a fit: softer ones are tried, too.
  Explanation best{};
  for (const double softer : {1.0, 10.0, 100.0}) {
    Explanation one = unless_refused([&] {
      Explanation fitted = result;
      Model model(task, *fitted.variant.program, fitted.variant.further);
      VectorXd from = start;
      for (const Index j : travels) {
        from[j] *= softer;
      }
      from.conservativeResize(model.unknowns());
      from.tail(model.unknowns() - start.size()) = calibrated.fit.x.tail(model.unknowns() - start.size());
      fitted.fit = fit(model, from, {.iterations = 25});
      keep_starts(fitted, model);
      finish(task, fitted, {.thoroughly = true});
      return fitted;
    });
    if (one.fit.cost < best.fit.cost) {
      best = std::move(one);
    }
    if (travels.empty()) {
      break;
    }
  }
  // A fit over whole records that falls far short of what the stretches promise has lost its way, or they were wrong.
  if (!std::isfinite(best.fit.cost)) {
    return {};  // no run, no judge
  }
  const double closed = 1.0 - best.fit.residuals.squaredNorm() / calibrated.fit.residuals.squaredNorm();
  if (rules.is_above(policy::kept_promise, closed / std::max(set.closed, 1e-300))) {
    return {.explanation = std::move(best)};
  }
  return {.refuted = is_whole && (set.space == OutputSpace::title || !in_stretches(task, calibrated))};
}

}  // namespace hysteron::diagnosis
