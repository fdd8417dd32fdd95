#include "records/time/time_grid.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <vector>

#include "support/median.hpp"

namespace hysteron::records {
namespace {

double power_of_ten(int exponent) {
  return std::pow(10.0, exponent);
}

/// The value rounded to a number of significant decimal digits.
double rounded(double value, int digits) {
  char text[64];
  const auto written = std::to_chars(text, text + sizeof text, value, std::chars_format::scientific, digits - 1);
  std::from_chars(text, written.ptr, value);
  return value;
}

/// Least squares over t_k − t_0 = a + b·k: the slope b = Σ(k − k̄)(t_k − t_0) / Σ(k − k̄)².
double slope(std::span<const double> time) {
  const auto count = static_cast<double>(time.size());
  const double middle = 0.5 * (count - 1.0);
  double sum = 0.0;
  for (std::size_t k = 0; k < time.size(); ++k) {
    sum += (static_cast<double>(k) - middle) * (time[k] - time.front());
  }
  return sum / (count * (count * count - 1.0) / 12.0);
}

std::vector<double> steps_of(std::span<const double> time) {
  std::vector<double> steps(time.empty() ? 0 : time.size() - 1);
  for (std::size_t k = 1; k < time.size(); ++k) {
    steps[k - 1] = time[k] - time[k - 1];
  }
  return steps;
}

double from_grid(std::span<const double> time, double sample_time, std::size_t k) {
  return time[k] - time.front() - static_cast<double>(k) * sample_time;
}

/// The row farthest from the middle of the deviations.
std::size_t farthest_row(std::span<const double> time, double sample_time, const Deviations& off) {
  std::size_t farthest = 0;
  double most = -1.0;
  for (std::size_t k = 1; k < time.size(); ++k) {
    if (const double deviation = std::abs(from_grid(time, sample_time, k) - 0.5 * (off.low + off.high));
        deviation > most) {
      most = deviation;
      farthest = k;
    }
  }
  return farthest;
}

}  // namespace

double plainest_near(double sample_time, double radius) {
  for (int digits = 1; digits < 17; ++digits) {
    const double seconds = rounded(sample_time, digits);
    if (std::abs(seconds - sample_time) <= radius) {
      return seconds;
    }
    const double from_rate = 1.0 / rounded(1.0 / sample_time, digits);
    if (std::abs(from_rate - sample_time) <= radius) {
      return from_rate;
    }
  }
  return sample_time;
}

double median_step(std::span<const double> time) {
  return median(steps_of(time));
}

Deviations deviations_from_grid(std::span<const double> time, double sample_time) {
  Deviations result;
  for (std::size_t k = 0; k < time.size(); ++k) {
    const double off = from_grid(time, sample_time, k);
    result.low = std::min(result.low, off);
    result.high = std::max(result.high, off);
  }
  return result;
}

void PrintedResolution::take(std::string_view number) {
  int exponent = 0;
  if (const auto mark = number.find_first_of("eE"); mark != std::string_view::npos) {
    auto digits = number.substr(mark + 1);
    if (digits.starts_with('+')) {
      digits.remove_prefix(1);
    }
    std::from_chars(digits.data(), digits.data() + digits.size(), exponent);
    number = number.substr(0, mark);
  }
  int decimals = 0;
  int significant = 0;
  bool behind_point = false;
  for (const char c : number) {
    if (c == '.') {
      behind_point = true;
    } else if (c >= '0' && c <= '9') {
      decimals += behind_point ? 1 : 0;
      significant += c != '0' || significant > 0 ? 1 : 0;
    }
  }
  finest_exponent_ = std::min(finest_exponent_, std::clamp(std::clamp(exponent, -400, 400) - decimals, -400, 400));
  significant_digits_ = std::max(significant_digits_, significant);
}

double PrintedResolution::quantum(double time) const {
  const double finest = scale_ * power_of_ten(finest_exponent_);
  if (time == 0.0 || significant_digits_ == 0) {
    return finest;
  }
  const int leading = static_cast<int>(std::floor(std::log10(std::abs(time / scale_))));
  return std::max(finest, scale_ * power_of_ten(leading + 1 - significant_digits_));
}

TimeGrid find_time_grid(std::span<const double> time, const PrintedResolution& resolution) {
  const std::vector<double> steps = steps_of(time);
  const double usual = median(steps);

  const double largest = std::max(std::abs(time.front()), std::abs(time.back()));
  const double rounding = 4.0 * std::numeric_limits<double>::epsilon() * largest;
  const double printed = resolution.quantum(largest);
  const bool coarse = printed > 0.1 * usual;
  const auto fault_at = [&](std::size_t row) {
    return TimeFault{
        .row = row, .step = steps[row - 1], .usual = usual, .reversed = !(steps[row - 1] > 0.0), .coarse = coarse};
  };
  for (std::size_t row = 1; row < time.size(); ++row) {
    if (!(steps[row - 1] > 0.0) || !std::isfinite(steps[row - 1])) {
      return {.fault = fault_at(row)};
    }
  }

  const auto equal_steps = static_cast<std::size_t>(std::count_if(
      steps.begin(), steps.end(), [&](double step) { return std::abs(step - usual) <= 0.01 * printed + rounding; }));
  const bool exact = equal_steps == steps.size() || (coarse && 10 * equal_steps >= 9 * steps.size());
  // Few rows in coarse times could be many a grid: 0, 1 and 3 s as well as 0, 1.5 and 3.
  constexpr std::size_t fewest_rounded_rows = 10;
  if (coarse && !exact && time.size() < fewest_rounded_rows) {
    const auto other =
        std::ranges::find_if(steps, [&](double step) { return std::abs(step - usual) > 0.01 * printed + rounding; });
    return {.fault = fault_at(static_cast<std::size_t>(other - steps.begin()) + 1)};
  }
  const double taken_away = exact ? 0.0 : printed;

  // What the printed digits leave open: an end may be off by a good half of the last one, the slope by both ends.
  const double radius = (1.25 * taken_away + rounding) / static_cast<double>(steps.size());
  const double fitted = exact ? usual : slope(time);
  const double plain = plainest_near(fitted, exact ? rounding : radius);
  if (!(plain > 0.0) || !std::isfinite(plain)) {
    return {.fault = fault_at(1)};
  }
  const double allowed = 1.25 * taken_away + 0.02 * plain + rounding;
  TimeGrid grid{.sample_time = plain};
  auto off = deviations_from_grid(time, plain);
  if (off.span() > allowed) {
    if (const auto off_fitted = deviations_from_grid(time, fitted); off_fitted.span() < off.span()) {
      off = off_fitted;
      grid.sample_time = fitted;
    }
  }
  for (std::size_t row = 1; row < time.size(); ++row) {
    if (steps[row - 1] < 0.5 * usual || steps[row - 1] > 1.5 * usual) {
      grid.fault = fault_at(row);
      return grid;
    }
  }
  if (off.span() > allowed) {
    // The first step that stands out, or else the row that lies farthest from the grid.
    const auto stands_out = std::find_if(steps.begin(), steps.end(), [&](double step) {
      return std::abs(step - usual) > 2.0 * taken_away + 0.02 * usual + rounding;
    });
    const bool any = stands_out != steps.end();
    grid.fault = fault_at(any ? static_cast<std::size_t>(stands_out - steps.begin()) + 1
                              : farthest_row(time, grid.sample_time, off));
    grid.fault->off = any ? 0.0 : off.span();
  }
  return grid;
}

}  // namespace hysteron::records
