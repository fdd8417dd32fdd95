#include "diagnosis/faults/lagged_glitches.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <set>
#include <utility>

#include "diagnosis/faults/decays.hpp"
#include "diagnosis/model/least_squares.hpp"
#include "diagnosis/model/parallel.hpp"
#include "diagnosis/model/task.hpp"
#include "diagnosis/noise/glitches.hpp"
#include "support/median.hpp"

namespace hysteron::diagnosis {
namespace {

constexpr double far_out = 6.0;  // standard deviations of a leap
/// Of the residual's RMS, in what its fast part says is noise, less is no reason to look.
constexpr double least_rms = 1.3;
constexpr double left_of_noise = 1.5;          // likewise, of what they leave
constexpr double least_explained = 0.5;        // of its energy
constexpr double least_asymmetry = 1.0 / 0.7;  // of the energies that as many leaps leave either way
constexpr double rare_leaps = 0.02;            // of all samples
constexpr std::size_t most_leaps = 200;
constexpr std::size_t fewest = 5;        // glitches
constexpr std::size_t near = 3;          // samples from one leap to the next of the same glitch, or from an input's
constexpr double at_inputs = 0.3;        // of the glitches, the share that may lie at a leap of an input
constexpr double leap_of_input = 0.05;   // of its range
constexpr double fast_from = 0.9;        // of its steps, the share that is slower than a fast one
constexpr std::size_t explanations = 4;  // that they are looked for beside, of different effects
constexpr int rounds_beside = 4;         // of finding them and fitting the explanation
/// Time constants in samples: below, a glitch's tail is `glitches`' own; above, too few fit into the record.
constexpr double shortest = 2.8;
constexpr double per_record = 40.0;

std::vector<Signal> reversed(std::vector<Signal> residuals) {
  for (Signal& one : residuals) {
    std::ranges::reverse(one);
  }
  return residuals;
}

/// The first leaps of glitches: one that a pole of first order does not give exactly takes two or three.
std::vector<std::size_t> first_of_each(const std::vector<std::size_t>& leaps) {
  std::vector<std::size_t> result;
  for (std::size_t i = 0; i < leaps.size(); ++i) {
    if (i == 0 || leaps[i] > leaps[i - 1] + near) {
      result.push_back(leaps[i]);
    }
  }
  return result;
}

/// By sample, how far the input goes at most from one sample to the next, about it.
Signal fastest_about(const Signal& input) {
  Signal result(input.size(), 0.0);
  for (std::size_t k = 1; k < input.size(); ++k) {
    const double step = std::abs(input[k] - input[k - 1]);
    for (std::size_t at = k - std::min(k, near); at <= std::min(k + near, input.size() - 1); ++at) {
      result[at] = std::max(result[at], step);
    }
  }
  return result;
}

/// By sample, whether the input leaps about it, or is among its fastest: what limits a rate answers steps far smaller
/// than the range.
std::vector<bool> leaps_about(const Signal& input) {
  const auto [low, high] = std::ranges::minmax(input);
  const Signal steps = fastest_about(input);
  const double least = std::min(leap_of_input * (high - low), quantile(steps, fast_from));
  std::vector<bool> result(input.size());
  for (std::size_t k = 0; k < steps.size(); ++k) {
    result[k] = steps[k] > least;
  }
  return result;
}

struct Counted {
  std::size_t all = 0;
  std::size_t at_inputs = 0;
};

Counted counted(const Train& train, const std::vector<Experiment>& experiments) {
  Counted result;
  for (std::size_t record = 0; record < train.signals.size(); ++record) {
    std::vector<std::vector<bool>> leaps;
    std::ranges::transform(experiments[record].drive.inputs, std::back_inserter(leaps), leaps_about);
    for (const std::size_t at : first_of_each(train.signals[record].leaps())) {
      ++result.all;
      const bool answers = std::ranges::any_of(leaps, [&](const std::vector<bool>& about) { return about[at]; });
      result.at_inputs += answers ? 1 : 0;
    }
  }
  return result;
}

[[nodiscard]] double energy_of(const std::vector<Signal>& signals) {
  double sum = 0.0;
  for (const Signal& one : signals) {
    sum += VectorXd::Map(one.data(), std::ssize(one)).squaredNorm();
  }
  return sum;
}

/// The deviation of white noise with such differences, by their median. Of coloured noise it is too little, but such
/// noise has no direction.
double by_differences(const std::vector<Signal>& residuals) {
  std::vector<double> differences;
  for (const Signal& one : residuals) {
    for (std::size_t k = 1; k < one.size(); ++k) {
      differences.push_back(one[k] - one[k - 1]);
    }
  }
  return spread(differences) / std::sqrt(2.0);
}

/// The train that a residual shows, if it is one of glitches.
std::optional<Train> glitches_of(const std::vector<Signal>& residuals) {
  const double noise = by_differences(residuals);
  std::size_t samples = 0;
  std::size_t shortest_record = std::numeric_limits<std::size_t>::max();
  for (const Signal& one : residuals) {
    samples += one.size();
    shortest_record = std::min(shortest_record, one.size());
  }
  const double energy = energy_of(residuals);
  if (!(noise > 0.0) || energy < std::pow(least_rms * noise, 2) * static_cast<double>(samples)) {
    return std::nullopt;
  }
  const std::size_t most = std::min(most_leaps, static_cast<std::size_t>(rare_leaps * static_cast<double>(samples)));
  std::optional<Train> best;
  const auto try_with = [&](double time_constant) {
    Train train = train_of(residuals, time_constant, far_out * noise, most);
    if (!best || train.penalised < best->penalised) {
      best = std::move(train);
    }
  };
  for (double time_constant = shortest; time_constant < static_cast<double>(shortest_record) / per_record;
       time_constant *= std::sqrt(2.0)) {
    try_with(time_constant);
  }
  for (const double power : {0.25, -0.25, 0.125, -0.125}) {
    if (best) {
      try_with(best->time_constant * std::pow(2.0, power));
    }
  }
  const double may_leave =
      std::min((1.0 - least_explained) * energy, std::pow(left_of_noise * noise, 2) * static_cast<double>(samples));
  if (!best || best->left > may_leave) {
    return std::nullopt;
  }
  const std::vector<Signal> backwards = reversed(residuals);
  const Train growing = train_of(backwards, best->time_constant, far_out * noise, best->leaps);
  return growing.left > least_asymmetry * best->left ? best : std::nullopt;
}

LaggedGlitches described(const Train& train, std::size_t count, const Model& model, const Task& task,
                         std::size_t output) {
  LaggedGlitches result;
  double largest = 0.0;
  double rows = 0.0;
  for (const Decays& one : train.signals) {
    const Signal& removed = result.removed.emplace_back(one.sum());
    const auto [low, high] = std::ranges::minmax(removed);
    largest = std::max({largest, -low, high});
    rows += static_cast<double>(removed.size());
  }
  const double time_constant = train.time_constant * model.problem().program.graph.sample_time();
  const std::string unit = unit_of(model.problem().program, task.outputs[output]);
  result.finding = {
      .effect = "glitches",
      .output = output,
      .rms = std::sqrt(energy_of(result.removed) / rows),
      .remark =
          fmt::format("{} glitches of {}, of up to {:.3g} {}, die away with a time constant of about {:.2g} s: a lag "
                      "has taken them up. They are taken off the record before the fits.",
                      count, task.outputs[output], largest, unit, time_constant),
      .parameters = {as_counted("COUNT", static_cast<double>(count)), as_counted("LARGEST", largest, unit)}};
  return result;
}

/// In what an explanation leaves with these parameters.
std::optional<LaggedGlitches> found_at(const Task& task, Model& model, const VectorXd& x) {
  VectorXd residuals;
  if (!model.residuals(x, residuals)) {
    return std::nullopt;
  }
  std::optional<LaggedGlitches> best;
  double best_share = 0.0;
  for (std::size_t output = 0; output < task.outputs.size(); ++output) {
    const std::vector<Signal> measured_beyond = by_record(task, -residuals, output);
    const std::optional<Train> train = glitches_of(measured_beyond);
    if (!train) {
      continue;
    }
    const Counted leaps = counted(*train, model.problem().experiments);
    const double share = 1.0 - train->left / energy_of(measured_beyond);
    if (leaps.all >= fewest && static_cast<double>(leaps.at_inputs) <= at_inputs * static_cast<double>(leaps.all) &&
        share > best_share) {
      best_share = share;
      best = described(*train, leaps.all, model, task, output);
      const double before = 0.5 * residuals.squaredNorm();
      best->left = before - 0.5 * (energy_of(measured_beyond) - train->penalised) / std::pow(task.scales[output], 2);
    }
  }
  return best;
}

/// In what one explanation leaves, fitted anew beside them: they had bent its parameters.
std::optional<LaggedGlitches> beside_one(const Task& task, const Explanation& beside) {
  Model model = model_of_all_rows(task, beside);
  std::optional<LaggedGlitches> best = found_at(task, model, beside.fit.x);
  VectorXd x = beside.fit.x;
  for (int round = 1; best && round < rounds_beside; ++round) {
    Task without = task;
    std::vector<LeftOut> forgotten;
    take_off(without, forgotten, *best);
    Model mended = model_of_all_rows(without, beside);
    x = fit(mended, x, {.iterations = 10}).x;
    std::optional<LaggedGlitches> found = found_at(task, model, x);
    if (!found || found->left >= best->left) {
      break;
    }
    best = std::move(found);
  }
  return best;
}

}  // namespace

std::optional<LaggedGlitches> lagged_glitches(const Task& task, std::span<const Explanation> beside, unsigned threads) {
  std::vector<const Explanation*> tried;
  std::set<std::vector<std::string>> taken;
  for (const Explanation& one : beside) {
    if (tried.size() < explanations && taken.insert(one.names()).second) {
      tried.push_back(&one);
    }
  }
  std::vector<std::optional<LaggedGlitches>> found(tried.size());
  in_parallel(tried.size(), threads, [&](std::size_t i) { found[i] = beside_one(task, *tried[i]); });
  std::optional<LaggedGlitches> best;
  for (std::optional<LaggedGlitches>& one : found) {
    if (one && (!best || one->left < best->left)) {
      best = std::move(one);
    }
  }
  return best;
}

void take_off(Task& task, std::vector<LeftOut>& found, const LaggedGlitches& glitches) {
  const std::string& name = task.outputs[glitches.finding.output];
  Index rows = 0;
  for (std::size_t record = 0; record < task.records.size(); ++record) {
    Signal mended = task.records[record].column(name).values;
    std::ranges::transform(mended, glitches.removed[record], mended.begin(), std::minus<>());
    rows += std::ssize(mended);
    task.records[record].replace(name, std::move(mended));
  }
  const Index first = static_cast<Index>(glitches.finding.output) * rows;
  std::erase_if(found, [&](const LeftOut& one) {
    if (one.output != glitches.finding.output || one.glitches.empty()) {
      return false;
    }
    std::erase_if(task.left_out, [&](Index row) {
      return row >= first && std::ranges::binary_search(one.glitches, static_cast<std::size_t>(row - first));
    });
    return true;
  });
  found.push_back(glitches.finding);
}

}  // namespace hysteron::diagnosis
