#include "diagnosis/harmonics.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "diagnosis/starts.hpp"
#include "diagnosis/task.hpp"

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

/// A line of a set: sines of the clock that are added, whatever the machine does.
struct Line {
  std::string effect{};
  std::string edge{};  ///< of the user's diagram
  double frequency = 0.0;
  double size = 0.0;
};

std::optional<Line> line_of(const Task& task, const Explanation& one) {
  for (const Applied& applied : one.variant.effects) {
    Line line{.effect = applied.effect, .edge = in_the_diagram(applied.edge, one.variant.effects)};
    for (const std::string& path : applied.paths) {
      const std::optional<Index> at = place_in_fit(task, one, path);
      if (!at) {
        continue;
      }
      if (applied.parameter(path).role == Role::Frequency) {
        line.frequency = one.fit.x[*at];
      } else if (applied.parameter(path).strength) {
        line.size = std::hypot(line.size, one.fit.x[*at]);
      }
    }
    if (line.frequency > 0.0 && !applied.has(Role::Duration)) {
      return line;
    }
  }
  return std::nullopt;
}

/// With a line more at this frequency, fitted; nothing where the diagram has no value there.
std::optional<Explanation> with_line_at(const Task& task, const std::string& top, const Explanation& one,
                                        const Line& line, double frequency) {
  for (Candidate& candidate : candidates_of(one.variant, top, {.effects = {line.effect}, .again = true})) {
    if (in_the_diagram(candidate.own().edge, candidate.variant.effects) != line.edge) {
      continue;
    }
    const Applied& own = candidate.own();
    Screened screened;
    Start start{.values = VectorXd::Zero(std::ssize(own.parameters))};
    for (std::size_t j = 0; j < own.parameters.size(); ++j) {
      const bool is_frequency = own.parameters[j].role == Role::Frequency;
      const double value = is_frequency ? frequency : of_first * line.size;
      screened.unknowns.push_back(unknown_of(own.parameters[j], own.paths[j],
                                             {.values = {value},
                                              .lowest = is_frequency ? (1.0 - off) * value : Grid{}.lowest,
                                              .highest = is_frequency ? (1.0 + off) * value : Grid{}.highest}));
      start.values[static_cast<Index>(j)] = value;
    }
    screened.candidate = std::move(candidate);
    screened.starts = {std::move(start)};
    Explanation result = begun_from(task, screened, one, {});
    if (!std::isfinite(result.fit.cost)) {
      return std::nullopt;
    }
    finish(task, result, false);
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
    const double frequency = order * line->frequency;
    if (frequency * task.records.front().sample_time() > most_of_rate) {
      break;
    }
    const Explanation& so_far = best ? *best : one;
    std::optional<Explanation> more = with_line_at(task, top, so_far, *line, frequency);
    if (more && support(*more) > support(so_far) + worth_a_line) {
      best = std::move(more);
    }
  }
  return best;
}

}  // namespace hysteron::diagnosis
