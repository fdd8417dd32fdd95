#include "diagnosis/noise/spectrum.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <iterator>
#include <numbers>
#include <numeric>
#include <span>
#include <type_traits>
#include <unsupported/Eigen/FFT>
#include <utility>

#include "support/median.hpp"

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

/// The median of the heights about a peak.
double median_about(const std::vector<double>& heights, std::size_t at) {
  constexpr std::size_t reach = 40;
  const std::size_t first = at > reach ? at - reach : 1;
  const std::size_t last = std::min(at + reach, heights.size() - 1);
  std::vector<double> near(heights.begin() + static_cast<std::ptrdiff_t>(first),
                           heights.begin() + static_cast<std::ptrdiff_t>(last));
  return std::max(median(std::move(near)), 1e-300);
}

std::complex<double> mean_turn(const std::vector<double>& values, double step) {
  std::complex<double> sum = 0.0;
  for (const double value : values) {
    sum += std::polar(1.0, 2.0 * std::numbers::pi * value / step);
  }
  return sum / static_cast<double>(values.size());
}

/// The steps on which values may lie.
class Lattice {
 public:
  explicit Lattice(const std::vector<double>& values) : values_(values) {
    if (values.size() < 64) {
      return;
    }
    const auto [low, high] = std::ranges::minmax(values);
    const double range = high - low;
    if (!(range > 0.0) || !std::isfinite(range)) {
      return;
    }
    bin_ = 1.0 / (static_cast<double>(padding) * range);
    // Which of many narrow bins are taken, each once: where the machine rests its values are many, and lie on any step.
    std::vector<double> taken(padding * bins, 0.0);
    for (const double value : values) {
      const double place = std::floor((value - low) / range * static_cast<double>(bins));
      taken[std::min(static_cast<std::size_t>(place), bins - 1)] = 1.0;
    }
    count_ = std::accumulate(taken.begin(), taken.end(), 0.0);
    std::vector<std::complex<double>> transform;
    Eigen::FFT<double> fft;
    fft.fwd(transform, taken);
    std::ranges::transform(std::span(transform).first(last + 2), std::back_inserter(heights_),
                           [](const std::complex<double>& one) { return std::abs(one); });
  }

  /// The highest of all, if above half of what it can be and no chance; 0 where there is none.
  [[nodiscard]] double clear() const {
    constexpr int most_tried = 16;
    std::size_t begin = first;
    for (int tried = 0; tried < most_tried; ++tried) {
      double best = 0.5 * count_;
      std::size_t found = 0;
      for (std::size_t k = begin; k <= last && !heights_.empty(); ++k) {
        if (heights_[k] > 1.02 * best) {  // of a step and its parts, the step
          best = heights_[k];
          found = k;
        }
      }
      if (found == 0) {
        break;
      }
      if (const double step = refined(found); !may_be_chance(step, best / count_)) {
        return step;
      }
      begin = found + 1;
    }
    return 0.0;
  }

  /// The first peak on which nearly all lie, whatever finer one they lie on, too; 0 where there is none.
  [[nodiscard]] double coarsest() const {
    constexpr double nearly_all = 0.9;
    for (std::size_t k = first + 1; k < last && !heights_.empty(); ++k) {
      if (heights_[k] > nearly_all * count_ && heights_[k] >= heights_[k - 1] && heights_[k] > heights_[k + 1]) {
        return refined(k);
      }
    }
    return 0.0;
  }

  /// Of those two the ones that there are, each once.
  [[nodiscard]] std::vector<double> all_clear() const {
    std::vector<double> steps{clear()};
    if (const double first_of_two = coarsest(); first_of_two != steps.front()) {
      steps.push_back(first_of_two);
    }
    std::erase(steps, 0.0);
    return steps;
  }

  /// The one that stands highest over its neighbours.
  [[nodiscard]] double faint() const {
    constexpr double over_chance = 5.0;  // times the RMS of as many places at random
    double best = 6.0;
    std::size_t found = 0;
    for (std::size_t k = first + 1; k < last && !heights_.empty(); ++k) {
      const double height = heights_[k];
      if (height <= heights_[k - 1] || height < heights_[k + 1] || height <= over_chance * std::sqrt(count_)) {
        continue;
      }
      if (const double about = height_about(k);
          height > best * about && !may_be_chance(1.0 / (static_cast<double>(k) * bin_), height / count_)) {
        best = height / about;
        found = k;
      }
    }
    return found == 0 ? 0.0 : refined(found);
  }

 private:
  /// A signal that rests near a few levels, a voltage say that one force needs and another one for the way back, has
  /// some step that fits them all. A sensor that rounds, and the noise behind it, differ from that in one of three: the
  /// levels are many; or nearly all values lie on them; or what lies off them is as fast as noise is.
  [[nodiscard]] bool may_be_chance(double step, double share) const {
    constexpr std::size_t many = 8;
    constexpr double nearly_all = 0.9;
    constexpr double as_fast = 0.2;  // of noise with a correlation of 0.9 from sample to sample, 0.23
    return share < nearly_all && levels_at(step) < many && fast_noise() < as_fast * deviation_off_steps(step, share);
  }

  [[nodiscard]] std::size_t levels_at(double step) const {
    const double phase = std::arg(mean_turn(values_, step)) / (2.0 * std::numbers::pi);
    std::vector<double> levels;
    std::ranges::transform(values_, std::back_inserter(levels),
                           [&](double value) { return std::round(value / step - phase); });
    std::ranges::sort(levels);
    return static_cast<std::size_t>(std::unique(levels.begin(), levels.end()) - levels.begin());
  }

  [[nodiscard]] double fast_noise() const {
    std::vector<double> sizes;
    for (std::size_t k = 1; k + 1 < values_.size(); ++k) {
      sizes.push_back(std::abs(values_[k + 1] - 2.0 * values_[k] + values_[k - 1]));
    }
    return deviation_by_second_differences(std::move(sizes));
  }

  static constexpr std::size_t bins = 1U << 15U;
  static constexpr std::size_t padding = 4;
  static constexpr std::size_t first = 3 * padding;
  static constexpr std::size_t last = bins / 8 * padding;

  /// The median from a fifth below to a quarter above.
  [[nodiscard]] double height_about(std::size_t k) const {
    const std::size_t low = std::max(first, k * 4 / 5);
    std::vector<double> near(heights_.begin() + static_cast<std::ptrdiff_t>(low),
                             heights_.begin() + static_cast<std::ptrdiff_t>(std::min(last, k * 5 / 4 + 8)));
    return median(std::move(near));
  }

  /// To the place itself by all values: many steps from 0 a small error has become a whole step.
  [[nodiscard]] double refined(std::size_t k) const {
    double found = static_cast<double>(k) * bin_;
    double best = alignment(values_, 1.0 / found);
    for (double half = 0.5 * bin_; half > 1e-7 * found; half *= 0.5) {
      for (const double turns : {found - half, found + half}) {
        if (const double here = alignment(values_, 1.0 / turns); here > best) {
          best = here;
          found = turns;
        }
      }
    }
    return 1.0 / found;
  }

  const std::vector<double>& values_;
  std::vector<double> heights_{};
  double count_ = 0.0;
  double bin_ = 0.0;
};

}  // namespace

Periodogram::Periodogram(const Eigen::VectorXd& values, double sample_time) {
  const auto size = static_cast<std::size_t>(values.size());
  if (size < 32) {
    return;
  }
  std::size_t length = 1;
  while (length < 2 * size) {
    length *= 2;
  }
  bin_ = 1.0 / (static_cast<double>(length) * sample_time);
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
  std::ranges::transform(std::span(transform).first(length / 2), std::back_inserter(power_),
                         [](const std::complex<double>& one) { return std::norm(one); });
  for (std::size_t k = 6; k + 1 < power_.size(); ++k) {
    if (power_[k] > power_[k - 1] && power_[k] >= power_[k + 1]) {
      peaks_.push_back(k);
    }
  }
}

double Periodogram::frequency_of(std::size_t peak) const {
  return bin_ * (static_cast<double>(peak) + vertex(power_[peak - 1], power_[peak], power_[peak + 1]));
}

std::vector<double> Periodogram::strongest_lines(std::size_t count) const {
  std::vector<Peak> lines;
  std::ranges::transform(peaks_, std::back_inserter(lines),
                         [&](std::size_t k) { return Peak{.place = frequency_of(k), .height = power_[k]}; });
  return places_of(std::move(lines), count);
}

std::vector<double> Periodogram::outstanding_lines(std::size_t count) const {
  constexpr double least = 20.0;  // of thousands of frequencies, chance makes one ten times as high
  std::vector<Peak> lines;
  for (const std::size_t k : peaks_) {
    if (const double height = power_[k] / median_about(power_, k); height >= least) {
      lines.push_back({.place = frequency_of(k), .height = height});
    }
  }
  return places_of(std::move(lines), count);
}

double common_step(const std::vector<double>& values) {
  return Lattice(values).clear();
}

double rounded_off(double step) {
  return step / std::sqrt(12.0);
}

std::vector<double> clear_steps(const std::vector<double>& values) {
  return Lattice(values).all_clear();
}

std::vector<double> likely_steps(const std::vector<double>& values) {
  const Lattice lattice(values);
  std::vector<double> steps = lattice.all_clear();
  if (const double faint = steps.empty() ? lattice.faint() : 0.0; faint > 0.0) {
    steps.push_back(faint);
  }
  return steps;
}

double alignment(const std::vector<double>& values, double step) {
  return std::abs(mean_turn(values, step));
}

double deviation_off_steps(double step, double alignment) {
  return step * std::sqrt(-2.0 * std::log(std::clamp(alignment, 1e-6, 1.0))) * 0.5 * std::numbers::inv_pi;
}

double deviation_by_second_differences(std::vector<double> sizes) {
  return deviation_of_median * median(std::move(sizes)) / std::sqrt(6.0);
}

double step_from_zero(const std::vector<double>& values, double step) {
  constexpr double nearly = 0.95;  // of its alignment
  constexpr int rounds = 4;
  const double middle = std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  double found = step;
  for (int round = 0; round < rounds; ++round) {  // d(phase)/d(1/q) is 2π times the middle
    found = 1.0 / (1.0 / found - std::arg(mean_turn(values, found)) / (2.0 * std::numbers::pi * middle));
  }
  return mean_turn(values, found).real() > nearly * alignment(values, step) ? found : step;
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
  const auto ends = std::ranges::minmax(places);
  const double range = ends.max - ends.min;
  if (!(range > 0.0)) {
    return {};
  }
  const std::size_t stride = std::max<std::size_t>(1, size / 3000);
  constexpr int first = 7;    // two turns at least; the one before is there to see a peak
  constexpr int steps = 600;  // of a quarter of a turn over the range: up to 150 turns
  using Complex = std::complex<double>;
  std::vector<Complex> sums(steps - first);
  std::size_t next = 0;
  // So many samples at once: each one's terms follow from each other, and need not wait for those of the next.
  const auto add = [&]<std::size_t count>(std::integral_constant<std::size_t, count> /*samples*/) {
    std::array<Complex, count> turns;
    std::array<Complex, count> terms;
    for (std::size_t i = 0; i < count; ++i, next += stride) {
      const double quarter = 0.5 * std::numbers::pi * (places[next] - ends.min) / range;
      turns[i] = std::polar(1.0, quarter);
      terms[i] = residuals[static_cast<Eigen::Index>(next)] * std::polar(1.0, first * quarter);
    }
    for (Complex& sum : sums) {
      for (std::size_t i = 0; i < count; ++i) {
        const Complex term = terms[i];
        sum += term;
        terms[i] = {term.real() * turns[i].real() - term.imag() * turns[i].imag(),
                    term.real() * turns[i].imag() + term.imag() * turns[i].real()};
      }
    }
  };
  while (next + 3 * stride < size) {
    add(std::integral_constant<std::size_t, 4>{});
  }
  while (next < size) {
    add(std::integral_constant<std::size_t, 1>{});
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

const std::vector<double>& StrongestPeriods::over(const Signals& signal) {
  {
    const std::lock_guard lock(mutex_);
    if (const auto found = found_.find(&signal); found != found_.end()) {
      return found->second;
    }
  }
  std::vector<double> periods = strongest_periods(residuals_, signal, count_);  // others ask meanwhile
  const std::lock_guard lock(mutex_);
  return found_.emplace(&signal, std::move(periods)).first->second;
}

}  // namespace hysteron::diagnosis
