#include "records/time/packed_clock.hpp"

#include <cmath>
#include <cstddef>

namespace hysteron::records {

std::optional<std::vector<double>> unpacked_clock(std::span<const double> numbers) {
  constexpr double jump = 40.0;  // from 59 to 100
  std::vector<double> seconds;
  seconds.reserve(numbers.size());
  bool jumps = false;
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    const double hours = std::floor(numbers[k] / 10000.0);
    const double minutes = std::floor(numbers[k] / 100.0) - 100.0 * hours;
    const double rest = numbers[k] - 10000.0 * hours - 100.0 * minutes;
    if (!(hours >= 0.0 && hours < 24.0 && minutes < 60.0 && rest < 60.0)) {
      return std::nullopt;
    }
    seconds.push_back(3600.0 * hours + 60.0 * minutes + rest);
    if (k > 0 && !(seconds[k] - seconds[k - 1] > 0.0 && seconds[k] - seconds[k - 1] < jump)) {
      return std::nullopt;
    }
    jumps = jumps || (k > 0 && numbers[k] - numbers[k - 1] > jump);
  }
  return jumps ? std::optional(std::move(seconds)) : std::nullopt;
}

}  // namespace hysteron::records
