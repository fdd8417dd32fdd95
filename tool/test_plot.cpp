#include "tool/test_plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace hysteron::tool {
namespace {

constexpr std::size_t steps_round = 4;
constexpr std::size_t plot_width = 33;

struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  void take(double value) {
    if (std::isfinite(value)) {
      low = std::min(low, value);
      high = std::max(high, value);
    }
  }

  /// The place of a value on a line; of infinities, the ends.
  [[nodiscard]] std::size_t place(double value) const {
    const double share = high > low ? (value / 2 - low / 2) / (high / 2 - low / 2) : 0.5;  // halves: no overflow
    return static_cast<std::size_t>(std::lround(std::clamp(share, 0.0, 1.0) * static_cast<double>(plot_width - 1)));
  }
};

void mark(std::string& line, double value, const Range& range, char sign) {
  if (!std::isnan(value)) {
    char& place = line[range.place(value)];
    place = place == ' ' ? sign : '*';
  }
}

}  // namespace

std::string plot_of(std::size_t step, std::span<const double> time, const std::map<std::size_t, double>& expected,
                    const Signal& got) {
  const std::size_t first = step - std::min(step, steps_round);
  const std::size_t last = std::min(got.size() - 1, step + steps_round);
  Range range;
  for (std::size_t k = first; k <= last; ++k) {
    range.take(got[k]);
    if (const auto found = expected.find(k); found != expected.end()) {
      range.take(found->second);
    }
  }
  std::string text =
      fmt::format("{:>10} {:>12} {:>12} {:>12}   x expected, o got, * both\n", "step", "t", "expected", "got");
  for (std::size_t k = first; k <= last; ++k) {
    std::string line(plot_width, ' ');
    std::string wanted;
    if (const auto found = expected.find(k); found != expected.end()) {
      wanted = fmt::format("{:.6g}", found->second);
      mark(line, found->second, range, 'x');
    }
    mark(line, got[k], range, 'o');
    text += fmt::format("{} {:>8} {:>12.6g} {:>12} {:>12.6g}  |{}|\n", k == step ? '>' : ' ', k, time[k], wanted,
                        got[k], line);
  }
  return text;
}

}  // namespace hysteron::tool
