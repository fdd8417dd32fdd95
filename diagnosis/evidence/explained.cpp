#include "diagnosis/evidence/explained.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "diagnosis/effects/motions.hpp"
#include "diagnosis/effects/starts.hpp"
#include "diagnosis/evidence/output_space.hpp"
#include "diagnosis/model/refusal.hpp"
#include "diagnosis/model/task.hpp"
#include "diagnosis/policy.hpp"
#include "diagnosis/search/expansion.hpp"
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

/// How many wires behind its own block a candidate's first driver is: a velocity that comes about from the force at
/// once is nearer than one that a controller finds from the position.
std::size_t steps_to_driver(const Candidate& one) {
  const Graph& graph = one.variant.program->graph;
  const Node* const own = find_node(graph, one.own().instance);
  if (own == nullptr || one.auxiliary.empty() || one.auxiliary.front().from != Wire::From::Node) {
    return unconnected;
  }
  return steps_behind(graph, {static_cast<std::uint32_t>(own - graph.nodes.data())})[one.auxiliary.front().index];
}

/// Of candidates the one on the law's edge with its drivers; of a driver that no wire carries, a rate, the nearest.
const Candidate* fitting(const std::vector<Candidate>& list, const Graph& graph, const LawFinding& law) {
  const Candidate* best = nullptr;
  std::pair<int, std::size_t> best_rank{0, 0};  // the first as large, then the second as small as can be
  for (const Candidate& one : list) {
    const std::string edge = in_the_diagram(one.own().edge, one.variant.effects);
    if (!language::same_name(edge, law.edge)) {
      continue;
    }
    const bool driven = one.own().wires.empty() == law.drivers.empty();
    const bool same = driven && (law.drivers.empty() || language::same_name(one.own().wires.front().second,
                                                                            wire_name(graph, law.drivers.front())));
    const int rank = same ? 2 : driven ? 1 : 0;
    const std::size_t steps = steps_to_driver(one);
    if (rank > best_rank.first || (rank > 0 && rank == best_rank.first && steps < best_rank.second)) {
      best_rank = {rank, steps};
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

/// Whether a strength has no meaning below 0: what resists a motion does not drive it.
bool is_one_sided(const EffectParameter& parameter) {
  return parameter.strength && parameter.field.neutral == 0.0 && parameter.field.minimum == 0.0;
}

/// Whether a law drives where its block resists. On a force that a motion asks for, in inverse dynamics or in the
/// branch of a sum that is taken away, a friction is one of the other sign: its velocity counts backwards there. Its
/// strengths have units of their own: the one that is surest, by its deviations from 0, tells.
bool is_backwards(const LawFinding& law, const std::vector<EffectParameter>& parameters) {
  const LawValue* surest = nullptr;
  for (const LawValue& one : law.values) {
    const auto parameter = std::ranges::find(parameters, one.name, &EffectParameter::name);
    if (parameter != parameters.end() && is_one_sided(*parameter) &&
        (surest == nullptr || std::abs(one.value) * surest->error > std::abs(surest->value) * one.error)) {
      surest = &one;
    }
  }
  return surest != nullptr && surest->value < 0.0;
}

/// The law's block in the diagram.
struct Placed {
  std::optional<Candidate> candidate{};
  bool is_backwards = false;
  bool is_own_driver = false;  ///< it is driven by what the law was found with
};

/// The law on its edge: with a driver that the search would try there, too, where that one is the same or stands for
/// it; else with the law's own, or the rate of that.
Placed placed(const Variant& variant, const std::string& top, const Graph& graph, const LawFinding& law,
              const std::vector<std::string>& columns) {
  CandidateOptions options{.effects = {law.effect}, .columns = columns, .again = true};
  for (std::size_t i = 1; i < law.drivers.size(); ++i) {
    options.loads.push_back(wire_name(graph, law.drivers[i]));
  }
  const auto found = [&]() -> std::optional<Candidate> {
    const std::vector<Candidate> list = candidates_of(variant, top, options);
    const Candidate* const best = fitting(list, graph, law);
    return best == nullptr ? std::nullopt : std::optional(*best);
  };
  Placed result{.candidate = found()};
  if (law.drivers.empty()) {
    result.is_own_driver = result.candidate && result.candidate->own().wires.empty();
    return result;
  }
  if (result.candidate && !result.candidate->own().wires.empty()) {
    options.driver = {.signal = result.candidate->own().wires.front().second};
    result.is_own_driver = is_driven_alike(*result.candidate, graph, law);
  } else {
    const std::string& driver = law.drivers.front();
    const bool is_rate = driver.ends_with('\'');
    options.driver = {.signal = wire_name(graph, is_rate ? driver.substr(0, driver.size() - 1) : driver),
                      .is_rate = is_rate};
    result.candidate = found();
    result.is_own_driver = result.candidate && law.drivers.size() == result.candidate->own().wires.size();
  }
  if (result.candidate && is_backwards(law, result.candidate->own().parameters)) {
    options.driver->is_backwards = true;
    result.candidate = found();
    result.is_backwards = true;
  }
  return result;
}

/// The set in the diagram, and where its numbers begin.
struct Beginning {
  Variant variant{};
  VectorXd x{};                  ///< of the known parameters and of the effects
  std::vector<Index> travels{};  ///< of frictions: how far they give
  bool is_whole = true;          ///< all laws have a place and their own drivers
};

Beginning start_of(const Task& task, const std::string& top, const SetFinding& set, const Explanation& calibrated,
                   const std::vector<std::string>& columns, Rules& rules) {
  Beginning result{.variant = calibrated.variant, .x = calibrated.fit.x.head(std::ssize(task.known))};
  for (std::size_t j = 0; j < std::min(task.known.size(), set.known.size()); ++j) {
    result.x[static_cast<Index>(j)] = std::clamp(set.known[j], task.known[j].lower, task.known[j].upper);
  }
  for (const LawFinding& law : set.laws) {
    if (law.closed < rules[policy::relevant] && set.laws.size() > 1) {
      continue;
    }
    const Placed there = placed(result.variant, top, calibrated.variant.program->graph, law, columns);
    result.is_whole = result.is_whole && there.is_own_driver;
    if (!there.candidate) {
      continue;
    }
    Variant variant = there.candidate->variant;
    Applied& own = variant.effects.back();
    for (std::size_t j = 0; j < own.parameters.size(); ++j) {
      const EffectParameter& parameter = own.parameters[j];
      double value = value_of(law, parameter, parameter.strength ? parameter.field.neutral : parameter.field.preset);
      if (is_one_sided(parameter)) {
        value = std::max(0.0, there.is_backwards ? -value : value);
      }
      if (parameter.role == Role::Reference || !std::isfinite(value)) {
        own.settings.emplace_back(own.paths[j], value);
        continue;
      }
      Grid grid = bounded(parameter, task.records.front().sample_time(), longest_duration(task));
      grid.values = {value};
      const Unknown& unknown = variant.further.emplace_back(unknown_of(parameter, own.paths[j], grid));
      result.x.conservativeResize(result.x.size() + 1);
      result.x[result.x.size() - 1] = std::clamp(value, unknown.lower, unknown.upper);
      if (parameter.is_travel()) {
        result.travels.push_back(result.x.size() - 1);
      }
    }
    std::erase_if(own.settings, [](const auto& setting) { return !std::isfinite(setting.second); });
    result.variant = std::move(variant);
    result.variant.program = compiled(result.variant, top);
  }
  return result;
}

/// The diagram with the set as the start has it; its frictions give so many times as far. Nothing is fitted.
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

/// With the known parameters that were found with the set or, where a run of the whole diagram is nearer with these,
/// as calibrated: what goes with a set is known to first order.
Beginning nearer(const Task& task, const Beginning& start, const Explanation& calibrated) {
  Beginning other = start;
  other.x.head(std::ssize(task.known)) = calibrated.fit.x.head(std::ssize(task.known));
  const auto cost = [&](const Beginning& one) {
    return unless_refused([&] { return begun(task, one, calibrated, 1.0); }).fit.cost;
  };
  return cost(other) < cost(start) ? other : start;
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

}  // namespace

Explained explained(const Task& task, const std::string& top, const SetFinding& set, const Explanation& calibrated,
                    const ExplainOptions& options, Rules& rules) {
  Beginning start = start_of(task, top, set, calibrated, options.columns, rules);
  if (start.variant.effects.size() == calibrated.variant.effects.size()) {
    return {};
  }
  if (!options.is_open_loop) {  // there the loop hides which one is nearer
    start = nearer(task, start, calibrated);
  }
  // A friction that lets go within a step has no derivative that would lead a fit: softer ones are tried, too.
  Explanation best{};
  for (const double softer : {1.0, 10.0, 100.0}) {
    Explanation one = unless_refused([&] { return fitted_from(task, begun(task, start, calibrated, softer)); });
    if (one.fit.cost < best.fit.cost) {
      best = std::move(one);
    }
    if (start.travels.empty()) {
      break;
    }
  }
  const double relevant = rules[policy::relevant] * (calibrated.fit.cost - options.floor_cost);
  if (options.is_open_loop && best.fit.cost > relevant) {
    Explanation one = unless_refused([&] {
      return beside_the_plant(task, top, begun(task, start, calibrated, 1.0), calibrated, relevant, options);
    });
    if (best.fit.cost - one.fit.cost > relevant) {
      best = std::move(one);
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
  return {.refuted = start.is_whole && (set.space == OutputSpace::title || !in_stretches(task, calibrated))};
}

}  // namespace hysteron::diagnosis
