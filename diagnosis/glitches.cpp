#include "diagnosis/glitches.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "diagnosis/spectrum.hpp"
#include "support/median.hpp"

namespace hysteron::diagnosis {
namespace {

constexpr std::size_t reach = 3;    // samples to either side
constexpr std::size_t longest = 3;  // samples in a row: the median of seven sees past them
constexpr double far = 6.0;         // standard deviations
constexpr double rare = 0.03;       // of all samples: more of them are no glitches but a signal

double median_about(const std::vector<double>& values, std::size_t k) {
  std::array<double, 2 * reach + 1> window{};
  std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(k - reach), window.size(), window.begin());
  std::ranges::nth_element(window, window.begin() + reach);
  return window[reach];
}

/// Whether the samples on either side of a run lie level with each other, and not on the flanks of a peak of the
/// signal.
bool stands_alone(const std::vector<double>& values, std::size_t first, std::size_t last, double size) {
  const double before = std::abs(values[first - 1] - values[first - 2]);
  const double after = std::abs(values[last + 2] - values[last + 1]);
  const double across = std::abs(values[last + 1] - values[first - 1]);
  return std::max({before, after, across}) < 0.4 * size;
}

/// The standard deviation of most of them: by the median of those that are not 0, which rounding makes many.
double spread(const std::vector<double>& differences) {
  std::vector<double> sizes;
  for (const double d : differences) {
    if (d != 0.0) {
      sizes.push_back(std::abs(d));
    }
  }
  return deviation_of_median * median(std::move(sizes));
}

}  // namespace

Glitches find_glitches(const std::vector<Experiment>& experiments, std::size_t output) {
  Glitches result;
  std::size_t offset = 0;
  double squares = 0.0;
  for (const Experiment& experiment : experiments) {
    const std::vector<double>& values = experiment.measured[output];
    if (values.size() > 4 * reach) {
      // The first and the last few have neighbours on one side only, and a slope would make glitches of them.
      std::vector<double> differences(values.size(), 0.0);
      for (std::size_t k = reach; k + reach < values.size(); ++k) {
        differences[k] = values[k] - median_about(values, k);
      }
      // A sensor that rounds flickers by a step, which is no glitch, however rarely.
      const double bound = std::max(far * spread(differences), 1.5 * common_step(values));
      const auto is_far = [&](std::size_t k) { return bound > 0.0 && std::abs(differences[k]) > bound; };
      for (std::size_t k = reach; k + reach < values.size(); ++k) {
        if (!is_far(k)) {
          continue;
        }
        const std::size_t first = k;
        double size = std::abs(differences[k]);
        for (; is_far(k + 1); ++k) {
          size = std::max(size, std::abs(differences[k + 1]));
        }
        if (k + 1 - first > longest || !stands_alone(values, first, k, size)) {
          continue;
        }
        for (std::size_t row = first; row <= k; ++row) {
          result.rows.push_back(offset + row);
          squares += differences[row] * differences[row];
        }
        result.largest = std::max(result.largest, size);
      }
    }
    offset += values.size();
  }
  if (static_cast<double>(result.rows.size()) > rare * static_cast<double>(offset)) {
    return {};
  }
  result.rms = offset > 0 ? std::sqrt(squares / static_cast<double>(offset)) : 0.0;
  return result;
}

}  // namespace hysteron::diagnosis
