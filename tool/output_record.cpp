#include "tool/output_record.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "codegen/graph/port_t.hpp"
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

std::string output_csv(const Graph& graph, std::span<const double> time, const std::vector<std::string>& names,
                       const std::vector<Signal>& columns, bool float32) {
  std::string text(time_heading(graph));
  for (const std::string& name : names) {
    text += ',';
    text += signal_heading(name);
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

}  // namespace hysteron::tool
