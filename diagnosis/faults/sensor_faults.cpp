#include "diagnosis/faults/sensor_faults.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "diagnosis/noise/spectrum.hpp"

namespace hysteron::diagnosis {
namespace {

using records::RowRange;
using Kind = SensorFault::Kind;

constexpr std::size_t shortest_stuck = 20;
/// Up to three readings in a row are glitches.
constexpr std::size_t shortest_dropout = 4;
/// A leap is so many times the next one, and a single one so many times.
constexpr double far_beyond = 3.0;
constexpr double single_beyond = 5.0;
/// Noise of so many steps of the sensor lets no reading stand for long.
constexpr double noisy_steps = 3.0;
/// A sound reading would have shown what is so many times the noise.
constexpr double shown_by_noise = 3.0;
/// A sensor that stands at so many other readings does so by itself, wherever the machine rests.
constexpr std::ptrdiff_t fewest_standstills = 5;
/// A sensor whose readings stand for this share of the time does so by itself, as a switch does.
constexpr double often = 0.5;

class FaultFinder {
 public:
  FaultFinder(std::span<const double> measured, std::span<const double> model, std::span<const std::size_t> left_out)
      : measured_(measured), model_(model), counts_(measured.size(), true) {
    for (const std::size_t row : left_out) {
      counts_[row] = false;
    }
  }

  std::vector<SensorFault> run() {
    if (measured_.size() < 2 * shortest_stuck) {
      return {};
    }
    find_runs();
    noisy_ = is_noisy();
    find_dropouts();
    find_stuck();
    if (result_.empty()) {
      find_leap();
    }
    std::ranges::sort(result_, {}, [](const SensorFault& one) { return one.rows.first; });
    return std::move(result_);
  }

 private:
  void find_runs() {
    std::size_t first = 0;
    for (std::size_t k = 1; k <= measured_.size(); ++k) {
      if (k < measured_.size() && measured_[k] == measured_[k - 1]) {
        continue;
      }
      if (k - first >= shortest_dropout) {
        runs_.push_back({.first = first, .last = k});
      }
      first = k;
    }
  }

  [[nodiscard]] double leap_at(std::size_t row) const {
    return row > 0 && row < measured_.size() ? std::abs(measured_[row] - measured_[row - 1]) : 0.0;
  }

  /// Whether consecutive second differences oppose each other, as those of noise do and those of a motion do not, and
  /// are larger than the sensor's step makes them.
  [[nodiscard]] bool is_noisy() {
    std::vector<double> sizes;
    double together = 0.0;
    double alone = 0.0;
    double step = std::numeric_limits<double>::infinity();
    double before = 0.0;
    std::size_t in_a_row = 0;
    for (std::size_t k = 1; k + 1 < measured_.size(); ++k) {
      const bool level = measured_[k] == measured_[k - 1] && measured_[k] == measured_[k + 1];
      if (level || !counts_[k - 1] || !counts_[k] || !counts_[k + 1]) {
        in_a_row = 0;
        continue;
      }
      if (const double size = leap_at(k); size > 0.0) {
        step = std::min(step, size);
      }
      const double second = measured_[k + 1] - 2.0 * measured_[k] + measured_[k - 1];
      sizes.push_back(std::abs(second));
      if (++in_a_row > 1) {
        together += second * before;
        alone += 0.5 * (second * second + before * before);
      }
      before = second;
    }
    constexpr double opposed = -0.3;  // of white noise −2/3, of what moves smoothly nearly 1
    noise_ = deviation_by_second_differences(std::move(sizes));
    return together < opposed * alone && noise_ >= noisy_steps * step;
  }

  /// The largest leap that counts, but for those at the ends of the runs of one reading.
  [[nodiscard]] double largest_leap_beside(double reading) const {
    double largest = 0.0;
    for (std::size_t k = 1; k < measured_.size(); ++k) {
      if (counts_[k] && counts_[k - 1] && measured_[k] != reading && measured_[k - 1] != reading) {
        largest = std::max(largest, leap_at(k));
      }
    }
    return largest;
  }

  /// Whether most of what is not this reading stands still as well.
  [[nodiscard]] bool stands_often_beside(double reading) const {
    std::size_t standing = 0;
    std::size_t others = 0;
    for (const double value : measured_) {
      others += value != reading ? 1 : 0;
    }
    for (const RowRange& run : runs_) {
      standing += measured_[run.first] != reading ? run.size() : 0;
    }
    return static_cast<double>(standing) > often * static_cast<double>(others);
  }

  [[nodiscard]] bool stands_elsewhere(double reading) const {
    return std::ranges::count_if(runs_, [&](const RowRange& run) { return measured_[run.first] != reading; }) >=
           fewest_standstills;
  }

  /// Whether the model, while a reading stands, goes further than the noise would hide.
  [[nodiscard]] bool model_moves_in(const RowRange& run) const {
    if (run.last > model_.size()) {
      return true;
    }
    const auto [low, high] = std::ranges::minmax(model_.subspan(run.first, run.size()));
    return high - low > shown_by_noise * noise_;
  }

  [[nodiscard]] bool model_leaps_at(std::size_t row, double size) const {
    return row > 0 && row < model_.size() && std::abs(model_[row] - model_[row - 1]) > 0.5 * size;
  }

  void find_dropouts() {
    for (const RowRange& run : runs_) {
      const double entry = leap_at(run.first);
      const double exit = leap_at(run.last);
      const bool inside = run.first > 0 && run.last < measured_.size();
      const double size = inside ? std::min(entry, exit) : std::max(entry, exit);
      // At an end of the record the readings that it leaps back to are not there: the sensor has to be a noisy one.
      if (!(size > 0.0) || (!inside && !noisy_)) {
        continue;
      }
      const double reading = measured_[run.first];
      if (size > far_beyond * largest_leap_beside(reading) && !stands_often_beside(reading) &&
          !model_leaps_at(run.first, size) && !model_leaps_at(run.last, size)) {
        result_.push_back({.kind = Kind::Dropout, .rows = run, .value = reading});
      }
    }
  }

  void find_stuck() {
    const auto [low, high] = std::ranges::minmax(measured_);
    for (const RowRange& run : runs_) {
      const double reading = measured_[run.first];
      const bool known =
          std::ranges::any_of(result_, [&](const SensorFault& one) { return one.rows.first == run.first; });
      if (!known && noisy_ && run.size() >= shortest_stuck && reading != low && reading != high &&
          !stands_elsewhere(reading) && model_moves_in(run)) {
        result_.push_back({.kind = Kind::Stuck, .rows = run, .value = reading});
      }
    }
  }

  void find_leap() {
    std::size_t at = 0;
    double largest = 0.0;
    double next = 0.0;
    for (std::size_t k = 1; k < measured_.size(); ++k) {
      if (!counts_[k] || !counts_[k - 1]) {
        continue;
      }
      const double size = leap_at(k);
      if (size > largest) {
        next = largest;
        largest = size;
        at = k;
      } else {
        next = std::max(next, size);
      }
    }
    double fastest = next;
    for (std::size_t k = 1; k < model_.size(); ++k) {
      if (!counts_[k] || !counts_[k - 1]) {
        continue;  // nobody asked the model there
      }
      fastest = std::max(fastest, std::abs(model_[k] - model_[k - 1]));
    }
    if (fastest > 0.0 && largest > single_beyond * fastest) {
      result_.push_back({.kind = Kind::Leap, .rows = {.first = at, .last = at + 1}, .value = largest});
    }
  }

  std::span<const double> measured_;
  std::span<const double> model_;
  std::vector<bool> counts_;
  std::vector<RowRange> runs_{};
  bool noisy_ = false;
  double noise_ = 0.0;  ///< of readings that move, see is_noisy()
  std::vector<SensorFault> result_{};
};

}  // namespace

std::vector<SensorFault> find_sensor_faults(std::span<const double> measured, std::span<const double> model,
                                            std::span<const std::size_t> left_out) {
  return FaultFinder(measured, model, left_out).run();
}

}  // namespace hysteron::diagnosis
