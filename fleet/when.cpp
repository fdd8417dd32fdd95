#include "fleet/when.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "records/text/cell_value.hpp"

namespace hysteron::fleet {
namespace {

// Seconds of nine and ten digits: 1973-03-03 to 2286-11-20. Years and dates without marks have fewer digits,
// milliseconds since 2001 have more.
constexpr double earliest = 1e8;
constexpr double latest = 1e10;

constexpr long seconds_a_day = 86400;

/// 2026-: no other date begins with four digits and a hyphen.
bool begins_with_year(std::string_view text) {
  return text.size() > 4 && text[4] == '-' &&
         std::ranges::all_of(text.substr(0, 4), [](char c) { return c >= '0' && c <= '9'; });
}

}  // namespace

std::optional<double> seconds_of(std::string_view text) {
  using records::CellKind;
  const records::CellValue cell = records::cell_value(text);
  const double seconds = static_cast<double>(cell.stamp.whole) + cell.stamp.fraction;
  if (cell.kind == CellKind::Number && !cell.has_comma && cell.unit.empty() && seconds >= earliest &&
      seconds < latest) {
    return seconds;
  }
  if ((cell.kind == CellKind::Date || cell.kind == CellKind::DateTime) && begins_with_year(text)) {
    return seconds;
  }
  return std::nullopt;
}

std::string date_text(double seconds) {
  if (!std::isfinite(seconds)) {
    return "";
  }
  const auto whole = static_cast<long>(std::floor(seconds));
  const long day = whole >= 0 ? whole / seconds_a_day : (whole - seconds_a_day + 1) / seconds_a_day;
  const std::chrono::year_month_day date{std::chrono::sys_days(std::chrono::days(day))};
  const long minute = (whole - seconds_a_day * day) / 60;
  const std::string text = fmt::format("{:04}-{:02}-{:02}", static_cast<int>(date.year()),
                                       static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()));
  return minute == 0 ? text : fmt::format("{} {:02}:{:02}", text, minute / 60, minute % 60);
}

}  // namespace hysteron::fleet
