// docs/reference/run-file.md, from the keys as they are declared.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "runtime/config/run_keys.hpp"
#include "support/numbers.hpp"

namespace hysteron::runtime {
namespace {

std::string kind_text(const RunKey& key) {
  constexpr std::array<const char*, 7> names{"true or false", "text",         "text", "list of texts",
                                             "number",        "whole number", "time"};
  if (key.kind != KeyKind::choice) {
    return names.at(static_cast<std::size_t>(key.kind));
  }
  std::string list;
  for (const std::string_view word : key.words) {
    list += (list.empty() ? "`\"" : ", `\"") + std::string(word) + "\"`";
  }
  return list;
}

std::string range_text(const RunKey& key) {
  const auto text_of = [&](double value) {
    return key.kind == KeyKind::time ? time_text(value) : fmt::format("{}", number_text(value));
  };
  std::string range = key.low == above_zero ? "above 0"
                      : std::isfinite(key.low) && std::isfinite(key.high)
                          ? text_of(key.low) + " to " + text_of(key.high)
                          : "";
  if (!key.also.empty()) {
    range += "; " + std::string(key.also);
  }
  return range;
}

std::string default_text(const RunKey& key) {
  const bool words = key.otherwise.starts_with('(');
  return words ? std::string(key.otherwise.substr(1, key.otherwise.size() - 2))
               : "`" + std::string(key.otherwise) + "`";
}

}  // namespace

std::string time_text(double nanoseconds) {
  constexpr double us = 1e3;
  constexpr double ms = 1e6;
  constexpr double s = 1e9;
  constexpr double day = 86'400.0 * s;
  if (nanoseconds >= day && std::fmod(nanoseconds, day) == 0.0) {
    return number_text(nanoseconds / day) + "d";
  }
  constexpr std::array<std::pair<double, const char*>, 4> units{{{s, "s"}, {ms, "ms"}, {us, "us"}, {1.0, "ns"}}};
  const auto* const found = std::ranges::find_if(units, [&](const auto& one) { return nanoseconds >= one.first; });
  const auto& [size, name] = found == units.end() ? units.back() : *found;
  return number_text(nanoseconds / size) + name;
}

std::string short_time_text(double nanoseconds) {
  if (nanoseconds <= 0.0) {
    return "0ns";
  }
  const double digits = 2.0 - std::floor(std::log10(nanoseconds));
  const double steps = std::pow(10.0, std::abs(digits));  // a power that is a whole number, for exact decimals
  return time_text(digits > 0.0 ? std::round(nanoseconds * steps) / steps : std::round(nanoseconds / steps) * steps);
}

std::string run_file_page() {
  std::string page =
      "# The run file\n\n"
      "What `hysteron serve --config RUN.toml` reads, in [TOML](https://toml.io): how a diagram is run. Every key but "
      "the\n"
      "safe values may be left out. A time is a text with one of `ns`, `us`, `ms`, `s`, `min`, `h`, `d`, as `\"5ms\"`. "
      "Names of inputs and\n"
      "outputs are the diagram's, without regard to case. The page is printed from `runtime/config/run_keys.cpp`, by "
      "which\n"
      "the reader goes as well; `RunKeys.ThePageIsCurrent` in `test_runtime` holds it, and prints it anew.\n";
  for (const RunTable& table : run_tables()) {
    page +=
        fmt::format("\n## `{}`\n\n{}\n\n| key | type | range | default | meaning |\n| --- | --- | --- | --- | --- |\n",
                    table.name, table.meaning);
    for (const RunKey& key : table.keys) {
      page += fmt::format("| `{}` | {} | {} | {} | {} |\n", key.name, kind_text(key), range_text(key),
                          default_text(key), key.meaning);
    }
  }
  return page;
}

}  // namespace hysteron::runtime
