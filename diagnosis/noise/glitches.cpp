#include "diagnosis/noise/glitches.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>

#include "diagnosis/noise/spectrum.hpp"
#include "support/median.hpp"

namespace hysteron::diagnosis {
namespace {

constexpr std::size_t reach = 3;  // samples to either side
constexpr double far = 6.0;       // standard deviations
constexpr double rare = 0.03;     // of all samples: more of them are no glitches but a signal
/// Beside a model: what a model late by a sample or three leaves at a leap of its signal is no larger than the leap.
constexpr double beyond_travel = 1.2;
constexpr std::size_t clear = 3;  // so many beyond it, and smaller ones are glitches as well
/// What a glitch leaves behind it, in a sensor that has taken a disturbance up: each sample a part of the one before.
constexpr double dying = 0.75;
constexpr double over = 3.0;  // standard deviations
constexpr std::size_t longest_tail = 12;

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
  std::size_t tail = 0;  ///< samples behind the last
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

/// How many far samples make a run, and how many others may lie between two of them.
struct Shape {
  std::size_t longest = 0;
  std::size_t gap = 0;
};
constexpr Shape single{.longest = 3};  // the median of seven sees past them
/// Of a sensor that is known to have glitches: one may come upon the next, or on its tail.
constexpr Shape cluster{.longest = 12, .gap = reach};

/// In `signal`, the measured one or what a model leaves of it, with the differences from its neighbours.
std::vector<Run> runs_of(const std::vector<double>& signal, const std::vector<double>& differences,
                         const std::vector<double>& measured, const Shape& shape) {
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
    for (std::size_t next = k + 1; next <= run.last + 1 + shape.gap && next + reach < signal.size(); ++next) {
      if (is_far(next)) {
        run.last = next;
        run.size = std::max(run.size, std::abs(differences[next]));
      }
    }
    k = run.last;
    if (run.last + 1 - run.first <= shape.longest && stands_alone(signal, run.first, run.last, run.size)) {
      result.push_back(run);
    }
  }
  return result;
}

/// Takes the tail of each run into it, as far as it stands out of the noise.
void add_tails(std::vector<Run>& runs, const std::vector<double>& signal, double deviation) {
  for (Run& run : runs) {
    const std::size_t before = std::min(run.first, 2 * reach + 1);
    const auto first = signal.begin() + static_cast<std::ptrdiff_t>(run.first);
    const double level = median({first - static_cast<std::ptrdiff_t>(before), first});
    double last = signal[run.last] - level;
    for (std::size_t k = run.last + 1; k < std::min(signal.size(), run.last + 1 + longest_tail); ++k) {
      const double here = signal[k] - level;
      if (here * last < 0.0 || std::abs(here) > dying * std::abs(last) || std::abs(here) < over * deviation) {
        break;
      }
      run.tail = k - run.last;
      last = here;
    }
  }
}

/// Of several records, one after the other. `known` rows are no new ones.
class Sum {
 public:
  explicit Sum(std::span<const std::size_t> known) : known_(known) {}

  void add(const std::vector<Run>& runs, const std::vector<double>& differences) {
    for (const Run& run : runs) {
      for (std::size_t row = run.first; row <= run.last + run.tail; ++row) {
        result_.rows.push_back(offset_ + row);
        const double square = differences[row] * differences[row];
        squares_ += square;
        new_squares_ += std::ranges::binary_search(known_, offset_ + row) ? 0.0 : square;
      }
      struck_ += std::min(run.last + 1 - run.first, single.longest);
      result_.largest = std::max(result_.largest, run.size);
    }
    offset_ += differences.size();
  }

  [[nodiscard]] Glitches result() && {
    if (static_cast<double>(struck_) > rare * static_cast<double>(offset_)) {
      return {};
    }
    const double samples = std::max(1.0, static_cast<double>(offset_));
    result_.rms = std::sqrt(squares_ / samples);
    result_.new_rms = std::sqrt(new_squares_ / samples);
    return std::move(result_);
  }

 private:
  std::span<const std::size_t> known_;
  Glitches result_{};
  std::size_t struck_ = 0;  ///< samples, without tails
  std::size_t offset_ = 0;
  double squares_ = 0.0;
  double new_squares_ = 0.0;
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

double spread(const std::vector<double>& differences) {
  std::vector<double> sizes;
  for (const double d : differences) {
    if (d != 0.0) {
      sizes.push_back(std::abs(d));
    }
  }
  return deviation_of_median * median(std::move(sizes));
}

Glitches find_glitches(const std::vector<Experiment>& experiments, std::size_t output) {
  Sum sum({});
  for (const Experiment& experiment : experiments) {
    const std::vector<double>& values = experiment.measured[output];
    const std::vector<double> differences = off_neighbours(values);
    sum.add(runs_of(values, differences, values, single), differences);
  }
  return std::move(sum).result();
}

Glitches with_model(const Glitches& found, const std::vector<Experiment>& experiments, std::size_t output,
                    std::span<const double> modelled) {
  Sum sum(found.rows);
  std::size_t offset = 0;
  for (const Experiment& experiment : experiments) {
    const std::vector<double>& values = experiment.measured[output];
    const std::span<const double> model = modelled.subspan(offset, values.size());
    std::vector<double> unexplained(values.size());
    std::ranges::transform(values, model, unexplained.begin(), std::minus<>());
    const std::vector<double> differences = off_neighbours(unexplained);
    const auto runs_of_shape = [&](const Shape& shape) {
      std::vector<Run> seen = runs_of(unexplained, differences, values, shape);
      std::erase_if(seen, [&](const Run& run) { return repeats(values, run); });  // a sample was missed
      return seen;
    };
    std::vector<Run> runs = runs_of_shape(single);
    const auto known = [&](const Run& run) {
      return std::ranges::binary_search(found.rows, offset + run.first) ||
             run.size > beyond_travel * travel(model, run);
    };
    if (static_cast<std::size_t>(std::ranges::count_if(runs, known)) < clear) {
      std::erase_if(runs, std::not_fn(known));
    } else {
      runs = runs_of_shape(cluster);
    }
    add_tails(runs, unexplained, spread(differences));
    sum.add(runs, differences);
    offset += values.size();
  }
  Glitches result = std::move(sum).result();
  return result.rows.size() > found.rows.size() ? result : found;
}

}  // namespace hysteron::diagnosis
