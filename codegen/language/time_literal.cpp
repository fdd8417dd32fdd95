#include "codegen/language/time_literal.hpp"

#include <array>
#include <charconv>
#include <string>

namespace hysteron::language {
namespace {

struct TimeUnit {
  std::string_view name;
  double nanoseconds;
};
/// The largest first. Longer names stand behind shorter ones that begin alike only where the order of sizes allows:
/// a name ends at the next digit.
constexpr std::array units_of_time{TimeUnit{"d", 86400e9}, TimeUnit{"h", 3600e9}, TimeUnit{"m", 60e9},
                                   TimeUnit{"s", 1e9},     TimeUnit{"ms", 1e6},   TimeUnit{"us", 1e3},
                                   TimeUnit{"ns", 1.0}};

char lower(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

}  // namespace

std::optional<double> nanoseconds_of_time(std::string_view written) {
  std::string text;
  for (const char c : written) {
    text += c == '_' ? std::string() : std::string(1, lower(c));
  }
  const bool negative = text.starts_with('-');
  const char* at = text.data() + (negative ? 1 : 0);
  const char* const end = text.data() + text.size();
  double nanoseconds = 0.0;
  std::size_t next = 0;
  while (at != end) {
    double number = 0.0;
    const auto [stop, problem] = std::from_chars(at, end, number, std::chars_format::fixed);
    const bool fraction = std::string_view(at, static_cast<std::size_t>(stop - at)).find('.') != std::string_view::npos;
    const char* name_end = stop;
    while (name_end != end && *name_end >= 'a' && *name_end <= 'z') {
      ++name_end;
    }
    const std::string_view name(stop, static_cast<std::size_t>(name_end - stop));
    while (next < units_of_time.size() && units_of_time[next].name != name) {
      ++next;
    }
    if (problem != std::errc{} || next == units_of_time.size() || (fraction && name_end != end)) {
      return std::nullopt;
    }
    nanoseconds += number * units_of_time[next++].nanoseconds;
    at = name_end;
  }
  if (text.empty() || next == 0) {
    return std::nullopt;
  }
  return negative ? -nanoseconds : nanoseconds;
}

bool milliseconds_of_time(std::string_view text, double& milliseconds) {
  const std::optional<double> nanoseconds = nanoseconds_of_time(text);
  milliseconds = nanoseconds.value_or(0.0) / 1e6;
  return nanoseconds.has_value();
}

}  // namespace hysteron::language
