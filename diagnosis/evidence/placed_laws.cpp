#include "diagnosis/evidence/placed_laws.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "diagnosis/effects/motions.hpp"
#include "diagnosis/effects/starts.hpp"
#include "diagnosis/model/task.hpp"

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

}  // namespace

bool add_law(const Task& task, const std::string& top, const LawFinding& law, const Explanation& calibrated,
             const std::vector<std::string>& columns, Beginning& beginning) {
  const Placed there = placed(beginning.variant, top, calibrated.variant.program->graph, law, columns);
  if (!there.candidate) {
    return false;
  }
  Variant variant = there.candidate->variant;
  Applied& own = variant.effects.back();
  VectorXd& x = beginning.x;
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
    x.conservativeResize(x.size() + 1);
    x[x.size() - 1] = std::clamp(value, unknown.lower, unknown.upper);
    if (parameter.is_travel()) {
      beginning.travels.push_back(x.size() - 1);
    }
  }
  std::erase_if(own.settings, [](const auto& setting) { return !std::isfinite(setting.second); });
  beginning.variant = std::move(variant);
  beginning.variant.program = compiled(beginning.variant, top);
  return there.is_own_driver;
}

}  // namespace hysteron::diagnosis
