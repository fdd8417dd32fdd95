#include "diagnosis/noise_floor.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "diagnosis/spectrum.hpp"

namespace hysteron::diagnosis {
namespace {

double median(std::vector<double> values) {
  if (values.empty()) {
    return 0.0;
  }
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

/// The smallest step between two different values: the quantum of a sensor that has one.
double smallest_step(std::vector<double> values) {
  std::ranges::sort(values);
  double step = std::numeric_limits<double>::infinity();
  for (std::size_t k = 1; k < values.size(); ++k) {
    const double gap = values[k] - values[k - 1];
    step = gap > 1e-12 * (std::abs(values.back()) + std::abs(values.front())) ? std::min(step, gap) : step;
  }
  return std::isfinite(step) ? step : 0.0;
}

/// Squares left of a stretch of values after a cubic is taken off, and the degrees of freedom.
struct Squares {
  double sum = 0.0;
  double freedom = 0.0;
};

/// A line that is most of what is left is a disturbance, and so part of the gap: it is taken off.
void take_off_line(Eigen::VectorXd& values) {
  constexpr double most = 0.5;
  const std::vector<double> lines = strongest_lines(values, 1.0, 1);
  if (lines.empty()) {
    return;
  }
  Eigen::MatrixXd waves(values.size(), 2);
  for (Eigen::Index k = 0; k < values.size(); ++k) {
    const double phase = 2.0 * std::numbers::pi * lines.front() * static_cast<double>(k);
    waves(k, 0) = std::sin(phase);
    waves(k, 1) = std::cos(phase);
  }
  const Eigen::VectorXd left = values - waves * waves.householderQr().solve(values);
  if (left.squaredNorm() < (1.0 - most) * values.squaredNorm()) {
    values = left;
  }
}

Squares without_trend(const Eigen::VectorXd& values, int order) {
  const Eigen::Index count = values.size();
  if (count < order + 3) {
    return {};
  }
  Eigen::MatrixXd basis(count, order + 1);
  for (Eigen::Index k = 0; k < count; ++k) {
    const double t = 2.0 * static_cast<double>(k) / static_cast<double>(count - 1) - 1.0;
    double power = 1.0;
    for (int j = 0; j <= order; ++j, power *= t) {
      basis(k, j) = power;
    }
  }
  Eigen::VectorXd left = values - basis * basis.householderQr().solve(values);
  take_off_line(left);
  // A glitch is no noise: what lies beyond six standard deviations counts as six.
  std::vector<double> sizes(left.data(), left.data() + left.size());
  std::ranges::transform(sizes, sizes.begin(), [](double r) { return std::abs(r); });
  const double bound = 6.0 * 1.4826 * median(sizes);
  if (bound > 0.0) {
    left = left.cwiseMax(-bound).cwiseMin(bound);
  }
  return {.sum = left.squaredNorm(), .freedom = static_cast<double>(count - order - 1)};
}

Eigen::VectorXd stretch(const std::vector<double>& values, std::size_t first, std::size_t last) {
  return Eigen::Map<const Eigen::VectorXd>(values.data() + first, static_cast<Eigen::Index>(last - first));
}

/// Stretches of at least `shortest` samples in which no input moves.
std::vector<records::RowRange> dwells_of(const Experiment& experiment, std::size_t shortest) {
  std::vector<records::RowRange> result;
  std::size_t first = 0;
  const std::size_t steps = experiment.drive.steps;
  for (std::size_t k = 1; k <= steps; ++k) {
    bool moved = k == steps;
    for (std::size_t i = 0; !moved && i < experiment.drive.inputs.size(); ++i) {
      moved = at_step(experiment.drive.inputs[i], k) != at_step(experiment.drive.inputs[i], k - 1);
    }
    if (moved) {
      if (k - first >= shortest) {
        result.push_back({.first = first, .last = k});
      }
      first = k;
    }
  }
  return result;
}

double noise_by_dwells(const std::vector<Experiment>& experiments, std::size_t output) {
  Squares total;
  for (const Experiment& experiment : experiments) {
    for (const records::RowRange& dwell : dwells_of(experiment, 40)) {
      // The first third is what the machine takes to settle.
      const std::size_t first = dwell.first + dwell.size() / 3;
      const Squares squares = without_trend(stretch(experiment.measured[output], first, dwell.last), 3);
      total.sum += squares.sum;
      total.freedom += squares.freedom;
    }
  }
  return total.freedom >= 60.0 ? std::sqrt(total.sum / total.freedom) : 0.0;
}

double noise_by_repeats(const std::vector<Experiment>& experiments, std::size_t output) {
  Squares total;
  for (const Experiment& experiment : experiments) {
    const std::size_t period = input_period(experiment);
    // The first cycle still settles.
    for (std::size_t first = period; period > 0 && first + 2 * period <= experiment.drive.steps; first += period) {
      const auto& values = experiment.measured[output];
      const Eigen::VectorXd difference =
          stretch(values, first + period, first + 2 * period) - stretch(values, first, first + period);
      const Squares squares = without_trend(difference, 1);
      total.sum += 0.5 * squares.sum;
      total.freedom += squares.freedom;
    }
  }
  return total.freedom >= 60.0 ? std::sqrt(total.sum / total.freedom) : 0.0;
}

}  // namespace

std::size_t input_period(const Experiment& experiment) {
  const std::size_t steps = experiment.drive.steps;
  std::vector<const Signal*> moving;
  double size = 0.0;
  for (const Signal& input : experiment.drive.inputs) {
    if (input.size() > 1) {
      const auto [low, high] = std::ranges::minmax(input);
      if (high > low) {
        moving.push_back(&input);
        size += (high - low) * (high - low);
      }
    }
  }
  if (moving.empty()) {
    return 0;
  }
  const double tolerance = 1e-6 * size;  // of the square, so 0.1 % of the range
  const auto differs = [&](std::size_t lag, std::size_t stride) {
    double sum = 0.0;
    double count = 0.0;
    for (std::size_t k = 0; k + lag < steps; k += stride) {
      for (const Signal* const input : moving) {
        const double change = (*input)[k + lag] - (*input)[k];
        sum += change * change;
      }
      count += 1.0;
    }
    return sum > tolerance * count;
  };
  const std::size_t coarse = std::max<std::size_t>(1, steps / 97);
  bool left = false;  // a signal resembles itself at small lags until it has moved away
  for (std::size_t lag = 8; lag <= steps / 3; ++lag) {
    const bool different = differs(lag, coarse);
    left = left || different;
    if (left && !different && !differs(lag, 1)) {
      return lag;
    }
  }
  return 0;
}

double noise_by_differences(const std::vector<double>& values) {
  std::vector<double> differences = values;
  double best = std::numeric_limits<double>::infinity();
  double gain = 1.0;  // C(2n, n)
  for (int order = 1; order <= 6 && differences.size() > 20; ++order) {
    for (std::size_t k = 0; k + 1 < differences.size(); ++k) {
      differences[k] = differences[k + 1] - differences[k];
    }
    differences.pop_back();
    gain *= (4.0 * order - 2.0) / order;
    if (order < 2) {
      continue;
    }
    std::vector<double> sizes(differences.size());
    std::ranges::transform(differences, sizes.begin(), [](double d) { return std::abs(d); });
    best = std::min(best, 1.4826 * median(std::move(sizes)) / std::sqrt(gain));
  }
  return std::isfinite(best) ? best : 0.0;
}

NoiseRange noise_range(double left) {
  constexpr double own_error = 0.01;  // of an RMS over thousands of samples
  return {.low = left < 1.0 ? 0.1 * left : 0.85, .high = std::clamp(left, 1.0, hidden_noise) * (1.0 + own_error)};
}

NoiseFloor noise_floor(const std::vector<Experiment>& experiments, std::size_t output) {
  NoiseFloor floor;
  double range = 0.0;
  std::vector<double> quanta;
  double sum = 0.0;
  double count = 0.0;
  for (const Experiment& experiment : experiments) {
    const std::vector<double>& values = experiment.measured[output];
    const double sigma = noise_by_differences(values);
    sum += sigma * sigma * static_cast<double>(values.size());
    count += static_cast<double>(values.size());
    const auto [low, high] = std::ranges::minmax(values);
    range = std::max(range, high - low);
    quanta.push_back(smallest_step(values));
  }
  floor.differences = count > 0.0 ? std::sqrt(sum / count) : 0.0;
  floor.dwells = noise_by_dwells(experiments, output);
  floor.repeats = noise_by_repeats(experiments, output);
  // Rounding by a sensor is noise too: a quantum over √12, where the samples show one.
  const double rounding = quanta.empty() ? 0.0 : *std::ranges::min_element(quanta) / std::sqrt(12.0);
  const double least = std::max(std::min(rounding, 0.02 * range), 1e-9 * range);
  floor.value = std::max(floor.differences, least);
  floor.evidence = "differences";
  if (floor.dwells > floor.value) {
    floor.value = floor.dwells;
    floor.evidence = "dwells";
  }
  if (floor.repeats > 0.0) {
    floor.value = std::max({floor.repeats, floor.differences, least});  // cycles may repeat to the bit
    floor.evidence = "repeats";
  }
  if (!(floor.value > 0.0)) {
    floor.value = 1.0;
  }
  return floor;
}

}  // namespace hysteron::diagnosis
