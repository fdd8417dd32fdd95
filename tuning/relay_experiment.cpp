#include "tuning/relay_experiment.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>
#include <vector>

#include "support/errors.hpp"

namespace hysteron {
namespace {

using std::numbers::pi;

/// Of the distance of the two levels, how far a sample may lie from its level.
constexpr double level_band = 0.1;
constexpr std::size_t least_cycles = 3;
constexpr double most_spread = 0.1;
/// How much of the way between the levels the mean of u has to be off the rest, for a static gain.
constexpr double least_asymmetry = 0.02;

[[noreturn]] void refuse(const std::string& file, std::string cause, std::string mend) {
  throw InputError(error::no_limit_cycle, {.file = file}, std::move(cause), std::move(mend));
}

double mean(std::span<const double> values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// Whether u is at its high level, by sample, once the relay works; the samples before are those of rest.
struct Levels {
  double low = 0.0;
  double high = 0.0;
  std::size_t begin = 0;  ///< the first sample from which on u is at either level
};

Levels levels_of(std::span<const double> u, const std::string& file) {
  std::vector<double> sorted(u.begin(), u.end());
  std::ranges::sort(sorted);
  Levels levels{.low = sorted.front(), .high = sorted.back(), .begin = u.size()};
  const double band = level_band * (levels.high - levels.low);
  if (!(band > 0.0)) {
    refuse(file, "The relay's output never moves.", "name its column by --u, and record at least three oscillations.");
  }
  const auto is_level = [&](double value) { return value - levels.low <= band || levels.high - value <= band; };
  for (std::size_t k = u.size(); k > 0 && is_level(u[k - 1]); --k) {
    levels.begin = k - 1;
  }
  if (u.size() - levels.begin < u.size() / 2) {
    refuse(file, "The column of the relay's output does not jump between two levels.",
           "name the column that the relay writes by --u; what a controller or a filter writes tells of no relay.");
  }
  std::vector<double> low;
  std::vector<double> high;
  for (std::size_t k = levels.begin; k < u.size(); ++k) {
    (u[k] - levels.low <= band ? low : high).push_back(u[k]);
  }
  levels.low = mean(low);
  levels.high = mean(high);
  return levels;
}

std::complex<double> first_coefficient(std::span<const double> values, double angle) {
  const double centre = mean(values);
  std::complex<double> sum{};
  for (std::size_t k = 0; k < values.size(); ++k) {
    sum += (values[k] - centre) * std::polar(1.0, -angle * static_cast<double>(k));
  }
  return sum;
}

void add_model(RelayExperiment& result, std::span<const double> u, std::span<const double> y,
               std::span<const double> cycles_u, std::span<const double> cycles_y, std::size_t begin) {
  if (begin == 0) {
    result.why_no_model = "the record does not begin at rest, before the relay works";
    return;
  }
  const double moved = mean(cycles_u) - mean(u.first(begin));
  if (std::fabs(moved) < least_asymmetry * (result.high - result.low)) {
    result.why_no_model = "the relay is symmetric about the rest, so that the mean tells no static gain";
    return;
  }
  const double gain = (mean(cycles_y) - mean(y.first(begin))) / moved;
  const double omega = 2.0 * pi / result.period;
  const double ratio = std::fabs(gain) / result.gain;
  if (!(gain * result.direction > 0.0) || !(ratio > 1.0)) {
    result.why_no_model = fmt::format(
        "the static gain, {:.3g}, is not larger than that of the oscillation: the process drifts, or is no lag", gain);
    return;
  }
  const double time = std::sqrt(ratio * ratio - 1.0) / omega;
  const double dead_time = (-result.phase * pi / 180.0 - std::atan(omega * time)) / omega;
  if (!(dead_time >= 0.0)) {
    result.why_no_model = "the phase of the oscillation is less than that of a lag";
    return;
  }
  result.model = FirstOrderModel{.gain = gain, .time = time, .dead_time = dead_time};
}

}  // namespace

ControllerStart RelayExperiment::pi() const {
  return {.gain = direction * ultimate_gain / 3.2, .reset_time = 2.2 * ultimate_period};
}

ControllerStart RelayExperiment::pid() const {
  return {
      .gain = direction * ultimate_gain / 2.2, .reset_time = 2.2 * ultimate_period, .rate_time = ultimate_period / 6.3};
}

namespace {

/// V over m/s is V/(m/s).
std::string quotient(const std::string& upper, const std::string& lower) {
  if (upper.empty() || lower.empty()) {
    return "";
  }
  const bool is_compound = lower.find_first_of("*/ ") != std::string::npos;
  return is_compound ? fmt::format("{}/({})", upper, lower) : fmt::format("{}/{}", upper, lower);
}

}  // namespace

std::string RelayExperiment::controller_unit() const {
  return quotient(u_unit, y_unit);
}

std::string RelayExperiment::process_unit() const {
  return quotient(y_unit, u_unit);
}

RelayExperiment relay_experiment(std::span<const double> u, std::span<const double> y, double sample_time,
                                 const std::string& file) {
  const Levels levels = levels_of(u, file);
  const double middle = 0.5 * (levels.low + levels.high);
  std::vector<std::size_t> rises;
  std::vector<double> at_rise;
  std::vector<double> at_fall;
  for (std::size_t k = levels.begin + 1; k < u.size(); ++k) {
    if ((u[k] > middle) != (u[k - 1] > middle)) {
      (u[k] > middle ? at_rise : at_fall).push_back(y[k]);
      if (u[k] > middle) {
        rises.push_back(k);
      }
    }
  }
  // The first cycle is still on its way to the others.
  const std::size_t skipped = rises.size() > least_cycles + 1 ? 1 : 0;
  if (rises.size() < least_cycles + 1 + skipped) {
    refuse(file, fmt::format("The record holds {} whole cycles of the relay.", rises.empty() ? 0 : rises.size() - 1),
           "record at least four: the first is still on its way to the others.");
  }
  const std::size_t first = rises[skipped];
  const std::size_t last = rises.back();
  RelayExperiment result{.low = levels.low, .high = levels.high};
  result.cycles = static_cast<int>(rises.size() - 1 - skipped);
  result.period = static_cast<double>(last - first) * sample_time / result.cycles;
  double swing = 0.0;
  for (std::size_t i = skipped; i + 1 < rises.size(); ++i) {
    const auto cycle = y.subspan(rises[i], rises[i + 1] - rises[i]);
    const auto [lowest, highest] = std::ranges::minmax(cycle);
    swing += (highest - lowest) / result.cycles;
    const double own = static_cast<double>(cycle.size()) * sample_time / result.period - 1.0;
    result.spread += own * own / result.cycles;
  }
  result.spread = std::sqrt(result.spread);
  if (result.spread > most_spread) {
    refuse(file, fmt::format("The periods of the oscillation differ by {:.0f} %.", 100.0 * result.spread),
           "record until they repeat, with no disturbance; a hysteresis of the relay beyond the noise keeps it from "
           "switching by itself. --range takes a part of the record.");
  }
  result.amplitude = 0.5 * swing;
  result.hysteresis = 0.5 * std::fabs(mean(at_rise) - mean(at_fall));
  const auto cycles_u = u.subspan(first, last - first);
  const auto cycles_y = y.subspan(first, last - first);
  result.duty = static_cast<double>(std::ranges::count_if(cycles_u, [&](double value) { return value > middle; })) /
                static_cast<double>(cycles_u.size());
  const double angle = 2.0 * pi * sample_time / result.period;
  const std::complex<double> response = first_coefficient(cycles_y, angle) / first_coefficient(cycles_u, angle);
  result.gain = std::abs(response);
  if (!(result.gain > 0.0)) {
    refuse(file, "The process value does not move with the relay.", "name its column by --y.");
  }
  // A relay makes the loop oscillate near −180°: about 0° it works on a process that falls with u.
  double phase = std::arg(response) * 180.0 / pi;
  result.direction = std::fabs(phase) < 90.0 ? -1.0 : 1.0;
  phase -= result.direction < 0.0 ? 180.0 : 0.0;
  result.phase = phase > 0.0 ? phase - 360.0 : phase;
  result.ultimate_gain = 1.0 / result.gain;
  result.ultimate_period = result.period;
  add_model(result, u, y, cycles_u, cycles_y, levels.begin);
  return result;
}

RelayExperiment relay_experiment(const records::Record& record, const std::string& u, const std::string& y) {
  const records::Column& of_relay = record.column(u);
  const records::Column& of_process = record.column(y);
  if (&of_relay == &of_process) {
    throw InputError(error::bad_usage, {.file = record.file()},
                     fmt::format("The relay and the process value are one column, {}.", of_process.name),
                     "name the column that the relay wrote, and that of the process value.");
  }
  RelayExperiment result = relay_experiment(of_relay.values, of_process.values, record.sample_time(), record.file());
  result.u_unit = of_relay.unit;
  result.y_unit = of_process.unit;
  return result;
}

}  // namespace hysteron
