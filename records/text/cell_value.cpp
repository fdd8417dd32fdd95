#include "records/text/cell_value.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <optional>
#include <string>

#include "support/names.hpp"
#include "support/numbers.hpp"
#include "support/trimmed.hpp"

namespace hysteron::records {
namespace {

constexpr bool is_digit(char c) {
  return c >= '0' && c <= '9';
}
constexpr bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

/// Takes up to `most` digits off the front; nothing where there is none.
std::optional<int> take_digits(std::string_view& text, std::size_t most) {
  std::size_t count = 0;
  int value = 0;
  while (count < most && count < text.size() && is_digit(text[count])) {
    value = 10 * value + (text[count] - '0');
    ++count;
  }
  if (count == 0) {
    return std::nullopt;
  }
  text.remove_prefix(count);
  return value;
}

bool take(std::string_view& text, std::string_view any_of) {
  if (text.empty() || any_of.find(text.front()) == std::string_view::npos) {
    return false;
  }
  text.remove_prefix(1);
  return true;
}

struct Day {
  std::int64_t days = 0;  ///< since 1970-01-01
  bool is_ambiguous = false;
};

/// 2024-06-03, 2024/06/03, 03.06.2024, 6/3/2024. With slashes the month comes first unless it cannot.
std::optional<Day> take_date(std::string_view& text) {
  std::string_view rest = text;
  const std::size_t before = rest.size();
  const auto first = take_digits(rest, 4);
  const std::size_t width = before - rest.size();
  if (!first || rest.empty()) {
    return std::nullopt;
  }
  const char mark = rest.front();
  if (!take(rest, "-/.")) {
    return std::nullopt;
  }
  const auto second = take_digits(rest, 2);
  if (!second || !take(rest, std::string_view(&mark, 1))) {
    return std::nullopt;
  }
  const std::size_t at_third = rest.size();
  const auto third = take_digits(rest, 4);
  const std::size_t third_width = at_third - rest.size();
  if (!third) {
    return std::nullopt;
  }
  int year = 0;
  int month = 0;
  int day = 0;
  Day result;
  if (width == 4) {
    year = *first;
    month = *second;
    day = *third;
  } else if (third_width == 4 || (third_width == 2 && mark != '-')) {
    year = third_width == 4 ? *third : 2000 + *third;
    const bool day_first = mark == '.' || *first > 12;
    day = day_first ? *first : *second;
    month = day_first ? *second : *first;
    result.is_ambiguous = mark != '.' && *first <= 12 && *second <= 12 && *first != *second;
  } else {
    return std::nullopt;
  }
  const std::chrono::year_month_day date{std::chrono::year(year), std::chrono::month(static_cast<unsigned>(month)),
                                         std::chrono::day(static_cast<unsigned>(day))};
  if (!date.ok()) {
    return std::nullopt;
  }
  result.days = std::chrono::sys_days(date).time_since_epoch().count();
  text = rest;
  return result;
}

struct TimeOfDay {
  Stamp stamp{};
  std::string_view digits{};
};

/// 10:00, 10:00:00, 10:00:00.001, also with a comma, a colon or a semicolon before the fraction; AM and PM.
std::optional<TimeOfDay> take_clock(std::string_view& text) {
  std::string_view rest = text;
  const auto hours = take_digits(rest, 2);
  if (!hours || !take(rest, ":")) {
    return std::nullopt;
  }
  const std::size_t before_minutes = rest.size();
  const auto minutes = take_digits(rest, 2);
  if (!minutes || before_minutes - rest.size() != 2) {
    return std::nullopt;
  }
  int seconds = 0;
  TimeOfDay result;
  if (rest.size() >= 3 && rest.front() == ':' && is_digit(rest[1])) {
    rest.remove_prefix(1);
    seconds = *take_digits(rest, 2);
    result.digits = "0";
    if (rest.size() >= 2 && is_digit(rest[1]) && take(rest, ".,:;")) {
      const std::size_t length = static_cast<std::size_t>(std::ranges::find_if_not(rest, is_digit) - rest.begin());
      result.digits = rest.substr(0, length);
      double scale = 1.0;
      for (const char c : result.digits.substr(0, 18)) {
        result.stamp.fraction = 10.0 * result.stamp.fraction + (c - '0');
        scale *= 10.0;
      }
      result.stamp.fraction /= scale;
      rest.remove_prefix(length);
    }
  }
  int hour = *hours;
  std::string_view behind = trimmed(rest);
  if (behind.size() >= 2 && is_one_of(behind.substr(0, 2), {"AM", "PM"})) {
    hour = hour % 12 + (equal_ignoring_case(behind.substr(0, 2), "PM") ? 12 : 0);
    rest = behind.substr(2);
  }
  if (hour > 24 || *minutes > 59 || seconds > 60) {
    return std::nullopt;
  }
  result.stamp.whole = 3600LL * hour + 60LL * *minutes + seconds;
  text = rest;
  return result;
}

/// Z, +02:00, -0700, UTC; taken off. Nothing where something else stands there.
std::optional<std::int64_t> take_zone(std::string_view& text) {
  std::string_view rest = trimmed(text);
  if (rest.empty()) {
    text = rest;
    return 0;
  }
  if (is_one_of(rest, {"Z", "UTC", "GMT"})) {
    text = {};
    return 0;
  }
  const bool east = rest.front() == '+';
  if (!take(rest, "+-")) {
    return std::nullopt;
  }
  const auto hours = take_digits(rest, 2);
  (void)take(rest, ":");
  const auto minutes = rest.empty() ? std::optional<int>(0) : take_digits(rest, 2);
  if (!hours || !minutes || !rest.empty()) {
    return std::nullopt;
  }
  text = rest;
  return (east ? -1 : 1) * (3600LL * *hours + 60LL * *minutes);
}

std::optional<CellValue> as_time(std::string_view text) {
  CellValue value;
  std::string_view rest = text;
  const auto day = take_date(rest);
  if (day && trimmed(rest).empty()) {
    value.kind = CellKind::Date;
    value.stamp.whole = 86400 * day->days;
    value.is_ambiguous = day->is_ambiguous;
    return value;
  }
  if (day && !take(rest, "T t_")) {
    return std::nullopt;
  }
  rest = trimmed(rest);
  const auto clock = take_clock(rest);
  if (!clock) {
    return std::nullopt;
  }
  const auto zone = take_zone(rest);
  if (!zone) {
    return std::nullopt;
  }
  value.kind = day ? CellKind::DateTime : CellKind::Clock;
  value.stamp = clock->stamp;
  value.stamp.whole += (day ? 86400 * day->days : 0) + *zone;
  value.digits = clock->digits;
  // 00:58 alone: hours and minutes, or minutes and seconds.
  value.is_ambiguous = day ? day->is_ambiguous : clock->digits.empty();
  return value;
}

/// The integral digits and the fraction apart, so that 1717408800.001 keeps its last digit.
Stamp stamp_of(std::string_view number, double value) {
  if (number.find_first_of("eE") != std::string_view::npos) {
    return {.fraction = value};
  }
  const bool negative = number.starts_with('-');
  if (negative || number.starts_with('+')) {
    number.remove_prefix(1);
  }
  const auto point = std::min(number.find('.'), number.size());
  Stamp result;
  const auto read = std::from_chars(number.data(), number.data() + point, result.whole);
  if (point > 0 && read.ec != std::errc()) {
    return {.fraction = value};
  }
  if (point < number.size()) {
    (void)std::from_chars(number.data() + point, number.data() + number.size(), result.fraction);
  }
  return negative ? Stamp{-result.whole, -result.fraction} : result;
}

/// The characters of a number at the front of a text, with its sign, marks and exponent.
std::size_t number_length(std::string_view text) {
  std::size_t at = !text.empty() && (text[0] == '-' || text[0] == '+') ? 1 : 0;
  std::size_t digits = 0;
  while (at < text.size() && (is_digit(text[at]) || text[at] == '.' || text[at] == ',')) {
    digits += is_digit(text[at]) ? 1 : 0;
    ++at;
  }
  if (digits == 0) {
    return 0;
  }
  if (at < text.size() && std::string_view("eEdD").find(text[at]) != std::string_view::npos) {
    std::size_t exponent = at + 1;
    exponent += exponent < text.size() && (text[exponent] == '-' || text[exponent] == '+') ? 1 : 0;
    const std::size_t first = exponent;
    while (exponent < text.size() && is_digit(text[exponent])) {
      ++exponent;
    }
    at = exponent > first ? exponent : at;
  }
  return at;
}

CellValue as_number(std::string_view text) {
  CellValue value;
  const auto marks = [&](char mark) { return std::ranges::count(text, mark); };
  if (marks('.') + marks(',') > 1) {
    value.kind = CellKind::TwoMarks;
    return value;
  }
  value.has_comma = marks(',') == 1;
  value.has_point = marks('.') == 1;
  // The text is short: it fits the buffer or is no number that a logger writes.
  std::array<char, 64> buffer{};
  if (text.size() > buffer.size()) {
    return {};
  }
  std::ranges::transform(text, buffer.begin(), [](char c) { return c == ',' ? '.' : c == 'D' || c == 'd' ? 'e' : c; });
  const std::string_view plain(buffer.data(), text.size());
  const ParsedNumber number = parse_number(plain);
  switch (number.status) {
    case NumberStatus::Finite:
      value.kind = CellKind::Number;
      value.number = number.value;
      value.stamp = stamp_of(plain, number.value);
      value.digits = text;
      return value;
    case NumberStatus::OutOfRange:
      value.kind = CellKind::OutOfRange;
      return value;
    default:
      return {};
  }
}

/// A unit behind a number: letters, %, °, µ and what joins them, but no word of several.
bool is_unit(std::string_view text) {
  return !text.empty() && text.find_first_of(" \t,;\"") == std::string_view::npos &&
         (is_letter(text.front()) || text.front() == '%' || static_cast<unsigned char>(text.front()) >= 0x80) &&
         text.size() <= 16;
}

}  // namespace

CellValue cell_value(std::string_view text) {
  CellValue value;
  text = trimmed(text);
  if (text.empty()) {
    value.kind = CellKind::Empty;
    return value;
  }
  // The serial monitor of Arduino puts the time of arrival before each line.
  if (const auto arrow = text.find(" -> "); arrow != std::string_view::npos) {
    std::string_view clock = text.substr(0, arrow);
    if (take_clock(clock) && clock.empty()) {
      text = trimmed(text.substr(arrow + 4));
    }
  }
  const std::size_t length = number_length(text);
  if (length == text.size()) {
    return as_number(text);
  }
  if (is_one_of(text, {"nan", "-nan", "+nan", "nan(ind)", "-nan(ind)", "inf", "-inf", "+inf", "infinity", "-infinity",
                       "null", "na", "n/a", "#n/a", "none", "1.#inf", "-1.#inf", "1.#qnan", "-1.#ind"})) {
    value.kind = CellKind::NotFinite;
    return value;
  }
  if (is_one_of(text, {"true", "on"})) {
    value.kind = CellKind::Truth;
    value.number = 1.0;
    return value;
  }
  if (is_one_of(text, {"false", "off"})) {
    value.kind = CellKind::Truth;
    return value;
  }
  if (const auto time = as_time(text)) {
    return *time;
  }
  const std::string_view behind = text.substr(length);
  if (length > 0 && (behind.front() == ' ' || behind.front() == '%' || behind.starts_with("\xC2\xB0")) &&
      is_unit(trimmed(behind))) {
    value = as_number(text.substr(0, length));
    value.unit = trimmed(behind);
    return value;
  }
  if (const auto colon = text.find_first_of(":="); colon != std::string_view::npos && colon > 0 && length == 0) {
    const std::string_view number = trimmed(text.substr(colon + 1));
    if (number_length(number) == number.size() && !number.empty()) {
      value = as_number(number);
      value.label = trimmed(text.substr(0, colon));
    }
  }
  return value;
}

}  // namespace hysteron::records
