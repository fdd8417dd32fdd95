#include "diagnosis/verdict/harmonics.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "diagnosis/effects/starts.hpp"
#include "diagnosis/model/task.hpp"
#include "diagnosis/verdict/simpler.hpp"

namespace hysteron::diagnosis {
namespace {

constexpr int highest = 5;
/// Of the sampling rate: above, a line is what a sensor's filter lets through of another one.
constexpr double most_of_rate = 0.45;
constexpr double worth_a_line = 3.0;  // nats
/// Of the frequency, by how much its multiple may be off: it wanders.
constexpr double off = 0.01;
/// Of the line in front, where the size of a harmonic begins.
constexpr double of_first = 0.1;

/// A line of a set: sines of the clock that are added, whatever the machine does, or of a position.
struct Line {
  const Applied* applied = nullptr;
  std::string edge{};           ///< of the user's diagram
  Role role = Role::Frequency;  ///< Frequency, or Period
  double turns = 0.0;           ///< a second, or a unit of the position
  double size = 0.0;

  [[nodiscard]] double in_its_role(double multiple) const {
    return role == Role::Period ? 1.0 / (multiple * turns) : multiple * turns;
  }
};

std::optional<Line> line_of(const Task& task, const Explanation& one) {
  for (const Applied& applied : one.variant.effects) {
    Line line{.applied = &applied, .edge = in_the_diagram(applied.edge, one.variant.effects)};
    for (const std::string& path : applied.paths) {
      const std::optional<Index> at = place_in_fit(task, one, path);
      if (!at) {
        continue;
      }
      const double value = one.fit.x[*at];
      const EffectParameter& parameter = applied.parameter(path);
      if (parameter.role == Role::Frequency || parameter.role == Role::Period) {
        line.role = parameter.role;
        line.turns = parameter.role == Role::Period ? 1.0 / value : value;
      } else if (parameter.strength) {
        line.size = std::hypot(line.size, value);
      }
    }
    if (line.turns > 0.0 && std::isfinite(line.turns) && !applied.has(Role::Duration)) {
      return line;
    }
  }
  return std::nullopt;
}

/// Whether an effect is another line of the same: in the same block, over the same position.
bool is_of_the_same(const Applied& own, const Line& line) {
  return own.block == line.applied->block && own.delay.empty() == line.applied->delay.empty() &&
         (!own.delay.empty() || own.wires == line.applied->wires);
}

/// With a line more at this multiple, fitted; nothing where the diagram has no value there.
std::optional<Explanation> with_multiple(const Task& task, const std::string& top, const Explanation& one,
                                         const Line& line, int order) {
  for (Candidate& candidate : candidates_of(one.variant, top, {.effects = {line.applied->effect}, .again = true})) {
    if (in_the_diagram(candidate.own().edge, candidate.variant.effects) != line.edge ||
        !is_of_the_same(candidate.own(), line)) {
      continue;
    }
    const Applied& own = candidate.own();
    Screened screened;
    Start start{.values = VectorXd::Zero(std::ssize(own.parameters))};
    for (std::size_t j = 0; j < own.parameters.size(); ++j) {
      const bool is_multiple = own.parameters[j].role == line.role;
      const double value = is_multiple ? line.in_its_role(order) : of_first * line.size;
      screened.unknowns.push_back(unknown_of(own.parameters[j], own.paths[j],
                                             {.values = {value},
                                              .lowest = is_multiple ? (1.0 - off) * value : Grid{}.lowest,
                                              .highest = is_multiple ? (1.0 + off) * value : Grid{}.highest}));
      start.values[static_cast<Index>(j)] = value;
    }
    screened.candidate = std::move(candidate);
    screened.starts = {std::move(start)};
    Explanation result = begun_from(task, screened, one, {});
    if (!std::isfinite(result.fit.cost)) {
      return std::nullopt;
    }
    finish(task, result);
    return result;
  }
  return std::nullopt;
}

}  // namespace

std::optional<Explanation> with_harmonics(const Task& task, const std::string& top, const Explanation& one,
                                          double samples) {
  const std::optional<Line> line = line_of(task, one);
  if (!line) {
    return std::nullopt;
  }
  const auto support = [&](const Explanation& set) {
    return support_of(set.fit.cost, set.parameters(), set.variant.effects.size(), samples, highest);
  };
  std::optional<Explanation> best;
  for (int order = 2; order <= highest; ++order) {
    if (line->role == Role::Frequency && order * line->turns * task.records.front().sample_time() > most_of_rate) {
      break;
    }
    const Explanation& so_far = best ? *best : one;
    std::optional<Explanation> more = with_multiple(task, top, so_far, *line, order);
    if (more && support(*more) > support(so_far) + worth_a_line) {
      best = std::move(more);
    }
  }
  return best;
}

std::optional<Explanation> with_all_lines(const Task& task, const std::string& top, const CandidateOptions& options,
                                          const Searched& searched) {
  const double samples = searched.judgement.weighing_samples;
  std::optional<Explanation> whole = with_harmonics(task, top, *searched.judgement.chosen, samples);
  if (!whole) {
    return whole;
  }
  const Sets sets(task, top, options);
  std::optional<Explanation> simpler = with_simpler_formulas(sets, searched.search.calibrated.variant, *whole, samples);
  return simpler ? simpler : whole;
}

}  // namespace hysteron::diagnosis
