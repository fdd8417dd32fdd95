#include "diagnosis/effects/starts.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>

#include "diagnosis/noise/spectrum.hpp"

namespace hysteron::diagnosis {
namespace {

std::vector<double> scaled(double size, std::initializer_list<double> shares) {
  std::vector<double> values;
  for (const double share : shares) {
    values.push_back(share * size);
  }
  return values;
}

std::vector<double> geometric(double low, double high, double ratio) {
  std::vector<double> values;
  for (double value = low; value <= high * (1.0 + 1e-9) && values.size() < 100; value *= ratio) {
    values.push_back(value);
  }
  return values;
}

/// Levels that cut a signal more and more: the share of the range that is cut off.
std::vector<double> levels_above(const Extent& extent, double direction) {
  std::vector<double> values;
  for (const double cut : {0.004, 0.008, 0.015, 0.025, 0.04, 0.06, 0.09, 0.13, 0.19, 0.27, 0.4}) {
    values.push_back(direction > 0.0 ? extent.high - cut * extent.range() : extent.low + cut * extent.range());
  }
  return values;
}

double size_or(double size, double otherwise) {
  return std::isfinite(size) && size > 0.0 ? size : otherwise;
}

/// Whether an effect is an oscillation, which has a frequency that the residual shows: with more damping it is none.
bool is_oscillation(const Applied& effect) {
  return std::ranges::any_of(effect.parameters, [](const EffectParameter& one) {
    return std::isfinite(one.field.effect_maximum) && std::isinf(one.field.effect_minimum);
  });
}

std::vector<double> strength_grid(const EffectParameter& parameter, bool rings, const Extent& input,
                                  const Extent* auxiliary, const Hints& hints) {
  const Field& field = parameter.field;
  const double range = size_or(input.range(), 1.0);
  const double fastest = size_or(input.rates.empty() ? 0.0 : input.rates[99], range / hints.duration);
  switch (parameter.role) {
    case Role::Level:
      if (std::isinf(field.neutral)) {
        return levels_above(input, field.neutral);
      }
      return scaled(range, {0.001, 0.003, 0.01, 0.03, 0.1, 0.3});
    case Role::Gap: {
      // Below what a gap does to a signal, what it does to its noise: a detector of reversals sees either.
      std::vector<double> values = geometric(0.0005 * range, 0.0028 * range, 1.5);
      std::ranges::move(geometric(0.003 * range, 0.4 * range, 1.07), std::back_inserter(values));
      return values;
    }
    case Role::Quantum:
      return geometric(0.003 * range, 0.4 * range, 1.07);
    case Role::Rate:
      return std::isinf(field.neutral) ? scaled(fastest, {0.97, 0.9, 0.8, 0.65, 0.5, 0.35, 0.2, 0.1, 0.05, 0.025})
                                       : scaled(range / hints.duration, {0.05});
    case Role::Duration:
      if (rings && !hints.frequencies.empty()) {
        std::vector<double> values;
        for (const double frequency : hints.frequencies) {
          values.push_back(0.5 * std::numbers::inv_pi / frequency);
        }
        std::ranges::sort(values);
        return values;
      }
      return geometric(0.5 * hints.sample_time, std::min(0.2 * hints.duration, 4000.0 * hints.sample_time), 2.5);
    case Role::PerSecond:
      return {0.05 / hints.duration};
    case Role::Share:
      return {1e-4, 1e-3, 0.01, 0.1, 0.5};
    case Role::Instant:
    case Role::Frequency:
    case Role::Period:
    case Role::Softness:
    case Role::Reference:
    case Role::Other:
      break;
  }
  if (field.neutral != 0.0) {
    return {1.05 * field.neutral};
  }
  const double against = auxiliary == nullptr ? 1.0 : size_or(auxiliary->range(), 1.0);
  return scaled(range / against, {0.001, 0.003, 0.01, 0.03, 0.1, 0.3, 1.0});
}

std::vector<double> shape_grid(const EffectParameter& parameter, bool ends, const Extent& input,
                               const Extent* auxiliary, const Hints& hints, const std::vector<double>& periods) {
  const double range = size_or(input.range(), 1.0);
  const double across = auxiliary == nullptr ? range : size_or(auxiliary->range(), 1.0);
  switch (parameter.role) {
    case Role::Duration: {
      std::vector<double> values = geometric(4.0 * hints.sample_time, hints.duration, 4.0);
      if (parameter.field.preset == 0.0) {
        values.insert(values.begin(), 0.0);
      }
      return values;
    }
    case Role::Instant: {
      std::vector<double> values;
      const int later = std::isinf(parameter.field.preset) ? 1 : 0;  // an end comes after a beginning, or not at all
      const int parts = ends ? 48 : 8;
      for (int k = 1 + later; k < parts + later; ++k) {
        values.push_back(hints.duration * k / parts);
      }
      return values;
    }
    case Role::Frequency:
      return hints.frequencies;
    case Role::Period: {
      // What repeats over a position acts through the plant, which hides short periods from the residual: those that
      // show in it, and whole numbers of turns over the range.
      constexpr int most_turns = 20;
      std::vector<double> values = periods;
      for (int turns = 2; turns <= most_turns; ++turns) {
        values.push_back(across / turns);
      }
      std::ranges::sort(values);
      return values;
    }
    case Role::Share:
      // A share to both sides is a place: the middle, and near the ends.
      return parameter.field.minimum < 0.0 ? std::vector{0.0, 0.9, -0.9} : std::vector{0.02, 0.1, 0.4};
    case Role::Softness:
      // Between sharp and as soft as can be; at 0 itself the first derivative is 0.
      return {0.4 * parameter.field.maximum};
    case Role::Level:
    case Role::Gap:
    case Role::Quantum:
      return scaled(range, {0.05, 0.15, 0.4});
    case Role::Rate:
    case Role::PerSecond:
    case Role::Reference:
    case Role::Other:
      break;
  }
  if (parameter.unit == "'v") {
    return scaled(across, {0.01, 0.05, 0.2});
  }
  if (parameter.is_travel()) {  // what the fastest motion covers in so many samples
    return scaled(across * hints.sample_time, {0.005, 0.05, 0.5, 5.0});
  }
  return {parameter.field.preset};
}

bool is_centre(const EffectParameter& parameter) {
  return parameter.field.role == FieldRole::Centre;
}

/// Of another signal, where it adds nothing.
bool is_of_other(const EffectParameter& parameter) {
  return parameter.role == Role::Reference && parameter.unit == "'z";
}

/// Whether a signal's middle is elsewhere than at 0. Where it is there but for what a record happens to reach, 0 it is:
/// a cube about a place a percent off is a cube and a square.
bool is_off_centre(const Extent& input) {
  constexpr double off_centre = 0.1;
  return std::abs(input.low + input.high) > off_centre * input.range();
}

/// Of the rates of a signal, above which their decades count.
bool is_of_rate(const EffectParameter& parameter) {
  return parameter.role == Role::Reference && parameter.unit == "'x/s";
}

/// What a reference is set to: about the middle, or half the width of what it refers to, seen from the centre. Another
/// signal begins where the machine stood when its working point was taken.
double reference(const EffectParameter& parameter, const Extent& input, const Extent* auxiliary,
                 const Candidate& candidate) {
  const bool about_zero = candidate.about_zero;
  if (is_of_other(parameter)) {
    return about_zero || auxiliary == nullptr ? 0.0 : auxiliary->begin;
  }
  if (is_centre(parameter)) {
    return about_zero || !is_off_centre(input) ? 0.0 : 0.5 * (input.low + input.high);
  }
  if (is_of_rate(parameter)) {
    return size_or(input.rates.empty() ? 0.0 : candidate.rate_reference * input.rates[50], 1.0);
  }
  return size_or(about_zero ? std::max(std::abs(input.low), std::abs(input.high)) : 0.5 * input.range(), 1.0);
}

bool in_range(const Field& field, double value) {
  return value >= field.minimum && value <= field.maximum && !(field.above_minimum && value <= field.minimum);
}

}  // namespace

Hints hints_of(const Task& task, const Eigen::VectorXd& residuals) {
  Hints hints{.sample_time = task.records.front().sample_time()};
  for (const records::Record& record : task.records) {
    hints.duration = std::max(hints.duration, record.sample_time() * static_cast<double>(record.size()));
  }
  for (const std::string& output : task.outputs) {
    const std::vector<double>& values = task.records.front().column(output).values;
    for (const double step : likely_steps(values)) {
      hints.quanta.push_back(step);
      if (const double from_zero = step_from_zero(values, step); from_zero != step) {
        hints.quanta.push_back(from_zero);
      }
    }
  }
  const Eigen::Index rows = std::min<Eigen::Index>(residuals.size(), std::ssize(task.records.front().time()));
  const Periodogram periodogram(residuals.head(rows), hints.sample_time);
  hints.frequencies = periodogram.outstanding_lines(3);
  hints.outstanding = hints.frequencies.size();
  for (const double one : periodogram.strongest_lines(6)) {
    if (std::ranges::find(hints.frequencies, one) == hints.frequencies.end()) {
      hints.frequencies.push_back(one);
    }
  }
  return hints;
}

std::vector<Candidate> other_guesses(const Candidate& candidate, const Extent& input, const Extent* auxiliary) {
  constexpr double off_start = 0.1;
  constexpr double at_rest = 0.01;
  std::vector<Candidate> others;
  const std::vector<EffectParameter>& parameters = candidate.own().parameters;
  const bool elsewhere = (std::ranges::any_of(parameters, is_centre) && is_off_centre(input)) ||
                         (auxiliary != nullptr && std::ranges::any_of(parameters, is_of_other) &&
                          std::abs(auxiliary->begin) > off_start * auxiliary->range());
  if (elsewhere) {
    others.push_back(candidate);
    others.back().about_zero = true;
  }
  if (std::ranges::any_of(parameters, is_of_rate)) {
    for (const double share : {0.05, 0.01}) {  // a plain logarithm bends nowhere; nearer it is easier to fit
      others.push_back(candidate);
      others.back().rate_reference = share;
    }
  }
  for (const Field& choice : candidate.kind.choices) {
    if (input.first > at_rest * input.range()) {
      others.push_back(candidate);
      Applied& own = others.back().variant.effects.back();
      own.settings.emplace_back(own.instance + "." + std::string(choice.name), choice.preset == 0.0 ? 1.0 : 0.0);
    }
  }
  return others;
}

Grid bounded(const EffectParameter& parameter, double sample_time, double duration) {
  Grid grid{.lowest = parameter.field.effect_minimum, .highest = parameter.field.effect_maximum};
  if (parameter.role == Role::Duration && !parameter.strength && parameter.field.preset > 0.0) {
    grid.lowest = 4.0 * sample_time;                  // what is over sooner is a gain, an offset or a lag
    grid.highest = std::min(grid.highest, duration);  // a record shows no settling that takes longer
  }
  return grid;
}

Grids grids_of(const Candidate& candidate, const Extent& input, const Extent* auxiliary, const Hints& hints,
               const std::vector<double>& periods) {
  Grids grids;
  for (const EffectParameter& parameter : candidate.own().parameters) {
    Grid grid;
    double setting = std::numeric_limits<double>::quiet_NaN();
    if (parameter.role == Role::Reference) {
      setting = reference(parameter, input, auxiliary, candidate);
    } else {
      grid = bounded(parameter, hints.sample_time, hints.duration);
      if (parameter.role == Role::Period) {
        // Twice at least, or it is no period; and not in peaks alone, or it is a limit with a bend.
        const Extent& over = auxiliary == nullptr ? input : *auxiliary;
        grid.highest = over.usual > 0.0 ? 0.5 * over.usual : grid.highest;
        // Over a few levels some period meets each as it likes.
        constexpr std::size_t fewest_levels = 20;
        grid.highest = over.levels < fewest_levels ? 0.0 : grid.highest;
      }
      const auto drop_unfit = [&](std::vector<double>& values) {
        std::erase_if(values, [&](double value) { return !in_range(parameter.field, value) || value > grid.highest; });
      };
      grid.values = parameter.strength
                        ? strength_grid(parameter, is_oscillation(candidate.own()), input, auxiliary, hints)
                        : shape_grid(parameter, candidate.own().has_end(), input, auxiliary, hints, periods);
      if (parameter.role == Role::Frequency) {
        grid.measured = hints.outstanding;
      }
      if (parameter.role == Role::Quantum) {
        // The steps that measured values lie on, and the periods at which the residual repeats over the signal: with
        // sixty steps over the range, a quantum that is off by a percent fits no better than any other.
        std::vector<double> guesses = hints.quanta;
        drop_unfit(guesses);
        grid.measured = guesses.size();
        guesses.insert(guesses.end(), periods.begin(), periods.end());
        grid.guessed = guesses.size();
        grid.values.insert(grid.values.begin(), guesses.begin(), guesses.end());
      }
      if (parameter.role == Role::Softness && candidate.own().has(Role::Quantum)) {
        grid.values.insert(grid.values.begin(), 0.0);  // steps have no derivative that would lead there
      }
      drop_unfit(grid.values);
    }
    grids.parameters.push_back(std::move(grid));
    grids.settings.push_back(setting);
  }
  return grids;
}

Grids thinned(const Applied& effect, const Grids& grids, std::size_t stride) {
  constexpr std::size_t short_enough = 4;
  Grids result = grids;
  for (std::size_t j = 0; j < grids.parameters.size(); ++j) {
    const std::vector<double>& values = grids.parameters[j].values;
    const Role role = effect.parameters[j].role;
    if (values.size() <= short_enough || role == Role::Frequency || role == Role::Period ||
        (role == Role::Instant && effect.has_end()) ||
        (role == Role::Duration && (is_oscillation(effect) || !effect.parameters[j].strength))) {
      continue;
    }
    const std::size_t guessed = grids.parameters[j].guessed;
    result.parameters[j].values.resize(guessed);
    const std::size_t step = role == Role::Instant ? 2 : stride;
    for (std::size_t k = guessed; k < values.size(); k += step) {
      result.parameters[j].values.push_back(values[k]);
    }
  }
  return result;
}

Unknown unknown_of(const EffectParameter& parameter, const std::string& path, const Grid& grid) {
  const Field& field = parameter.field;
  Unknown unknown{.path = path,
                  .unit = parameter.unit,
                  .start = parameter.strength && std::isfinite(field.neutral) ? field.neutral : field.preset,
                  .lower = field.minimum,
                  .upper = field.maximum,
                  .rounds = parameter.role == Role::Quantum};
  if (!std::isfinite(unknown.start)) {
    unknown.start = grid.values.empty() ? 0.0 : grid.values.front();
  }
  if (!grid.values.empty()) {
    unknown.typical = std::abs(grid.values[grid.values.size() / 2]);
  }
  unknown.lower = std::max(unknown.lower, grid.lowest);
  unknown.upper = std::min(unknown.upper, grid.highest);
  if (parameter.strength && std::isfinite(field.neutral) && field.neutral > 0.0) {
    constexpr double another_unit = 10.0;  // what multiplies by more is no error of a gain
    unknown.lower = std::max(unknown.lower, field.neutral / another_unit);
    unknown.upper = std::min(unknown.upper, field.neutral * another_unit);
  }
  unknown.start = std::clamp(unknown.start, std::min(unknown.lower, unknown.upper), unknown.upper);
  if (!(unknown.typical > 0.0)) {
    unknown.typical = 1.0;
  }
  return unknown;
}

}  // namespace hysteron::diagnosis
