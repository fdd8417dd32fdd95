#include "examples/05_simulated_actuator/figures.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace simulated {
namespace {

double mean(std::span<const double> values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// The line a + b·x of least squares.
struct Line {
  double offset = 0.0;
  double slope = 0.0;
};

Line line_through(std::span<const double> x, std::span<const double> y) {
  const double x0 = mean(x);
  const double y0 = mean(y);
  double above = 0.0;
  double below = 0.0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    above += (x[k] - x0) * (y[k] - y0);
    below += (x[k] - x0) * (x[k] - x0);
  }
  return {.offset = y0 - above / below * x0, .slope = above / below};
}

/// Standard deviation of y from period to period, from the differences of neighbouring periods: creep hardly counts.
double noise_of(std::span<const double> y, std::size_t period) {
  std::vector<double> differences;
  for (std::size_t k = 0; k + period < y.size(); ++k) {
    differences.push_back(y[k + period] - y[k]);
  }
  const double average = mean(differences);
  double sum = 0.0;
  for (const double difference : differences) {
    sum += (difference - average) * (difference - average);
  }
  return std::sqrt(0.5 * sum / static_cast<double>(differences.size()));
}

}  // namespace

LoopFigures figures_of(std::span<const double> u, std::span<const double> y, std::size_t samples_per_period) {
  const std::size_t periods = y.size() / samples_per_period;
  const auto period = [&](std::span<const double> values, std::size_t i) {
    return values.subspan(i * samples_per_period, samples_per_period);
  };
  const auto later = [&](std::span<const double> values) {
    return values.subspan(samples_per_period, (periods - 1) * samples_per_period);
  };
  LoopFigures figures;
  const auto [least, largest] = std::ranges::minmax(later(y));
  figures.range = largest - least;

  // a sine starts in the middle of its rise, and passes it again half a period later
  std::vector<double> rising;
  std::vector<double> falling;
  std::vector<double> logarithms;
  std::vector<double> means;
  for (std::size_t i = 1; i < periods; ++i) {
    rising.push_back(period(y, i)[0]);
    falling.push_back(period(y, i)[samples_per_period / 2]);
    logarithms.push_back(std::log10(static_cast<double>(i) + 0.5));
    means.push_back(mean(period(y, i)));
  }
  figures.width = (mean(falling) - mean(rising)) / figures.range;
  figures.creep = line_through(logarithms, means).slope;
  figures.noise = noise_of(later(y), samples_per_period);

  const Line line = line_through(later(u), later(y));
  double sum = 0.0;
  for (std::size_t k = samples_per_period; k < periods * samples_per_period; ++k) {
    const double rest = y[k] - line.offset - line.slope * u[k];
    sum += rest * rest;
  }
  figures.line_rms = std::sqrt(sum / static_cast<double>((periods - 1) * samples_per_period)) / figures.range;
  return figures;
}

}  // namespace simulated
