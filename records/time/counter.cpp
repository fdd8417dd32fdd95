#include "records/time/counter.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>

#include "records/time/time_grid.hpp"

namespace hysteron::records {

std::optional<std::vector<double>> unwrapped(const std::vector<double>& values) {
  if (std::ranges::adjacent_find(values, std::greater_equal{}) == values.end()) {
    return std::nullopt;
  }
  std::vector<double> result;
  const double usual = median_step(values);
  for (const double size : {65536.0, 4294967296.0}) {
    result.clear();
    double turns = 0.0;
    for (std::size_t k = 0; k < values.size(); ++k) {
      const double step = k == 0 ? usual : values[k] - values[k - 1];
      turns += step < -0.5 * size ? 1.0 : 0.0;
      result.push_back(values[k] - values.front() + turns * size);
      if (values[k] >= size || values[k] < 0.0 || values[k] != std::floor(values[k])) {
        turns = 0.0;
        break;
      }
    }
    const auto uneven = [&](double a, double b) { return !(b - a > 0.5 * usual && b - a < 1.5 * usual); };
    if (turns > 0.0 && usual > 0.0 && std::ranges::adjacent_find(result, uneven) == result.end()) {
      return result;
    }
  }
  return std::nullopt;
}

}  // namespace hysteron::records
