#include "plots/axis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace hysteron::plots {

void Reach::take(double value) {
  if (std::isfinite(value)) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
}

void Reach::take(std::span<const double> values) {
  for (const double value : values) {
    take(value);
  }
}

Reach Reach::with_room(double share) const {
  if (is_empty()) {
    return {.low = 0.0, .high = 1.0};
  }
  // Below a few steps of the last bit there is nothing between the ends that a plot could show.
  const double size = std::max(std::abs(low), std::abs(high));
  if (!(high - low > 1e-12 * size)) {
    const double room = size > 0.0 ? 0.5 * size : 1.0;
    return {.low = low - room, .high = high + room};
  }
  const double room = share * (high - low);
  return {.low = low - room, .high = high + room};
}

std::vector<double> round_numbers(const Reach& reach, int most) {
  const double length = reach.high - reach.low;
  const double rough = std::isfinite(length) ? length / most : reach.high / most - reach.low / most;
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  const double digit = rough / power;
  const double step = power * (digit <= 1.0 ? 1.0 : (digit <= 2.0 ? 2.0 : (digit <= 5.0 ? 5.0 : 10.0)));
  std::vector<double> numbers;
  if (!std::isfinite(step) || !(step > 0.0)) {
    return numbers;
  }
  const double first = std::ceil(reach.low / step - 1e-9);
  for (int k = 0; k <= 2 * most && (first + k) * step <= reach.high + 1e-9 * step; ++k) {
    numbers.push_back((first + k) * step + 0.0);  // no -0
  }
  constexpr int finest = 8;
  return numbers.size() < 2 && most < finest ? round_numbers(reach, most + 1) : numbers;
}

std::string tick_text(double value, double step) {
  constexpr int usual = 6;
  const double size = std::abs(value);
  const int needed = size > 0.0 && step > 0.0 ? static_cast<int>(std::ceil(std::log10(size / step))) + 1 : 0;
  return fmt::format("{:.{}g}", value, std::clamp(needed, usual, 15));
}

}  // namespace hysteron::plots
