#include "diagnosis/findings/maps.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <unsupported/Eigen/FFT>

#include "diagnosis/effects/signals.hpp"

namespace hysteron::diagnosis {
namespace {

constexpr std::size_t bins = 24;

/// One sample with all that a map may be over.
struct Sample {
  double before = 0.0;
  double after = 0.0;
  double amplitude = 0.0;
  double rate = 0.0;
  double depth = 0.0;  ///< travel since the last reversal
  double since = 0.0;  ///< seconds since it
  double time = 0.0;
};

struct Chosen {
  std::size_t output = 0;
  std::size_t input = 0;
};

/// Of the inputs the one that travels most.
Chosen choose(const OutputErrorProblem& problem, std::size_t output) {
  Chosen chosen{.output = output};
  double travel = -1.0;
  for (std::size_t input = 0; input < problem.program.graph.inputs.size(); ++input) {
    const Signal& values = problem.experiments.front().drive.inputs[input];
    if (values.size() > 1) {
      const auto [low, high] = std::ranges::minmax(values);
      double path = 0.0;
      for (std::size_t k = 1; k < values.size(); ++k) {
        path += std::abs(values[k] - values[k - 1]);
      }
      if (high > low && path / (high - low) > travel) {
        travel = path / (high - low);
        chosen.input = input;
      }
    }
  }
  return chosen;
}

std::vector<Sample> samples_of(const Task& task, const OutputErrorProblem& problem, const Chosen& chosen,
                               const VectorXd& before, const VectorXd& after) {
  std::vector<Sample> samples;
  const Index rows = before.size() / std::ssize(task.outputs);
  Index row = static_cast<Index>(chosen.output) * rows;
  const double scale = task.scales[chosen.output];
  for (const Experiment& experiment : problem.experiments) {
    const Signal& input = experiment.drive.inputs[chosen.input];
    const auto [low, high] = std::ranges::minmax(input);
    const double dead = 0.01 * (high - low);
    double extreme = at_step(input, 0);
    double direction = 0.0;
    double turned = 0.0;
    for (std::size_t k = 0; k < experiment.drive.steps; ++k, ++row) {
      const double u = at_step(input, k);
      const double last = at_step(input, k > 0 ? k - 1 : 0);
      const double t = static_cast<double>(k) * experiment.drive.sample_time;
      if (direction == 0.0 || (u - extreme) * direction > 0.0) {
        direction = direction == 0.0 && u != extreme ? (u > extreme ? 1.0 : -1.0) : direction;
        extreme = direction == 0.0 ? extreme : u;
      } else if (std::abs(u - extreme) > dead) {
        direction = -direction;
        turned = t;
        extreme = u;
      }
      samples.push_back({.before = before[row] * scale,
                         .after = after[row] * scale,
                         .amplitude = u,
                         .rate = (u - last) / experiment.drive.sample_time,
                         .depth = 0.0,
                         .since = t - turned,
                         .time = t});
    }
    // Travel since the reversal, once the reversals are known by their times.
    const std::size_t first = samples.size() - experiment.drive.steps;
    double origin = samples[first].amplitude;
    for (std::size_t k = first + 1; k < samples.size(); ++k) {
      if (samples[k].since < samples[k - 1].since) {
        origin = samples[k - 1].amplitude;
      }
      samples[k].depth = std::abs(samples[k].amplitude - origin);
    }
  }
  return samples;
}

MapFinding map_over(std::string over, std::string unit, const std::vector<Sample>& samples,
                    const std::function<double(const Sample&)>& place) {
  MapFinding map{.over = std::move(over), .unit = std::move(unit)};
  std::vector<double> sorted;
  sorted.reserve(samples.size());
  for (const Sample& sample : samples) {
    sorted.push_back(place(sample));
  }
  std::ranges::sort(sorted);
  const double low = sorted[sorted.size() / 500];
  const double high = sorted[sorted.size() - 1 - sorted.size() / 500];
  if (!(high > low)) {
    return map;
  }
  std::vector<double> count(bins, 0.0);
  std::vector<double> before(bins, 0.0);
  std::vector<double> after(bins, 0.0);
  std::vector<double> mean(bins, 0.0);
  double total = 0.0;
  double sum = 0.0;
  for (const Sample& sample : samples) {
    const double at = (place(sample) - low) / (high - low) * static_cast<double>(bins);
    const auto bin = static_cast<std::size_t>(std::clamp(at, 0.0, static_cast<double>(bins - 1)));
    count[bin] += 1.0;
    before[bin] += sample.before * sample.before;
    after[bin] += sample.after * sample.after;
    mean[bin] += sample.before;
    total += sample.before * sample.before;
    sum += sample.before;
  }
  double explained = -sum * sum / static_cast<double>(samples.size());
  for (std::size_t bin = 0; bin < bins; ++bin) {
    if (count[bin] < 3.0) {
      continue;
    }
    explained += mean[bin] * mean[bin] / count[bin];
    map.places.push_back(low + (static_cast<double>(bin) + 0.5) * (high - low) / static_cast<double>(bins));
    map.before.push_back(std::sqrt(before[bin] / count[bin]));
    map.after.push_back(std::sqrt(after[bin] / count[bin]));
    map.mean.push_back(mean[bin] / count[bin]);
  }
  map.share = total > 0.0 ? std::clamp(explained / total, 0.0, 1.0) : 0.0;
  return map;
}

/// Root mean squares by bands of a third of a decade.
MapFinding over_frequency(const std::vector<Sample>& samples, double sample_time) {
  MapFinding map{.over = "frequency", .unit = "Hz"};
  const auto spectrum = [&](bool after) {
    std::vector<double> values;
    values.reserve(samples.size());
    for (const Sample& sample : samples) {
      values.push_back(after ? sample.after : sample.before);
    }
    values.resize(values.size() - values.size() % 2);
    std::vector<std::complex<double>> transform;
    Eigen::FFT<double> fft;
    fft.fwd(transform, values);
    return transform;
  };
  const auto before = spectrum(false);
  const auto after = spectrum(true);
  const std::size_t size = before.size();
  const double step = 1.0 / (static_cast<double>(size) * sample_time);
  for (double low = step; low < 0.5 / sample_time; low *= std::pow(10.0, 1.0 / 3.0)) {
    const auto first = static_cast<std::size_t>(std::ceil(low / step));
    const auto last = std::min(size / 2, static_cast<std::size_t>(std::ceil(low * std::pow(10.0, 1.0 / 3.0) / step)));
    double sum_before = 0.0;
    double sum_after = 0.0;
    for (std::size_t k = std::max<std::size_t>(1, first); k < last; ++k) {
      sum_before += 2.0 * std::norm(before[k]);
      sum_after += 2.0 * std::norm(after[k]);
    }
    if (last > first) {
      map.places.push_back(low * std::pow(10.0, 1.0 / 6.0));
      map.before.push_back(std::sqrt(sum_before) / static_cast<double>(size));
      map.after.push_back(std::sqrt(sum_after) / static_cast<double>(size));
      map.mean.push_back(0.0);
    }
  }
  return map;
}

}  // namespace

std::vector<MapFinding> maps_of(const Task& task, const Explanation& calibrated, const Explanation& improved,
                                std::size_t output) {
  const Model model(task, *calibrated.variant.program);
  const OutputErrorProblem& problem = model.problem();
  const Chosen chosen = choose(problem, output);
  const Port& input = problem.program.graph.inputs[chosen.input];
  const auto samples = samples_of(task, problem, chosen, calibrated.fit.residuals, improved.fit.residuals);
  std::vector<MapFinding> maps;
  const std::string rate_unit = input.unit.empty() ? "1/s" : input.unit + "/s";
  maps.push_back(
      map_over("amplitude of " + input.name, input.unit, samples, [](const Sample& s) { return s.amplitude; }));
  maps.push_back(map_over("rate of " + input.name, rate_unit, samples, [](const Sample& s) { return s.rate; }));
  maps.push_back(map_over("direction of " + input.name, "1", samples,
                          [](const Sample& s) { return s.rate > 0.0 ? 1.0 : (s.rate < 0.0 ? -1.0 : 0.0); }));
  maps.push_back(map_over("depth of the branch", input.unit, samples, [](const Sample& s) { return s.depth; }));
  maps.push_back(map_over("time since the branch", "s", samples, [](const Sample& s) { return s.since; }));
  maps.push_back(map_over("run time", "s", samples, [](const Sample& s) { return s.time; }));
  maps.push_back(over_frequency(samples, problem.experiments.front().drive.sample_time));
  std::erase_if(maps, [](const MapFinding& map) { return map.places.size() < 2; });
  return maps;
}

}  // namespace hysteron::diagnosis
