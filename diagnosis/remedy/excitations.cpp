#include "diagnosis/remedy/excitations.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>

namespace hysteron::diagnosis {
namespace {

constexpr double two_pi = 2.0 * std::numbers::pi;

/// A command under construction: it keeps to the rate, and says in words what it does.
class Command {
 public:
  Command(const InputLimits& limits, std::string title, std::string shows) : limits_(limits) {
    result_.title = std::move(title);
    result_.shows = std::move(shows);
    result_.values.push_back(limits.start);
    rest_ = std::clamp(0.0, limits.low, limits.high);
  }

  /// The level at a share of the range.
  [[nodiscard]] double level(double share) const { return std::lerp(limits_.low, limits_.high, share); }
  [[nodiscard]] double rest() const { return rest_; }
  [[nodiscard]] double last() const { return result_.values.back(); }

  void hold(double seconds) {
    const auto count = samples(seconds);
    result_.values.insert(result_.values.end(), count, last());
    say(fmt::format("hold {}", value(last())), seconds_of(count));
  }

  /// A straight line, at this rate or as fast as may be.
  void ramp(double to, double rate) {
    const double from = last();
    if (from == to) {
      return;
    }
    const auto count = straight(to, rate);
    say(fmt::format("ramp from {:.4g} to {}", from, value(to)), seconds_of(count));
  }
  void step(double to) { ramp(to, limits_.rate); }

  /// Up and down between two levels, from where the command stands, which is one of them or is driven to first.
  void triangles(double low, double high, double rate, int cycles) {
    step(low);
    std::size_t count = 0;
    for (int cycle = 0; cycle < cycles; ++cycle) {
      count += straight(high, rate);
      count += straight(low, rate);
    }
    say(fmt::format("{} triangle{} between {:.4g} and {} at {:.4g} {}/s", cycles, cycles == 1 ? "" : "s", low,
                    value(high), rate, unit()),
        seconds_of(count));
  }

  /// Whole periods that begin at the middle.
  void sine(double middle, double amplitude, double frequency, int cycles) {
    step(middle);
    const auto count = samples(cycles / frequency);
    for (std::size_t k = 1; k <= count; ++k) {
      const double time = static_cast<double>(k) * limits_.sample_time;
      result_.values.push_back(middle + amplitude * std::sin(two_pi * frequency * time));
    }
    say(fmt::format("{} periods of {:.4g} Hz, amplitude {} about {:.4g}", cycles, frequency, value(amplitude), middle),
        seconds_of(count));
  }

  void append(std::span<const double> values, std::string what) {
    result_.values.insert(result_.values.end(), values.begin(), values.end());
    say(std::move(what), seconds_of(values.size()));
  }

  /// Nothing where it is too long.
  [[nodiscard]] std::optional<Excitation> finish() {
    if (result_.values.size() > longest_command || result_.values.size() < 16) {
      return std::nullopt;
    }
    return std::move(result_);
  }

 private:
  [[nodiscard]] std::string unit() const { return limits_.unit.empty() ? "a unit" : limits_.unit; }
  [[nodiscard]] std::string value(double number) const {
    return limits_.unit.empty() ? fmt::format("{:.4g}", number) : fmt::format("{:.4g} {}", number, limits_.unit);
  }
  /// At least one, and never more than a command may have.
  [[nodiscard]] std::size_t samples(double seconds) const {
    const double count = std::ceil(seconds / limits_.sample_time - 1e-6);
    return static_cast<std::size_t>(std::clamp(count, 1.0, 2.0 * static_cast<double>(longest_command)));
  }
  [[nodiscard]] double seconds_of(std::size_t count) const { return static_cast<double>(count) * limits_.sample_time; }
  void say(std::string what, double seconds) {
    result_.steps.emplace_back(std::move(what), fmt::format("{:.4g} s", seconds));
  }
  std::size_t straight(double to, double rate) {
    const double from = last();
    const auto count = samples(std::abs(to - from) / std::min(rate, limits_.rate));
    for (std::size_t k = 1; k <= count; ++k) {
      result_.values.push_back(k == count ? to
                                          : std::lerp(from, to, static_cast<double>(k) / static_cast<double>(count)));
    }
    return count;
  }

  const InputLimits& limits_;
  Excitation result_{};
  double rest_ = 0.0;
};

class Catalogue {
 public:
  explicit Catalogue(const InputLimits& limits)
      : limits_(limits),
        span_(limits.high - limits.low),
        total_(std::min(limits.duration, 0.95 * static_cast<double>(longest_command) * limits.sample_time)) {}

  std::vector<Excitation> all() {
    staircase();
    loops();
    rates();
    amplitudes();
    biases();
    multisine();
    slow_ramp(1.0, "slow ramp, both ways");
    slow_ramp(0.05, "very slow ramp over 5 % of the range, both ways");
    dwell();
    return std::move(found_);
  }

 private:
  [[nodiscard]] Command command(std::string title, std::string shows) const {
    return {limits_, std::move(title), std::move(shows)};
  }
  void keep(Command& command) {
    if (auto done = command.finish()) {
      found_.push_back(std::move(*done));
    }
  }
  [[nodiscard]] double ts() const { return limits_.sample_time; }

  void staircase() {
    Command one = command("staircase up and down, with short and long dwells",
                          "creep, relaxation and drifts: the same level twice, rest at zero");
    const double brief = std::max(0.1, 4.0 * ts());
    const double lengthy = std::min(100.0, 0.3 * total_);
    if (lengthy < 4.0 * ts()) {
      return;
    }
    const double middling = std::min(std::sqrt(brief * lengthy), 0.08 * total_);
    one.hold(std::min(brief, 0.05 * total_));
    const std::array<std::pair<double, double>, 6> plan{std::pair{0.5, middling},
                                                        {1.0, lengthy},
                                                        {0.5, middling},
                                                        {-1.0, lengthy},
                                                        {1.0, std::min(brief, 0.05 * total_)},
                                                        {-1.0, middling}};
    for (const auto& [share, seconds] : plan) {
      one.step(share < 0.0 ? one.rest() : one.level(share));
      one.hold(seconds);
    }
    keep(one);
  }

  void loops() {
    Command one = command("concentric loops from 100 % to 1 %, then nested closing loops",
                          "backlash, friction, asymmetry, return-point memory: loops of every size");
    const double rate = std::min(limits_.rate, 10.0 * span_ / (0.5 * total_));
    for (const double size : {1.0, 0.5, 0.2, 0.1, 0.05, 0.02, 0.01}) {
      one.triangles(one.level(0.5 - 0.5 * size), one.level(0.5 + 0.5 * size), rate, 1);
    }
    for (const double share : {0.0, 1.0, 0.3, 0.8, 0.4, 0.7, 0.5, 0.6, 0.5, 0.7, 0.4, 0.8, 0.3, 1.0, 0.0}) {
      one.ramp(one.level(share), rate);
    }
    keep(one);
  }

  void rates() {
    Command one = command("triangles of four rates at two amplitudes",
                          "rate dependence, lag and relaxation: rates over up to three decades");
    const double fastest = std::min(limits_.rate, span_ / (20.0 * ts()));
    const double slowest = std::max(fastest * 1e-3, 3.5 * span_ / total_);
    if (slowest >= fastest) {
      return;
    }
    const double ratio = std::cbrt(slowest / fastest);
    for (const double size : {1.0, 0.2}) {
      double rate = fastest;
      for (int k = 0; k < 4; ++k, rate *= ratio) {
        one.triangles(one.level(0.5 - 0.5 * size), one.level(0.5 + 0.5 * size), rate, 1);
      }
    }
    keep(one);
  }

  void amplitudes() {
    Command one = command("one frequency with amplitudes 1 : 2 : 4",
                          "a rate limit and a lag: the rate grows, the frequency does not");
    const double largest = 0.5 * span_;
    const double frequency = std::min(limits_.rate / (two_pi * largest), 0.05 / ts());
    if (12.0 / frequency > total_) {
      return;
    }
    for (const double part : {0.25, 0.5, 1.0}) {
      one.sine(one.level(0.5), part * largest, frequency, 4);
    }
    keep(one);
  }

  void biases() {
    Command one = command("equal minor loops at three biases, on the way up and down",
                          "bias dependence, curve shape and static nonlinearity: the same loop elsewhere");
    const double rate = std::min(limits_.rate, 6.0 * span_ / (0.5 * total_));
    one.ramp(one.level(0.0), rate);
    const auto minor = [&](double share, double sign) {
      one.ramp(one.level(share + 0.1 * sign), rate);
      for (int cycle = 0; cycle < 2; ++cycle) {
        one.ramp(one.level(share - 0.1 * sign), rate);
        one.ramp(one.level(share + 0.1 * sign), rate);
      }
    };
    for (const double share : {0.15, 0.5, 0.85}) {
      minor(share, 1.0);
    }
    one.ramp(one.level(1.0), rate);
    for (const double share : {0.85, 0.5, 0.15}) {
      minor(share, -1.0);
    }
    one.ramp(one.level(0.0), rate);
    keep(one);
  }

  /// Lines with the phases of Schroeder, each of the same rate, so that none hides the others.
  void multisine() {
    Command one = command("multisine", "delay, lag and resonance: the phase up to the highest frequency");
    constexpr int lines = 16;
    const auto period = static_cast<std::size_t>(std::min(0.5 * total_ / ts(), 4096.0));
    if (period < 64) {
      return;
    }
    const int highest = static_cast<int>(period / 5);
    std::vector<int> harmonics;
    for (int k = 0; k < lines; ++k) {
      const int harmonic = static_cast<int>(std::lround(2.0 * std::pow(0.5 * highest, k / (lines - 1.0))));
      if (harmonics.empty() || harmonic > harmonics.back()) {
        harmonics.push_back(harmonic);
      }
    }
    std::vector<double> wave(2 * period);
    for (std::size_t i = 0; i < wave.size(); ++i) {
      for (std::size_t k = 0; k < harmonics.size(); ++k) {
        const double order = static_cast<double>(k) + 1.0;
        const double phase = std::numbers::pi * order * order / static_cast<double>(harmonics.size());
        const double angle =
            two_pi * static_cast<double>(harmonics[k]) * static_cast<double>(i) / static_cast<double>(period);
        wave[i] += std::sin(angle + phase) / std::sqrt(harmonics[k]);
      }
    }
    const auto [least, most] = std::ranges::minmax(wave);
    double steepest = std::abs(wave.front() - wave.back());
    for (std::size_t i = 1; i < wave.size(); ++i) {
      steepest = std::max(steepest, std::abs(wave[i] - wave[i - 1]));
    }
    const double size = std::min(0.98 * span_ / (most - least), 0.98 * limits_.rate * ts() / steepest);
    const double middle = one.level(0.5) - 0.5 * size * (most + least);
    for (double& value : wave) {
      value = middle + size * value;
    }
    one.step(wave.front());
    one.append(wave, fmt::format("2 periods of {} sines from {:.4g} to {:.4g} Hz, between {:.4g} and {:.4g}{}{}",
                                 harmonics.size(), harmonics.front() / (static_cast<double>(period) * ts()),
                                 harmonics.back() / (static_cast<double>(period) * ts()), middle + size * least,
                                 middle + size * most, limits_.unit.empty() ? "" : " ", limits_.unit));
    keep(one);
  }

  void slow_ramp(double size, std::string title) {
    Command one = command(std::move(title), "quantisation, backlash and noise: every level once, slowly");
    const double seconds = 0.4 * total_;
    one.step(one.level(0.5 - 0.5 * size));
    const double rate = std::min(limits_.rate, size * span_ / seconds);
    one.ramp(one.level(0.5 + 0.5 * size), rate);
    one.ramp(one.level(0.5 - 0.5 * size), rate);
    keep(one);
  }

  void dwell() {
    Command one =
        command("a step and a dwell", "disturbances, ringing and drift: what moves while nothing is asked to");
    const double seconds = std::min(0.45 * total_, 100.0);
    one.step(one.level(0.75));
    one.hold(seconds);
    one.step(one.rest());
    one.hold(seconds);
    keep(one);
  }

  const InputLimits& limits_;
  double span_;
  double total_;
  std::vector<Excitation> found_{};
};

}  // namespace

std::vector<Excitation> excitations(const InputLimits& limits) {
  if (!(limits.high > limits.low) || !(limits.rate > 0.0) || !(limits.sample_time > 0.0)) {
    return {};
  }
  return Catalogue(limits).all();
}

}  // namespace hysteron::diagnosis
