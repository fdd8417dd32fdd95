#include "diagnosis/verdict/uneven_steps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "diagnosis/model/task.hpp"

namespace hysteron::diagnosis {
namespace {

/// Values evenly spread over a step are 0.29 of it off, RMS.
constexpr double most_off_step = 0.15;
/// What lies farther than this from its step, in steps, was not rounded to it.
constexpr double farthest = 1.5;
constexpr double most_far = 0.01;  // of the samples
/// A threshold that the signal meets once or twice can always be moved to where it fits.
constexpr std::size_t fewest_crossings = 3;
/// Of the samples on the wrong side of such thresholds in the middle, moved ones leave at most this share: were each
/// crossing off by chance, the best place for three of them would leave more than half.
constexpr double least_share = 0.3;

/// Between the step with this number and the next one: the place of each sample near it, and whether it went up.
struct Crossing {
  std::vector<std::pair<double, bool>> samples{};
  std::size_t count = 0;  ///< how often it was crossed

  void add(double place, bool up) {
    count += !samples.empty() && samples.back().second != up ? 1 : 0;
    samples.emplace_back(place, up);
  }
};

std::ptrdiff_t on_wrong_side(const Crossing& crossing, double threshold) {
  return std::ranges::count_if(crossing.samples,
                               [&](const auto& sample) { return (sample.first > threshold) != sample.second; });
}

/// Where the fewest samples are on the wrong side, in the middle between two; in the middle of the step where none is.
double best_threshold(Crossing crossing, double middle) {
  std::ptrdiff_t least = on_wrong_side(crossing, middle);
  double best = middle;
  std::ranges::sort(crossing.samples);
  std::ptrdiff_t wrong = std::ranges::count(crossing.samples, false, &std::pair<double, bool>::second);  // all go up
  for (std::size_t k = 0; k + 1 < crossing.samples.size(); ++k) {
    wrong += crossing.samples[k].second ? 1 : -1;
    if (wrong < least) {
      least = wrong;
      best = 0.5 * (crossing.samples[k].first + crossing.samples[k + 1].first);
    }
  }
  return best;
}

bool on_steps(std::span<const double> smooth, std::span<const double> measured, double quantum) {
  double off = 0.0;
  std::size_t far = 0;
  for (std::size_t k = 0; k < measured.size(); ++k) {
    const double steps = measured[k] / quantum;
    off += std::pow(steps - std::round(steps), 2);
    far += std::abs(smooth[k] / quantum - steps) > farthest ? 1 : 0;
  }
  const auto count = static_cast<double>(measured.size());
  return std::sqrt(off / count) < most_off_step && static_cast<double>(far) < most_far * count;
}

}  // namespace

std::optional<MovedSteps> moved_steps(std::span<const double> smooth, std::span<const double> measured,
                                      double quantum) {
  if (!(quantum > 0.0) || measured.empty() || !on_steps(smooth, measured, quantum)) {
    return std::nullopt;
  }
  std::map<long long, Crossing> crossings;  // by the lower step
  for (std::size_t k = 0; k < measured.size(); ++k) {
    const double place = smooth[k] / quantum;
    const double lower = std::floor(place);
    const double step = std::round(measured[k] / quantum);
    if (step == lower || step == lower + 1.0) {
      crossings[std::llround(lower)].add(place, step > lower);
    }
  }
  MovedSteps result;
  std::map<long long, double> thresholds;
  double squares = 0.0;
  std::ptrdiff_t wrong_in_the_middle = 0;
  std::ptrdiff_t wrong_if_moved = 0;
  for (const auto& [lower, crossing] : crossings) {
    const double middle = static_cast<double>(lower) + 0.5;
    const double best = best_threshold(crossing, middle);
    thresholds[lower] = best;
    squares += std::pow(best - middle, 2);
    if (crossing.count >= fewest_crossings) {
      wrong_in_the_middle += on_wrong_side(crossing, middle);
      wrong_if_moved += on_wrong_side(crossing, best);
    }
  }
  if (static_cast<double>(wrong_if_moved) >= least_share * static_cast<double>(wrong_in_the_middle)) {
    return std::nullopt;
  }
  result.deviation = std::sqrt(squares / static_cast<double>(thresholds.size()));
  for (const double value : smooth) {
    const double lower = std::floor(value / quantum);
    const auto found = thresholds.find(std::llround(lower));
    const double threshold = found == thresholds.end() ? lower + 0.5 : found->second;
    result.values.push_back(quantum * (value / quantum > threshold ? lower + 1.0 : lower));
  }
  return result;
}

std::optional<Unrepeatable> uneven_steps(const Task& task, const Explanation& chosen) {
  const std::vector<Unknown>& further = chosen.variant.further;
  const auto rounding = std::ranges::find(further, true, &Unknown::rounds);
  if (rounding == further.end()) {
    return std::nullopt;
  }
  Model model(task, *chosen.variant.program, further);
  const double quantum = chosen.fit.x[model.first_further() + (rounding - further.begin())];
  VectorXd smooth;
  if (!(quantum > 0.0) || !model.residuals(model.smooth(chosen.fit.x), smooth)) {
    return std::nullopt;
  }
  Unrepeatable result{.residuals = chosen.fit.residuals};
  const Index rows = model.rows() / std::ssize(task.outputs);
  for (std::size_t output = 0; output < task.outputs.size(); ++output) {
    const std::vector<double> measured = model.measured(output);
    const Index first = static_cast<Index>(output) * rows;
    const Eigen::Map<const VectorXd> values(measured.data(), rows);
    const VectorXd given = smooth.segment(first, rows) * task.scales[output] + values;
    const auto moved = moved_steps({given.data(), measured.size()}, measured, quantum);
    if (!moved) {
      continue;
    }
    VectorXd residuals = result.residuals;
    residuals.segment(first, rows) =
        (Eigen::Map<const VectorXd>(moved->values.data(), rows) - values) / task.scales[output];
    for (const Index row : task.left_out) {
      residuals[row] = 0.0;
    }
    result.remark = fmt::format(
        "The steps of {} are of unequal widths: {:.3g} RMS is left, and {:.3g} with thresholds that lie {:.2g} steps "
        "off "
        "the middle between two (RMS).",
        task.outputs[output], rms_of(task, result.residuals, output), rms_of(task, residuals, output),
        moved->deviation);
    result.residuals = std::move(residuals);
  }
  return result.remark.empty() ? std::nullopt : std::optional(std::move(result));
}

std::optional<Unrepeatable> with_uneven_steps(const Task& task, const Search& search, double floor_cost,
                                              Judgement& judgement) {
  std::optional<Unrepeatable> steps = uneven_steps(task, *judgement.chosen);
  if (!steps) {
    return steps;
  }
  const std::vector<std::string> whole = judgement.chosen->names();
  const double unnamed = least_gain(search.calibrated.fit.cost, floor_cost, whole.size());
  const double whole_cost = 0.5 * steps->residuals.squaredNorm();
  const Explanation* smaller = nullptr;
  for (const Explanation& one : search.explanations) {
    const std::vector<std::string> names = one.names();
    const bool better = smaller == nullptr || names.size() < smaller->names().size();
    if (!better || names.size() >= whole.size() || !std::ranges::includes(whole, names)) {
      continue;
    }
    std::optional<Unrepeatable> own = uneven_steps(task, one);
    if (own && 0.5 * own->residuals.squaredNorm() - whole_cost < unnamed) {
      smaller = &one;
      steps = std::move(own);
    }
  }
  if (smaller != nullptr) {
    choose_instead(task, *smaller, judgement);
  }
  const std::vector<std::string> chosen = judgement.chosen->names();
  std::erase_if(judgement.rivals, [&](const Weighed& one) {
    const std::vector<std::string> names = one.explanation->names();
    return names.size() > chosen.size() && std::ranges::includes(names, chosen);
  });
  return steps;
}

}  // namespace hysteron::diagnosis
