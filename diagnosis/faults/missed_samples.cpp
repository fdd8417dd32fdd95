#include "diagnosis/faults/missed_samples.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <utility>

#include "diagnosis/noise/spectrum.hpp"
#include "support/median.hpp"

namespace hysteron::diagnosis {
namespace {

constexpr std::size_t longest_run = 40;  // samples
constexpr double still = 5.0;            // deviations of the noise, between two samples of a run
constexpr double alike = 0.3;            // of the step at the end, by which it may differ from what the slope says
constexpr double clear_evidence = 15.0;  // nats by which standing still explains a run better than moving on
constexpr double fair_evidence = 6.0;    // the same, once it is known that samples were missed
constexpr double least_slope = 3.0;      // deviations of the noise a sample
constexpr std::size_t fewest_runs = 12;
constexpr std::size_t fewest_beside_model = 6;
/// Of the way that a model goes meanwhile: it moves on and does not leap, as the measurement does at the end.
constexpr double largest_step = 0.5;
constexpr double least_leap = 0.6;
constexpr double least_share = 0.002;  // runs of all samples
/// Of the way that was missed, what the leaps at the ends of the runs make up for: all of it. A signal that is late, or
/// that sticks and yields, makes up for a part, or leaps on its own.
constexpr double least_made_up = 0.78;
constexpr double most_made_up = 1.1;
/// Dead times from the one that suits a record best: a calibrated lag has taken up a part of it.
constexpr std::size_t dead_times = 3;

/// The deviation of the noise, from how far samples lie off the cubic through their four neighbours; by the lower
/// quartile, since runs spoil their surroundings.
double noise_of(const std::vector<double>& values) {
  std::vector<double> off;
  for (std::size_t k = 2; k + 2 < values.size(); ++k) {
    const double cubic = (4.0 * (values[k - 1] + values[k + 1]) - values[k - 2] - values[k + 2]) / 6.0;
    if (values[k] != cubic) {
      off.push_back(std::abs(values[k] - cubic));
    }
  }
  if (off.size() < 20) {
    return 0.0;
  }
  constexpr double quartile_of_normal = 0.3186;  // of |z|
  constexpr double of_the_difference = 1.394;    // √(1 + (4² + 4² + 1 + 1)/6²)
  return quantile(std::move(off), 0.25) / (quartile_of_normal * of_the_difference);
}

/// What a sensor that rounds adds to the noise: between its steps a slow signal stands still, too.
double rounding(const std::vector<double>& values) {
  return rounded_off(common_step(values));
}

/// A model's output over one record, and the same behind dead times: behind one, a signal that rests when its input
/// begins to move stands still beside the model, and no sample was missed.
struct Beside {
  std::span<const double> modelled{};
  std::array<std::span<const double>, dead_times> late{};
};

/// What the leaps at the ends of runs make up for, against the way of the model, over all of them.
struct Leaps {
  double measured = 0.0;
  double modelled = 0.0;
  double squares = 0.0;

  [[nodiscard]] double made_up() const { return (measured - modelled) / std::max(squares - modelled, 1e-300); }
};

/// One record's runs.
class Runs {
 public:
  explicit Runs(const std::vector<double>& values, double least_noise = 0.0)
      : values_(values),
        noise_(std::max(least_noise, std::hypot(noise_of(values), rounding(values)))),
        held_(values.size()) {}

  /// Those that the measurement alone shows; their number.
  std::size_t clear() {
    return hold_where([&](std::size_t k, std::size_t length) {
      return k + length + 2 < values_.size() && ends_like_missed(k, length);
    });
  }

  void held_already(std::span<const std::uint8_t> held) { std::ranges::copy(held, held_.begin()); }

  /// Those that show clearly beside a model, and hardly in the measurement alone; their number.
  std::size_t clear_beside(const Beside& model) {
    return hold_where([&](std::size_t k, std::size_t length) {
      return moves_on(k, length, model.modelled) && differs_from_model(k, length, model, clear_evidence);
    });
  }

  /// Those that show beside the model.
  void beside(const Beside& model) {
    for (std::size_t k = 2; noise_ > 0.0 && k + 4 < values_.size(); ++k) {
      if (held_[k] != 0) {
        continue;
      }
      for (std::size_t length = std::min(standing_after(k), values_.size() - k - 2); length >= 1; --length) {
        if (differs_from_model(k, length, model, fair_evidence)) {
          hold(k, length);
          k += length;
          break;
        }
      }
    }
  }

  [[nodiscard]] const std::vector<std::uint8_t>& held() const { return held_; }

  void add_leaps(std::span<const double> modelled, Leaps& leaps) const {
    for (std::size_t k = 0, first = 0; k + 1 < values_.size(); ++k) {
      first = held_[k] != 0 ? first : k;  // the last sample that came
      if (held_[k] != 0 && held_[k + 1] == 0) {
        const double way = modelled[k + 1] - modelled[first];
        leaps.measured += way * (values_[k + 1] - values_[k]);
        leaps.modelled += way * (modelled[k + 1] - modelled[k]);
        leaps.squares += way * way;
      }
    }
  }

 private:
  /// The samples behind k that have its value but for the noise.
  [[nodiscard]] std::size_t standing_after(std::size_t k) const {
    std::size_t length = 0;
    while (length < longest_run && k + length + 1 < values_.size() &&
           std::abs(values_[k + length + 1] - values_[k]) <= still * noise_) {
      ++length;
    }
    return length;
  }

  /// Holds the runs that are missed samples by `are_missed(k, length)`; their number.
  template <class AreMissed>
  std::size_t hold_where(const AreMissed& are_missed) {
    std::size_t count = 0;
    for (std::size_t k = 2; noise_ > 0.0 && k + 4 < values_.size(); ++k) {
      const std::size_t length = std::min(standing_after(k), values_.size() - k - 2);
      if (length >= 1 && length < longest_run && are_missed(k, length)) {
        hold(k, length);
        ++count;
        k += length;
      }
    }
    return count;
  }

  void hold(std::size_t k, std::size_t length) {
    std::fill_n(held_.begin() + static_cast<std::ptrdiff_t>(k + 1), length, std::uint8_t{1});
  }

  /// In nats: the run against `moved(i)`, the way from its first value to sample i of it. Each is the difference of two
  /// noisy values.
  template <class Moved>
  [[nodiscard]] double evidence(std::size_t k, std::size_t length, const Moved& moved) const {
    double sum = 0.0;
    for (std::size_t i = 1; i <= length; ++i) {
      const double stood = values_[k + i] - values_[k];
      sum += std::pow(stood - moved(i), 2) - stood * stood;
    }
    return sum / (4.0 * noise_ * noise_);
  }

  [[nodiscard]] bool ends_like_missed(std::size_t k, std::size_t length) const {
    const auto samples = static_cast<double>(length + 1);
    const double step = values_[k + length + 1] - values_[k];
    const double slope = step / samples;
    if (std::abs(slope) < least_slope * noise_ ||
        evidence(k, length, [&](std::size_t i) { return slope * static_cast<double>(i); }) < clear_evidence) {
      return false;
    }
    const double before = values_[k] - values_[k - 1];
    const double after = values_[k + length + 2] - values_[k + length + 1];
    const auto matches = [&](double one) { return std::abs(step - samples * one) <= alike * std::abs(step); };
    // Before may lie the step at the end of another run, and behind it the begin of one.
    const bool steps_before = before * slope > 0.0 && std::abs(before) > 1.5 * std::abs(slope);
    const bool stands_behind = std::abs(after) <= still * noise_;
    return (matches(before) && (matches(after) || stands_behind)) || (matches(after) && steps_before);
  }

  /// A model that leaps while the measurement stands is early, and one that is behind has no leap to make up for.
  [[nodiscard]] bool moves_on(std::size_t k, std::size_t length, std::span<const double> modelled) const {
    const double way = std::abs(modelled[k + length + 1] - modelled[k]);
    double largest = 0.0;
    for (std::size_t i = 0; i <= length; ++i) {
      largest = std::max(largest, std::abs(modelled[k + i + 1] - modelled[k + i]));
    }
    return way >= least_slope * noise_ * static_cast<double>(length + 1) && largest <= largest_step * way &&
           std::abs(values_[k + length + 1] - values_[k + length]) >= least_leap * way;
  }

  [[nodiscard]] bool differs_from_model(std::size_t k, std::size_t length, const Beside& model, double least) const {
    const double step = values_[k + length + 1] - values_[k];
    const double wanted = model.modelled[k + length + 1] - model.modelled[k];
    return std::abs(step - wanted) <= alike * std::abs(step) + still * noise_ &&
           stands_beside(k, length, model.modelled) > least &&
           std::ranges::all_of(model.late, [&](std::span<const double> late) {
             return stands_beside(k, length, late) > std::min(least, fair_evidence);
           });
  }

  [[nodiscard]] double stands_beside(std::size_t k, std::size_t length, std::span<const double> modelled) const {
    return evidence(k, length, [&](std::size_t i) { return modelled[k + i] - modelled[k]; });
  }

  const std::vector<double>& values_;
  double noise_;
  std::vector<std::uint8_t> held_;
};

/// A run that was held.
struct Held {
  std::size_t first = 0;   ///< row of the output
  std::size_t length = 0;  ///< samples
  double step = 0.0;       ///< at its end
};

/// The runs of a record whose first row is `offset`.
void add(const std::vector<double>& values, const std::vector<std::uint8_t>& held, std::size_t offset,
         std::vector<Held>& runs) {
  for (std::size_t k = 1; k < values.size(); ++k) {
    if (held[k] == 0) {
      continue;
    }
    const std::size_t first = k;
    while (k + 1 < values.size() && held[k + 1] != 0) {
      ++k;
    }
    runs.push_back({.first = offset + first,
                    .length = k + 1 - first,
                    .step = k + 1 < values.size() ? values[k + 1] - values[first - 1] : 0.0});
  }
}

double variance(const std::vector<double>& values) {
  if (values.empty()) {
    return 0.0;
  }
  const Eigen::Map<const Eigen::ArrayXd> all(values.data(), std::ssize(values));
  return (all - all.mean()).square().mean();
}

/// A link loses samples whatever the signal does: log|step| = log|slope| + log(length + 1) varies by more than the
/// slope. Stairs take the same step whatever the slope: they stand long where it is small.
bool are_stairs(const std::vector<Held>& runs) {
  std::vector<double> steps;
  std::vector<double> slopes;
  for (const Held& run : runs) {
    if (run.step != 0.0) {
      steps.push_back(std::log(std::abs(run.step)));
      slopes.push_back(steps.back() - std::log(static_cast<double>(run.length + 1)));
    }
  }
  constexpr double of_stairs = 0.5;
  return steps.size() >= fewest_runs && variance(steps) < of_stairs * variance(slopes);
}

/// The outputs of all records behind a dead time in whole samples.
std::vector<double> delayed(const std::vector<Experiment>& experiments, std::span<const double> modelled,
                            std::size_t delay) {
  std::vector<double> late;
  for (const Experiment& experiment : experiments) {
    const std::size_t offset = late.size();
    for (std::size_t k = 0; k < experiment.drive.steps; ++k) {
      late.push_back(modelled[offset + (k < delay ? 0 : k - delay)]);
    }
  }
  return late;
}

/// A model beside all records.
class Models {
 public:
  Models(const std::vector<Experiment>& experiments, std::size_t output, std::span<const double> modelled)
      : modelled_(modelled) {
    double least = std::numeric_limits<double>::infinity();
    std::size_t best = 0;
    for (std::size_t delay = 0; delay <= longest_run; ++delay) {
      const std::vector<double> off = delayed(experiments, modelled, delay);
      double left = 0.0;
      std::size_t row = 0;
      for (const Experiment& experiment : experiments) {
        std::vector<double> here;
        for (const double value : experiment.measured[output]) {
          here.push_back(value - off[row++]);
        }
        left += variance(here) * static_cast<double>(here.size());
      }
      if (left < least) {
        least = left;
        best = delay;
      }
    }
    for (std::size_t i = 0; i < dead_times; ++i) {
      late_[i] = delayed(experiments, modelled, best + i);
    }
  }

  [[nodiscard]] Beside at(std::size_t offset, std::size_t size) const {
    Beside result{.modelled = modelled_.subspan(offset, size)};
    for (std::size_t i = 0; i < dead_times; ++i) {
      result.late[i] = std::span(late_[i]).subspan(offset, size);
    }
    return result;
  }

 private:
  std::span<const double> modelled_;
  std::array<std::vector<double>, dead_times> late_{};
};

template <class Find>
MissedSamples collected(const std::vector<Experiment>& experiments, std::size_t output, const Find& find) {
  std::vector<Held> runs;
  std::size_t offset = 0;
  for (const Experiment& experiment : experiments) {
    const std::vector<double>& values = experiment.measured[output];
    add(values, find(values, offset), offset, runs);
    offset += values.size();
  }
  MissedSamples result;
  if (are_stairs(runs)) {
    return result;
  }
  double squares = 0.0;
  for (const Held& run : runs) {
    result.longest = std::max(result.longest, run.length);
    for (std::size_t i = 0; i < run.length; ++i) {
      result.rows.push_back(run.first + i);
      squares += std::pow(run.step * static_cast<double>(i + 1) / static_cast<double>(run.length + 1), 2);
    }
  }
  result.rms = offset > 0 ? std::sqrt(squares / static_cast<double>(offset)) : 0.0;
  return result;
}

}  // namespace

MissedSamples find_missed_samples(const std::vector<Experiment>& experiments, std::size_t output) {
  std::size_t runs = 0;
  std::size_t samples = 0;
  MissedSamples result = collected(experiments, output, [&](const std::vector<double>& values, std::size_t /*offset*/) {
    Runs one(values);
    runs += one.clear();
    samples += values.size();
    return one.held();
  });
  const bool enough = runs >= fewest_runs && static_cast<double>(runs) >= least_share * static_cast<double>(samples);
  return enough ? result : MissedSamples{};
}

MissedSamples find_missed_samples(const std::vector<Experiment>& experiments, std::size_t output,
                                  std::span<const double> modelled, double noise) {
  std::size_t runs = 0;
  Leaps leaps;
  const Models models(experiments, output, modelled);
  MissedSamples result = collected(experiments, output, [&](const std::vector<double>& values, std::size_t offset) {
    Runs one(values, noise);
    const Beside model = models.at(offset, values.size());
    runs += one.clear_beside(model);
    one.add_leaps(model.late.front(), leaps);
    return one.held();
  });
  const bool made_up = leaps.made_up() >= least_made_up && leaps.made_up() <= most_made_up;
  return runs >= fewest_beside_model && made_up ? result : MissedSamples{};
}

MissedSamples with_model(const MissedSamples& found, const std::vector<Experiment>& experiments, std::size_t output,
                         std::span<const double> modelled) {
  std::vector<std::uint8_t> held(modelled.size(), 0);
  for (const std::size_t row : found.rows) {
    held[row] = 1;
  }
  const Models models(experiments, output, modelled);
  return collected(experiments, output, [&](const std::vector<double>& values, std::size_t offset) {
    Runs one(values);
    one.held_already(std::span(held).subspan(offset, values.size()));
    one.beside(models.at(offset, values.size()));
    return one.held();
  });
}

}  // namespace hysteron::diagnosis
