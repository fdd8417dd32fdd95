#include "tool/output_record.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "support/errors.hpp"
#include "support/numbers.hpp"

namespace hysteron::tool {

namespace {

/// A whole number is written out: a DINT, of which a float does not hold every one, has no shorter text.
std::string float_text(double value) {
  constexpr double of_dint = 2147483648.0;
  const bool whole = std::abs(value) <= of_dint && value == std::floor(value);
  return whole ? number_text(value) : number_text(static_cast<float>(value));
}

}  // namespace

std::string output_csv(std::span<const double> time, const std::vector<std::string>& names,
                       const std::vector<Signal>& columns, bool float32) {
  std::string text = "t";
  for (const std::string& name : names) {
    text += ',' + name;
  }
  text += '\n';
  text.reserve(text.size() + time.size() * (columns.size() + 1) * 12);
  for (std::size_t k = 0; k < time.size(); ++k) {
    text += number_text(time[k]);
    for (const Signal& column : columns) {
      text += ',';
      text += float32 ? float_text(column[k]) : number_text(column[k]);
    }
    text += '\n';
  }
  return text;
}

void check_finite(const std::vector<Place>& places, std::span<const double> time, const std::vector<std::string>& names,
                  const std::vector<Signal>& columns, Diagnostics& diagnostics) {
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const auto finite = [](double value) { return std::isfinite(value); };
    const auto first = std::find_if_not(columns[i].begin(), columns[i].end(), finite);
    if (first == columns[i].end()) {
      continue;
    }
    const auto step = static_cast<std::size_t>(first - columns[i].begin());
    const auto count =
        columns[i].size() - static_cast<std::size_t>(std::count_if(first, columns[i].end(), finite)) - step;
    diagnostics.error(
        error::output_not_finite, places.empty() ? Place{} : places[i],
        fmt::format("{} is {} at step {} (t = {} s){}.", names[i], std::isnan(*first) ? "not a number" : "infinite",
                    step, number_text(time[step]), count > 1 ? fmt::format(", and in {} steps in all", count) : ""),
        "look for a division by 0, a root or logarithm of a negative number, or a sum that grows without bound; "
        "--trace shows the signals inside.");
  }
}

}  // namespace hysteron::tool
