#include "diagnosis/verdict/start_state.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "diagnosis/model/parallel.hpp"
#include "diagnosis/model/projection.hpp"
#include "support/median.hpp"

namespace hysteron::diagnosis {
namespace {

/// What is left of a state's trace, in energy, off constants and straight lines: a decay over two fifths of the record
/// leaves so much.
constexpr double decays = 0.03;
/// And off the traces of the states that were taken before it.
constexpr double of_its_own = 0.05;
constexpr std::size_t most_states = 6;
/// Single effects that are fitted with a free start, beside the chosen set and its parts.
constexpr std::size_t most_singles = 3;
/// The start has to be the better explanation by so many nats.
constexpr double clearly = 3.0;

/// A constant and a straight line for each output, over the time of each record.
MatrixXd lines_of(const Model& model) {
  const OutputErrorProblem& problem = model.problem();
  const auto outputs = std::ssize(problem.outputs);
  MatrixXd lines = MatrixXd::Zero(model.rows(), 2 * outputs);
  Index row = 0;
  for (Index output = 0; output < outputs; ++output) {
    for (const Experiment& experiment : problem.experiments) {
      for (const double t : experiment.time) {
        lines(row, 2 * output) = 1.0;
        lines(row++, 2 * output + 1) = t - experiment.time.front();
      }
    }
  }
  return lines;
}

/// The best of the fits from where the set stands, from the tuned parameters, and from where the chosen set stands in
/// what both have: without the right start all of them are bent.
Explanation fitted_with(const Task& task, const Explanation& from, const Explanation& chosen) {
  Explanation result{.variant = from.variant};
  Model model(task, *from.variant.program, from.variant.further);
  const VectorXd stands = start_from(model, from);
  VectorXd tuned = stands;
  tuned.head(model.first_further()) = model.start().head(model.first_further());
  VectorXd shared = stands;
  shared.head(model.first_further()) = chosen.fit.x.head(model.first_further());
  for (std::size_t i = 0; i < from.variant.further.size(); ++i) {
    if (const std::optional<Index> at = place_in_fit(task, chosen, from.variant.further[i].path)) {
      shared[model.first_further() + static_cast<Index>(i)] = chosen.fit.x[*at];
      tuned[model.first_further() + static_cast<Index>(i)] = chosen.fit.x[*at];
    }
  }
  for (const VectorXd& start : {stands, tuned, shared}) {
    Fit here = fit(model, start, {.iterations = 5, .tolerance = 1e-3});
    if (here.cost < result.fit.cost) {
      result.fit = std::move(here);
    }
  }
  return result;
}

/// What the chosen set was built from, and the best single effects; where it leaves a gap, also itself and others of
/// its size.
std::vector<const Explanation*> to_be_tried(const Search& search, const Explanation& chosen, double floor_cost) {
  constexpr double closed = 1.3;
  const bool open = chosen.fit.cost > closed * floor_cost;
  std::vector<const Explanation*> result;
  if (open || &chosen != &search.calibrated) {
    result.push_back(&search.calibrated);
  }
  if (open && &chosen != &search.calibrated) {
    result.push_back(&chosen);
  }
  const std::vector<std::string> whole = chosen.names();
  const std::vector<std::string> there = chosen.places();
  std::set<std::vector<std::string>> taken{whole};
  std::size_t singles = 0;
  for (const Explanation& one : search.explanations) {  // best first
    const std::vector<std::string> names = one.names();
    const std::vector<std::string> places = one.places();
    const bool smaller = names.size() < whole.size();
    const bool part = names.size() + 1 == whole.size() && std::ranges::includes(whole, names);
    const bool where_it_was = part && std::ranges::includes(there, places) && taken.insert(places).second;
    const bool single = names.size() == 1 && (smaller || open) && singles < most_singles;
    if (where_it_was || ((part || single) && taken.insert(names).second)) {
      singles += names.size() == 1 ? 1 : 0;
      result.push_back(&one);
    }
  }
  return result;
}

/// To the end those fits that a few steps have brought to the front.
void finish_best(const Task& task, std::vector<Explanation>& fits) {
  constexpr std::size_t finished = 2;
  std::ranges::stable_sort(fits, [](const Explanation& a, const Explanation& b) { return a.fit.cost < b.fit.cost; });
  for (std::size_t i = 0; i < std::min(finished, fits.size()); ++i) {
    if (std::isfinite(fits[i].fit.cost)) {
      Model model(task, *fits[i].variant.program, fits[i].variant.further);
      fits[i].fit = fit(model, fits[i].fit.x, {.iterations = 20});
    }
  }
}

double deviation_of(const std::vector<double>& values) {
  const Eigen::Map<const Eigen::ArrayXd> all(values.data(), std::ssize(values));
  return std::sqrt((all - all.mean()).square().mean());
}

}  // namespace

std::vector<std::string> visible_states(const Task& task, const Explanation& calibrated) {
  const Program& program = *calibrated.variant.program;
  Task free = task;
  free.initial_states = dynamic_states(program.graph);
  const auto states = std::ssize(free.initial_states);
  if (states == 0) {
    return {};
  }
  Model model(free, program, calibrated.variant.further);
  const auto first = std::ssize(model.problem().parameters);
  VectorXd residuals;
  MatrixXd jacobian;
  if (!model.residuals(start_from(model, calibrated), residuals, &jacobian)) {
    return {};
  }
  std::vector<std::string> result;
  MatrixXd taken = lines_of(model);
  const Projection lines(taken);
  for (Index state = 0; state < states && result.size() < most_states; ++state) {
    const VectorXd trace = trace_of(jacobian, first, states, state);
    const double left = lines.rest(trace).squaredNorm();
    // What rounding took from a sum acts as the sum does.
    if (left > decays * trace.squaredNorm() && Projection(taken).rest(trace).squaredNorm() > of_its_own * left) {
      taken.conservativeResize(Eigen::NoChange, taken.cols() + 1);
      taken.col(taken.cols() - 1) = trace;
      result.push_back(free.initial_states[static_cast<std::size_t>(state)]);
    }
  }
  return result;
}

std::optional<Task> with_free_start(const Task& task, const Search& search, const Judgement& judgement,
                                    double floor_cost, unsigned threads) {
  Task free = task;
  free_too(free, visible_states(task, search.calibrated));
  if (free.initial_states.size() == task.initial_states.size()) {
    return std::nullopt;
  }
  const Explanation& chosen = *judgement.chosen;
  const auto sets = to_be_tried(search, chosen, floor_cost);
  std::vector<Explanation> fits(sets.size());
  in_parallel(sets.size(), threads, [&](std::size_t i) { fits[i] = fitted_with(free, *sets[i], chosen); });
  finish_best(free, fits);
  const double samples = judgement.weighing_samples;
  const auto states = std::ssize(free.initial_states) * std::ssize(task.records);
  const auto more = states - std::ssize(task.initial_states) * std::ssize(task.records);
  const double without =
      support_of(chosen.fit.cost, chosen.parameters(), chosen.variant.effects.size(), samples, search.tried);
  const Explanation* best = nullptr;
  double best_support = without + clearly;
  for (const Explanation& one : fits) {
    const double support =
        support_of(one.fit.cost, one.parameters() + more, one.variant.effects.size(), samples, search.tried);
    const bool simpler = one.variant.effects.size() < chosen.variant.effects.size();
    const double least = least_gain(search.calibrated.fit.cost, floor_cost, one.variant.effects.size());
    if (support > best_support && (simpler || chosen.fit.cost - one.fit.cost > least)) {
      best = &one;
      best_support = support;
    }
  }
  if (best == nullptr) {
    return std::nullopt;
  }
  if (task.records.size() == 1) {
    const VectorXd values = best->fit.x.tail(states);
    for (Index state = 0; state < states; ++state) {
      free.file.set_initial(free.initial_states[static_cast<std::size_t>(state)], values[state]);
    }
  }
  return free;
}

std::string words_of_start(const Task& task, const Explanation& chosen) {
  const Model model(task, *chosen.variant.program, chosen.variant.further);
  const OutputErrorProblem& problem = model.problem();
  std::vector<std::string> values;
  Index at = std::ssize(problem.parameters);
  for (const Experiment& experiment : problem.experiments) {
    for (const FreeState& state : problem.initial_states) {
      values.push_back(fmt::format("{} = {:.4g}{}{}{}", state.path, chosen.fit.x[at++], state.unit.empty() ? "" : " ",
                                   state.unit, problem.experiments.size() > 1 ? " in " + experiment.name : ""));
    }
  }
  return fmt::format(
      "The record begins in another state than the model does after a reset. The states at its start were fitted "
      "beside all else: {}. improved.toml {}.",
      fmt::join(values, ", "), problem.experiments.size() > 1 ? "names them under initial_states" : "carries them");
}

std::string unexplained_start(const Task& task, const Explanation& chosen) {
  constexpr double far = 4.0;
  constexpr Index shortest = 5;
  constexpr Index part = 50;
  constexpr double of_its_motion = 0.05;
  const VectorXd& residuals = chosen.fit.residuals;
  Index row = 0;
  for (std::size_t at = 0; at < task.outputs.size(); ++at) {
    const std::string& output = task.outputs[at];
    for (const records::Record& record : task.records) {
      const auto size = static_cast<Index>(record.size());
      const Index head = std::max(shortest, size / part);
      // By the median: a single sample that is far off is no start.
      const auto deviation = [&](Index first, Index count) {
        std::vector<double> sizes;
        for (Index k = first; k < first + count; ++k) {
          sizes.push_back(std::abs(residuals[k]));
        }
        return deviation_of_median * median(std::move(sizes));
      };
      const double early = size > head ? deviation(row, head) : 0.0;
      const double late = size > head ? deviation(row + head, size - head) : 0.0;
      row += size;
      const double notable = of_its_motion * deviation_of(record.column(output).values) / task.scales[at];
      if (early > far * std::max(late, 1.0) && early > notable) {
        return fmt::format(
            "The model misses {} by {:.1f} floors in the first {} samples, and by {:.1f} later on: the record begins "
            "in "
            "another state than the model, and no state of a block that could be set free makes up for it. Begin the "
            "record at rest, or name what the diagram lacks.",
            output, early, head, late);
      }
    }
  }
  return {};
}

}  // namespace hysteron::diagnosis
