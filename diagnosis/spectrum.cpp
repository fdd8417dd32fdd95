#include "diagnosis/spectrum.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>
#include <unsupported/Eigen/FFT>

namespace hysteron::diagnosis {
namespace {

struct Peak {
  double place = 0.0;
  double height = 0.0;
};

/// Where between −1/2 and 1/2 the parabola through the logarithms of three heights has its vertex; the middle one is
/// the highest.
double vertex(double left, double middle, double right) {
  const double before = std::log(left + 1e-300);
  const double at = std::log(middle + 1e-300);
  const double after = std::log(right + 1e-300);
  const double bend = before - 2.0 * at + after;
  return bend < 0.0 ? 0.5 * (before - after) / bend : 0.0;
}

std::vector<double> places_of(std::vector<Peak> peaks, std::size_t count) {
  std::ranges::stable_sort(peaks, [](const Peak& a, const Peak& b) { return a.height > b.height; });
  std::vector<double> places;
  for (const Peak& peak : peaks) {
    if (places.size() < count) {
      places.push_back(peak.place);
    }
  }
  return places;
}

}  // namespace

std::vector<double> strongest_lines(const Eigen::VectorXd& values, double sample_time, std::size_t count) {
  const auto size = static_cast<std::size_t>(values.size());
  if (size < 32) {
    return {};
  }
  std::size_t length = 1;
  while (length < 2 * size) {
    length *= 2;
  }
  const double mean = values.mean();
  std::vector<double> windowed(length, 0.0);
  for (std::size_t k = 0; k < size; ++k) {
    const double window =
        0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(size - 1));
    windowed[k] = window * (values[static_cast<Eigen::Index>(k)] - mean);
  }
  std::vector<std::complex<double>> transform;
  Eigen::FFT<double> fft;
  fft.fwd(transform, windowed);
  const auto power = [&](std::size_t k) { return std::norm(transform[k]); };
  std::vector<Peak> peaks;
  for (std::size_t k = 6; k + 1 < length / 2; ++k) {
    if (power(k) > power(k - 1) && power(k) >= power(k + 1)) {
      const double at = static_cast<double>(k) + vertex(power(k - 1), power(k), power(k + 1));
      peaks.push_back({.place = at / (static_cast<double>(length) * sample_time), .height = power(k)});
    }
  }
  return places_of(std::move(peaks), count);
}

double common_step(const std::vector<double>& values) {
  if (values.size() < 64) {
    return 0.0;
  }
  const auto [low, high] = std::ranges::minmax(values);
  const double range = high - low;
  const double largest = std::max(std::abs(low), std::abs(high));
  if (!(range > 0.0)) {
    return 0.0;
  }
  const std::size_t stride = std::max<std::size_t>(1, values.size() / 1200);
  const auto strength = [&](double turns) {
    std::complex<double> sum = 0.0;
    double count = 0.0;
    for (std::size_t k = 0; k < values.size(); k += stride) {
      sum += std::polar(1.0, 2.0 * std::numbers::pi * turns * values[k]);
      count += 1.0;
    }
    return std::abs(sum) / count;
  };
  // Steps from a third to 1/300 of the range, close enough that the phase of the largest value moves by 1/10 turn.
  double best = 0.5;
  double step = 0.0;
  for (double turns = 3.0 / range; turns < 300.0 / range; turns += 0.1 / largest) {
    const double here = strength(turns);
    if (here > best * 1.02) {  // of a step and its parts, the step
      best = here;
      step = 1.0 / turns;
    }
  }
  return step;
}

std::vector<double> strongest_periods(const Eigen::VectorXd& residuals, const std::vector<std::vector<double>>& signal,
                                      std::size_t count) {
  std::vector<double> places;
  for (const std::vector<double>& record : signal) {
    places.insert(places.end(), record.begin(), record.end());
  }
  const std::size_t size = std::min<std::size_t>(places.size(), static_cast<std::size_t>(residuals.size()));
  if (size < 32) {
    return {};
  }
  const auto [low, high] = std::ranges::minmax(places);
  const double range = high - low;
  if (!(range > 0.0)) {
    return {};
  }
  const std::size_t stride = std::max<std::size_t>(1, size / 3000);
  constexpr int first = 7;    // two turns at least; the one before is there to see a peak
  constexpr int steps = 600;  // of a quarter of a turn over the range: up to 150 turns
  using Complex = std::complex<double>;
  std::vector<Complex> sums(steps - first);
  for (std::size_t k = 0; k < size; k += stride) {
    const double quarter = 0.5 * std::numbers::pi * (places[k] - low) / range;
    const Complex turn = std::polar(1.0, quarter);
    Complex term = residuals[static_cast<Eigen::Index>(k)] * std::polar(1.0, first * quarter);
    for (Complex& sum : sums) {
      sum += term;
      term = {term.real() * turn.real() - term.imag() * turn.imag(),
              term.real() * turn.imag() + term.imag() * turn.real()};
    }
  }
  std::vector<double> heights;
  std::ranges::transform(sums, std::back_inserter(heights), [](const Complex& sum) { return std::norm(sum); });
  std::vector<Peak> peaks;
  for (std::size_t k = 1; k + 1 < heights.size(); ++k) {
    if (heights[k] > heights[k - 1] && heights[k] >= heights[k + 1]) {
      const double turns = 0.25 * (static_cast<double>(k + first) + vertex(heights[k - 1], heights[k], heights[k + 1]));
      peaks.push_back({.place = range / turns, .height = heights[k]});
    }
  }
  return places_of(std::move(peaks), count);
}

}  // namespace hysteron::diagnosis
