// Texts within a run file: lengths of time, and what fires a trace.
#include <algorithm>
#include <cmath>
#include <vector>

#include "runtime/config/run_config.hpp"
#include "support/names.hpp"
#include "support/numbers.hpp"

namespace hysteron::runtime {
namespace {

std::optional<std::size_t> index_of(std::string_view name, const std::vector<ProgramSignal>& signals) {
  for (std::size_t i = 0; i < signals.size(); ++i) {
    if (equal_ignoring_case(signals[i].name, name)) {
      return i;
    }
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::int64_t> parse_duration(std::string_view text) {
  const auto unit = text.find_first_not_of("0123456789.");
  if (unit == std::string_view::npos) {
    return std::nullopt;
  }
  const auto number = parse_number(text.substr(0, unit));
  const auto name = text.substr(unit);
  const double scale = name == "ns"    ? 1.0
                       : name == "us"  ? 1e3
                       : name == "ms"  ? 1e6
                       : name == "s"   ? 1e9
                       : name == "min" ? 60e9
                       : name == "h"   ? 3600e9
                       : name == "d"   ? 86'400e9
                                       : 0.0;
  const double value = number.value * scale;
  if (number.status != NumberStatus::Finite || scale == 0.0 || value > 1e18 || value != std::round(value)) {
    return std::nullopt;
  }
  return static_cast<std::int64_t>(value);
}

std::optional<TraceTrigger> parse_trigger(std::string_view text, const ProgramShape& shape) {
  if (equal_ignoring_case(text, "fault")) {
    return TraceTrigger{};
  }
  const auto sign = text.find_first_of("<>");
  if (sign == std::string_view::npos) {
    return std::nullopt;
  }
  const auto trimmed = [](std::string_view part) {
    const auto begin = std::min(part.find_first_not_of(' '), part.size());
    return part.substr(begin, part.find_last_not_of(' ') + 1 - begin);
  };
  const auto name = trimmed(text.substr(0, sign));
  const auto level = parse_number(trimmed(text.substr(sign + 1)));
  const auto output = index_of(name, shape.outputs);
  const auto input = index_of(name, shape.inputs);
  if (level.status != NumberStatus::Finite || (!output && !input)) {
    return std::nullopt;
  }
  return TraceTrigger{.signal = output ? TraceTrigger::Signal::output : TraceTrigger::Signal::input,
                      .index = output ? *output : *input,
                      .above = text[sign] == '>',
                      .level = level.value};
}

}  // namespace hysteron::runtime
