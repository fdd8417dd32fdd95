#include "diagnosis/glitches.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>

#include "diagnosis/spectrum.hpp"
#include "support/median.hpp"

namespace hysteron::diagnosis {
namespace {

constexpr std::size_t reach = 3;    // samples to either side
constexpr std::size_t longest = 3;  // samples in a row: the median of seven sees past them
constexpr double far = 6.0;         // standard deviations
constexpr double rare = 0.03;       // of all samples: more of them are no glitches but a signal
/// Beside a model: what a model late by a sample or three leaves at a leap of its signal is no larger than the leap.
constexpr double beyond_travel = 1.2;
constexpr std::size_t clear = 3;  // so many beyond it, and smaller ones are glitches as well

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

/// The median of seven taken off; 0 for the first and the last few, which have neighbours on one side only: a slope
/// would make glitches of them.
std::vector<double> off_neighbours(const std::vector<double>& values) {
  std::vector<double> differences(values.size(), 0.0);
  for (std::size_t k = reach; k + reach < values.size(); ++k) {
    differences[k] = values[k] - median_about(values, k);
  }
  return differences;
}

/// A run of far samples of one record, which stands alone.
struct Run {
  std::size_t first = 0;
  std::size_t last = 0;
  double size = 0.0;
};

/// The step on which `measured` lies, without the samples that are far off: a few of these widen the range so much that
/// all others lie on one step.
double step_of(const std::vector<double>& measured, const std::vector<double>& differences, double bound) {
  std::vector<double> usual;
  for (std::size_t k = 0; k < measured.size(); ++k) {
    if (std::abs(differences[k]) <= bound) {
      usual.push_back(measured[k]);
    }
  }
  return common_step(usual);
}

/// In `signal`, the measured one or what a model leaves of it, with the differences from its neighbours.
std::vector<Run> runs_of(const std::vector<double>& signal, const std::vector<double>& differences,
                         const std::vector<double>& measured) {
  std::vector<Run> result;
  const double by_noise = far * spread(differences);
  // A sensor that rounds flickers by a step, which is no glitch, however rarely.
  const double bound = std::max(by_noise, 1.5 * step_of(measured, differences, by_noise));
  const auto is_far = [&](std::size_t k) { return bound > 0.0 && std::abs(differences[k]) > bound; };
  for (std::size_t k = reach; k + reach < signal.size(); ++k) {
    if (!is_far(k)) {
      continue;
    }
    Run run{.first = k, .last = k, .size = std::abs(differences[k])};
    for (; is_far(k + 1); ++k) {
      run.last = k + 1;
      run.size = std::max(run.size, std::abs(differences[k + 1]));
    }
    if (run.last + 1 - run.first <= longest && stands_alone(signal, run.first, run.last, run.size)) {
      result.push_back(run);
    }
  }
  return result;
}

/// Of several records, one after the other.
class Sum {
 public:
  void add(const std::vector<Run>& runs, const std::vector<double>& differences) {
    for (const Run& run : runs) {
      for (std::size_t row = run.first; row <= run.last; ++row) {
        result_.rows.push_back(offset_ + row);
        squares_ += differences[row] * differences[row];
      }
      result_.largest = std::max(result_.largest, run.size);
    }
    offset_ += differences.size();
  }

  [[nodiscard]] Glitches result() && {
    if (static_cast<double>(result_.rows.size()) > rare * static_cast<double>(offset_)) {
      return {};
    }
    result_.rms = offset_ > 0 ? std::sqrt(squares_ / static_cast<double>(offset_)) : 0.0;
    return std::move(result_);
  }

 private:
  Glitches result_{};
  std::size_t offset_ = 0;
  double squares_ = 0.0;
};

/// How far a signal goes about a run.
double travel(std::span<const double> values, const Run& run) {
  const auto [low, high] = std::ranges::minmax(values.subspan(run.first - reach, run.last - run.first + 1 + 2 * reach));
  return high - low;
}

bool repeats(const std::vector<double>& values, const Run& run) {
  bool result = false;
  for (std::size_t k = run.first; k <= run.last; ++k) {
    result = result || values[k] == values[k - 1];
  }
  return result;
}

}  // namespace

Glitches find_glitches(const std::vector<Experiment>& experiments, std::size_t output) {
  Sum sum;
  for (const Experiment& experiment : experiments) {
    const std::vector<double>& values = experiment.measured[output];
    const std::vector<double> differences = off_neighbours(values);
    sum.add(runs_of(values, differences, values), differences);
  }
  return std::move(sum).result();
}

Glitches with_model(const Glitches& found, const std::vector<Experiment>& experiments, std::size_t output,
                    std::span<const double> modelled) {
  Sum sum;
  std::size_t offset = 0;
  for (const Experiment& experiment : experiments) {
    const std::vector<double>& values = experiment.measured[output];
    const std::span<const double> model = modelled.subspan(offset, values.size());
    std::vector<double> unexplained(values.size());
    std::ranges::transform(values, model, unexplained.begin(), std::minus<>());
    const std::vector<double> differences = off_neighbours(unexplained);
    std::vector<Run> runs = runs_of(unexplained, differences, values);
    std::erase_if(runs, [&](const Run& run) { return repeats(values, run); });  // a sample was missed
    const auto known = [&](const Run& run) {
      return std::ranges::binary_search(found.rows, offset + run.first) ||
             run.size > beyond_travel * travel(model, run);
    };
    if (static_cast<std::size_t>(std::ranges::count_if(runs, known)) < clear) {
      std::erase_if(runs, std::not_fn(known));
    }
    sum.add(runs, differences);
    offset += values.size();
  }
  Glitches result = std::move(sum).result();
  return result.rows.size() > found.rows.size() ? result : found;
}

}  // namespace hysteron::diagnosis
