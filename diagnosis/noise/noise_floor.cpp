#include "diagnosis/noise/noise_floor.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "diagnosis/noise/glitches.hpp"
#include "diagnosis/noise/spectrum.hpp"
#include "diagnosis/noise/stretch_noise.hpp"
#include "diagnosis/policy.hpp"
#include "support/median.hpp"

namespace hysteron::diagnosis {
namespace {

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

/// Of the samples that differ from the last one, the share that does so by whole steps, to a thousandth.
double share_of_whole_steps(const std::vector<double>& values, double step) {
  std::size_t moved = 0;
  std::size_t whole = 0;
  for (std::size_t k = 1; k < values.size(); ++k) {
    const double steps = (values[k] - values[k - 1]) / step;
    if (std::abs(steps) > 1e-3) {
      ++moved;
      whole += std::abs(steps - std::round(steps)) < 1e-3 ? 1 : 0;
    }
  }
  return moved > 0 ? static_cast<double>(whole) / static_cast<double>(moved) : 0.0;
}

/// The least for an estimate, in samples.
constexpr std::size_t fewest = 60;

/// How far a signal that was measured too may flicker while it rests: by its noise, or by a step of its sensor. 0 where
/// that is no small part of its range: then it is what moves the machine.
double flicker_of(const Signal& signal) {
  constexpr double deviations = 4.0;
  constexpr double small = 0.002;  // of the range
  constexpr double fine = 0.001;
  if (signal.size() < fewest) {
    return 0.0;
  }
  const auto ends = std::ranges::minmax(signal);
  const auto if_below = [&](double share, double size) { return size < share * (ends.max - ends.min) ? size : 0.0; };
  return std::max(deviations * if_below(small, noise_by_differences(signal)),
                  if_below(fine, 1.001 * smallest_step(signal)));
}

/// A signal, and by how much it may flicker.
struct Watched {
  const Signal* signal = nullptr;
  double flicker = 0.0;
};

/// Rows in which no signal moves.
std::vector<records::RowRange> rests_of(const std::vector<Watched>& signals, std::size_t steps) {
  constexpr std::size_t shortest = 40;
  constexpr std::size_t longest = 600;  // of what a cubic is taken off
  std::vector<records::RowRange> result;
  std::size_t first = 0;
  for (std::size_t k = 1; k <= steps; ++k) {
    const bool moved = k == steps || std::ranges::any_of(signals, [&](const Watched& one) {
                         return std::abs(at_step(*one.signal, k) - at_step(*one.signal, first)) > one.flicker;
                       });
    if (!moved) {
      continue;
    }
    if (k - first >= shortest) {
      first += (k - first) / 3;  // what the machine takes to settle
      const std::size_t parts = (k - first + longest - 1) / longest;
      for (std::size_t part = 0; part < parts; ++part) {
        result.push_back(
            {.first = first + part * (k - first) / parts, .last = first + (part + 1) * (k - first) / parts});
      }
    }
    first = k;
  }
  return result;
}

/// By record: rests of the inputs and of what else was logged; where there are too few, of the inputs alone.
std::vector<std::vector<records::RowRange>> rests_of(const std::vector<Experiment>& experiments,
                                                     const std::vector<std::vector<Signal>>& others) {
  std::vector<std::vector<records::RowRange>> result;
  for (const bool with_others : {true, false}) {
    std::size_t samples = 0;
    result.clear();
    for (std::size_t e = 0; e < experiments.size(); ++e) {
      std::vector<Watched> signals;
      const auto watch = [&](const Signal& signal) {
        signals.push_back({.signal = &signal, .flicker = flicker_of(signal)});
      };
      std::ranges::for_each(experiments[e].drive.inputs, watch);
      for (std::size_t i = 0; with_others && e < others.size() && i < others[e].size(); ++i) {
        watch(others[e][i]);
      }
      result.push_back(rests_of(signals, experiments[e].drive.steps));
      for (const records::RowRange& rest : result.back()) {
        samples += rest.size();
      }
    }
    if (samples >= fewest) {
      break;
    }
  }
  return result;
}

double noise_by_dwells(const std::vector<Experiment>& experiments, std::size_t output,
                       const std::vector<std::vector<Signal>>& others, const std::vector<Signal>& unmodelled) {
  const auto rests = rests_of(experiments, others);
  const auto noise_of = [&](const auto& values_of) {
    std::vector<StretchNoise> all;
    for (std::size_t e = 0; e < experiments.size(); ++e) {
      const auto here = noise_of_stretches(values_of(e), rests[e], 3);
      all.insert(all.end(), here.begin(), here.end());
    }
    return lower_deviation(all, fewest);
  };
  const double measured = noise_of([&](std::size_t e) -> const Signal& { return experiments[e].measured[output]; });
  if (unmodelled.empty()) {
    return measured;
  }
  // Both are as large as the noise at least; of two equal ones the smaller would be so by chance.
  constexpr double notably = 0.85;
  const double rest = noise_of([&](std::size_t e) -> const Signal& { return unmodelled[e]; });
  return rest > 0.0 && rest < notably * measured ? rest : measured;
}

double noise_by_repeats(const std::vector<Experiment>& experiments, std::size_t output) {
  std::vector<StretchNoise> all;
  for (const Experiment& experiment : experiments) {
    const std::size_t period = input_period(experiment);
    if (period == 0) {
      continue;
    }
    const auto& values = experiment.measured[output];
    std::vector<double> differences;
    std::vector<records::RowRange> cycles;
    for (std::size_t k = 0; k + period < experiment.drive.steps; ++k) {
      differences.push_back((values[k + period] - values[k]) * std::numbers::sqrt2 / 2.0);
    }
    // The first cycle still settles.
    for (std::size_t first = period; first + 2 * period <= experiment.drive.steps; first += period) {
      cycles.push_back({.first = first, .last = first + period});
    }
    const auto here = noise_of_stretches(differences, cycles, 1);
    all.insert(all.end(), here.begin(), here.end());
  }
  return lower_deviation(all, fewest);
}

/// Rows that are left out, in order, take the value of the nearest one that stays: a sensor that rounds gets no new
/// values.
void fill_from_neighbours(Signal& values, const std::vector<std::size_t>& rows) {
  for (std::size_t i = 0; i < rows.size();) {
    std::size_t behind = i + 1;
    while (behind < rows.size() && rows[behind] == rows[behind - 1] + 1) {
      ++behind;
    }
    const std::size_t first = rows[i];
    const std::size_t last = rows[behind - 1];
    for (std::size_t k = first; k <= last; ++k) {
      const bool from_before = last + 1 >= values.size() || (first > 0 && k - first <= last - k);
      values[k] = from_before ? values[first - 1] : values[last + 1];
    }
    i = behind;
  }
}

/// Of glitches, which are rows of an output over all records, those of one record.
std::vector<std::size_t> rows_within(const std::vector<std::size_t>& rows, std::size_t offset, std::size_t size) {
  std::vector<std::size_t> result;
  for (const std::size_t row : rows) {
    if (row >= offset && row < offset + size) {
      result.push_back(row - offset);
    }
  }
  return result;
}

NoiseFloor floor_of(const std::vector<Experiment>& experiments, std::size_t output,
                    const std::vector<std::vector<Signal>>& others, const std::vector<Signal>& unmodelled) {
  NoiseFloor floor;
  double range = 0.0;
  std::vector<double> quanta;
  double sum = 0.0;
  double count = 0.0;
  double off_steps = 0.0;
  bool on_steps = true;
  for (const Experiment& experiment : experiments) {
    const std::vector<double>& values = experiment.measured[output];
    const double sigma = noise_by_differences(values);
    sum += sigma * sigma * static_cast<double>(values.size());
    count += static_cast<double>(values.size());
    const auto [low, high] = std::ranges::minmax(values);
    range = std::max(range, high - low);
    const double before = output < experiment.steps.size() ? experiment.steps[output] : 0.0;
    quanta.push_back(before > 0.0 ? before : smallest_step(values));
    const double off = noise_off_steps(values);
    on_steps = on_steps && off > 0.0;
    off_steps += off * off * static_cast<double>(values.size());
  }
  floor.off_steps = on_steps && count > 0.0 ? std::sqrt(off_steps / count) : 0.0;
  floor.differences = count > 0.0 ? std::sqrt(sum / count) : 0.0;
  floor.dwells = noise_by_dwells(experiments, output, others, unmodelled);
  floor.repeats = noise_by_repeats(experiments, output);
  // Rounding by a sensor is noise too: a quantum over √12, where the samples show one.
  const double rounding = quanta.empty() ? 0.0 : rounded_off(*std::ranges::min_element(quanta));
  const double least = std::max(std::min(rounding, most_rounding * range), 1e-9 * range);
  // Commands may rest, an enable flag and a reference, while the machine swings free: what goes on so smoothly is no
  // noise, however slow.
  if (floor.dwells > policy::smoothest_noise.value * std::max(floor.differences, least)) {
    floor.dwells = 0.0;
  }
  // Differences of a fast signal see such a quantum as noise, too.
  const bool of_rounding = rounding > most_rounding * range && floor.differences < 1.5 * rounding;
  floor.value = of_rounding ? least : std::max(floor.differences, least);
  floor.evidence = "differences";
  // Differences count a fast signal as noise, and noise that a controller's derivative made fast more than once.
  constexpr double too_much = 1.15;
  if (floor.dwells > floor.value || (floor.dwells > least && floor.differences > too_much * floor.dwells)) {
    floor.value = floor.dwells;
    floor.evidence = "dwells";
  }
  if (floor.off_steps > 0.0 && floor.off_steps < floor.value) {
    floor.value = floor.off_steps;
    floor.evidence = "steps";
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
    best = std::min(best, deviation_of_median * median(std::move(sizes)) / std::sqrt(gain));
  }
  return std::isfinite(best) ? best : 0.0;
}

double noise_off_steps(const std::vector<double>& values) {
  constexpr double rounded_last = 0.1;  // noise behind the rounding leaves no whole steps; a mended record, many
  const double step = common_step(values);
  if (!(step > 0.0) || share_of_whole_steps(values, step) > rounded_last) {
    return 0.0;
  }
  // Values on the steps themselves, but for the digits of a file, say nothing of noise.
  const double off = deviation_off_steps(step, alignment(values, step));
  constexpr double of_digits = 0.02;
  return off > of_digits * step ? off : 0.0;
}

double least_excess(const NoiseFloor& floor) {
  constexpr double of_repeats = 0.35;
  constexpr double of_others = 0.5;
  return (floor.evidence == "repeats" ? of_repeats : of_others) * floor.value;
}

NoiseRange noise_range(double left) {
  constexpr double own_error = 0.01;  // of an RMS over thousands of samples
  // Where less is left than the floor, that is too high, by an unknown factor; where as much is left, it is right.
  const double trusted = std::clamp((left - 0.9) / 0.1, 0.0, 1.0);
  return {.low = std::lerp(std::min(left, 1.0) / 3.0, 0.85, trusted),
          .likely = std::min(left, 1.0),
          .high = std::clamp(left, 1.0, policy::hidden_noise.value) * (1.0 + own_error)};
}

NoiseFloor noise_floor(const std::vector<Experiment>& experiments, std::size_t output,
                       const std::vector<std::vector<Signal>>& others, const std::vector<Signal>& unmodelled) {
  return noise_floor_without(find_glitches(experiments, output).rows, experiments, output, others, unmodelled);
}

NoiseFloor noise_floor_without(const std::vector<std::size_t>& glitches, const std::vector<Experiment>& experiments,
                               std::size_t output, const std::vector<std::vector<Signal>>& others,
                               const std::vector<Signal>& unmodelled) {
  if (glitches.empty()) {
    return floor_of(experiments, output, others, unmodelled);
  }
  std::vector<Experiment> without = experiments;
  std::vector<Signal> unmodelled_without = unmodelled;
  std::size_t offset = 0;
  for (std::size_t e = 0; e < without.size(); ++e) {
    Signal& values = without[e].measured[output];
    const std::vector<std::size_t> rows = rows_within(glitches, offset, values.size());
    offset += values.size();
    fill_from_neighbours(values, rows);
    if (e < unmodelled_without.size()) {
      fill_from_neighbours(unmodelled_without[e], rows);
    }
  }
  return floor_of(without, output, others, unmodelled_without);
}

}  // namespace hysteron::diagnosis
