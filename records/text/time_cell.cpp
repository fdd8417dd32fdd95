#include "records/text/time_cell.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <string>

#include "records/text/characters.hpp"
#include "support/names.hpp"
#include "support/trimmed.hpp"

namespace hysteron::records {
namespace {

constexpr std::int64_t of_a_day = 86400;  ///< s
/// As many of its zeros as a length of time has decimals: which digits were printed tells how finely.
constexpr std::string_view zeros = "000000000000000000";

/// Of the words of all languages.
constexpr bool is_word_letter(char c) {
  return is_letter(c) || static_cast<unsigned char>(c) >= 0x80;
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

std::string_view take_letters(std::string_view& text) {
  const auto length = static_cast<std::size_t>(std::ranges::find_if_not(text, is_word_letter) - text.begin());
  const std::string_view word = text.substr(0, length);
  text.remove_prefix(length);
  return word;
}

void skip(std::string_view& text, std::string_view blanks) {
  text.remove_prefix(std::min(text.find_first_not_of(blanks), text.size()));
}

// ---- dates ----------------------------------------------------------------------------------------------------------

struct Day {
  std::int64_t days = 0;  ///< since 1970-01-01
  bool is_ambiguous = false;
};

std::optional<Day> day_of(int year, int month, int day, bool is_ambiguous = false) {
  const std::chrono::year_month_day date{std::chrono::year(year), std::chrono::month(static_cast<unsigned>(month)),
                                         std::chrono::day(static_cast<unsigned>(day))};
  if (!date.ok()) {
    return std::nullopt;
  }
  return Day{.days = std::chrono::sys_days(date).time_since_epoch().count(), .is_ambiguous = is_ambiguous};
}

/// 2024-06-03, 2024/06/03, 03.06.2024, 6/3/2024. With slashes the month comes first unless it cannot.
std::optional<Day> take_date_of_digits(std::string_view& text) {
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
  std::optional<Day> result;
  if (width == 4) {
    result = day_of(*first, *second, *third);
  } else if (third_width == 4 || (third_width == 2 && mark != '-')) {
    const int year = third_width == 4 ? *third : 2000 + *third;
    const bool day_first = mark == '.' || *first > 12;
    result = day_of(year, day_first ? *second : *first, day_first ? *first : *second,
                    mark != '.' && *first <= 12 && *second <= 12 && *first != *second);
  }
  if (result) {
    text = rest;
  }
  return result;
}

/// 20240603, where a time of day follows: alone it is a number.
std::optional<Day> take_basic_date(std::string_view& text) {
  const auto end = static_cast<std::size_t>(std::ranges::find_if_not(text, is_digit) - text.begin());
  if (end != 8 || text.size() < 15 || std::string_view("T_- ").find(text[8]) == std::string_view::npos) {
    return std::nullopt;
  }
  std::string_view digits = text.substr(0, 8);
  const int year = *take_digits(digits, 4);
  const int month = *take_digits(digits, 2);
  const auto result = day_of(year, month, *take_digits(digits, 2));
  if (result) {
    text.remove_prefix(8);
  }
  return result;
}

/// 1 to 12; 0 where the word is no month. English and German, by three letters or more.
int month_of(std::string_view word) {
  constexpr std::array<std::string_view, 12> english{"january",   "february", "march",    "april",
                                                     "may",       "june",     "july",     "august",
                                                     "september", "october",  "november", "december"};
  constexpr std::array<std::string_view, 12> german{"januar",    "februar", "m\xC3\xA4rz", "april",
                                                    "mai",       "juni",    "juli",        "august",
                                                    "september", "oktober", "november",    "dezember"};
  for (const auto* const names : {&english, &german}) {
    for (std::size_t m = 0; m < names->size(); ++m) {
      const std::string_view name = names->at(m);
      if (word.size() >= 3 && word.size() <= name.size() && equal_ignoring_case(word, name.substr(0, word.size()))) {
        return static_cast<int>(m) + 1;
      }
    }
  }
  return 0;
}

/// Monday, Mon, Mo; Dienstag.
bool is_weekday(std::string_view word) {
  return word.size() >= 2 && month_of(word) == 0 &&
         is_one_of(word.substr(0, 2), {"mo", "tu", "we", "th", "fr", "sa", "su", "di", "mi", "do", "so"});
}

/// 03-Jun-2024, 3 June 2024, Jun 3, 2024, and Jun 3, of which the year stands behind the time of day.
struct NamedDate {
  int year = 0;  ///< 0 where it is to come
  int month = 0;
  int day = 0;  ///< 0 where there is no such date
};
NamedDate take_named_date(std::string_view& text) {
  constexpr std::string_view joints = " -/.,";
  std::string_view rest = text;
  NamedDate result;
  if (!rest.empty() && is_word_letter(rest.front())) {
    std::string_view word = take_letters(rest);
    if (is_weekday(word)) {
      skip(rest, joints);
      word = take_letters(rest);
    }
    result.month = month_of(word);
    if (!word.empty() && result.month == 0) {
      return {};
    }
    skip(rest, joints);
  }
  const auto day = take_digits(rest, 2);
  if (!day || (!rest.empty() && is_digit(rest.front()))) {
    return {};
  }
  result.day = *day;
  if (result.month == 0) {
    skip(rest, joints);
    result.month = month_of(take_letters(rest));
    if (result.month == 0) {
      return {};
    }
  }
  std::string_view year_text = rest;
  skip(year_text, joints);
  const std::size_t before = year_text.size();
  const auto year = take_digits(year_text, 4);
  const std::size_t width = before - year_text.size();
  if (year && (width == 4 || (width == 2 && (year_text.empty() || year_text.front() != ':')))) {
    result.year = width == 2 ? 2000 + *year : *year;
    rest = year_text;
  }
  text = rest;
  return result;
}

// ---- times of day ---------------------------------------------------------------------------------------------------

struct TimeOfDay {
  Stamp stamp{};
  std::string_view digits{};
};

/// The digits of a fraction; 0.001 of 001.
void take_fraction(std::string_view& rest, TimeOfDay& result) {
  const auto length = static_cast<std::size_t>(std::ranges::find_if_not(rest, is_digit) - rest.begin());
  result.digits = rest.substr(0, length);
  double scale = 1.0;
  for (const char c : result.digits.substr(0, 18)) {
    result.stamp.fraction = 10.0 * result.stamp.fraction + (c - '0');
    scale *= 10.0;
  }
  result.stamp.fraction /= scale;
  rest.remove_prefix(length);
}

bool has_fraction(std::string_view rest, std::string_view marks) {
  return rest.size() >= 2 && marks.find(rest.front()) != std::string_view::npos && is_digit(rest[1]);
}

/// 10:00, 10:00:00, 10:00:00.001, also with a comma, a colon or a semicolon before the fraction; 12:30.5 of minutes and
/// seconds, as spreadsheets shorten them; AM and PM.
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
  if (has_fraction(rest, ".,")) {  // 12:30.5
    rest.remove_prefix(1);
    take_fraction(rest, result);
    if (*hours > 59 || *minutes > 59 || !trimmed(rest).empty()) {
      return std::nullopt;
    }
    result.stamp.whole = 60LL * *hours + *minutes;
    text = rest;
    return result;
  }
  if (rest.size() >= 3 && rest.front() == ':' && is_digit(rest[1])) {
    rest.remove_prefix(1);
    seconds = *take_digits(rest, 2);
    result.digits = "0";
    if (rest.starts_with("::")) {  // of Serial Studio
      rest.remove_prefix(1);
    }
    if (has_fraction(rest, ".,:;")) {
      rest.remove_prefix(1);
      take_fraction(rest, result);
    }
  }
  int hour = *hours;
  std::string_view behind = trimmed(rest);
  for (const std::string_view half : {"am", "pm", "a.m.", "p.m.", "a. m.", "p. m."}) {
    if (equal_ignoring_case(behind.substr(0, half.size()), half)) {
      hour = hour % 12 + (half.front() == 'p' ? 12 : 0);
      rest = behind.substr(half.size());
      break;
    }
  }
  if (hour > 24 || *minutes > 59 || seconds > 60) {
    return std::nullopt;
  }
  result.stamp.whole = 3600LL * hour + 60LL * *minutes + seconds;
  text = rest;
  return result;
}

/// 10.00.00,001 and 100000.001: without colons, and sure only where seconds have a fraction, or a date stands before.
std::optional<TimeOfDay> take_clock_without_colons(std::string_view& text, bool behind_date) {
  std::string_view rest = text;
  const bool with_points = rest.size() > 5 && rest[2] == '.' && rest[5] == '.';
  std::array<int, 3> parts{};
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const std::size_t before = rest.size();
    const auto part = take_digits(rest, 2);
    if (!part || before - rest.size() != 2 || (with_points && i < 2 && !take(rest, "."))) {
      return std::nullopt;
    }
    parts.at(i) = *part;
  }
  TimeOfDay result{.digits = "0"};
  const bool fraction = has_fraction(rest, ".,");
  if ((!with_points && !behind_date) || (with_points && !fraction) || parts[0] > 24 || parts[1] > 59 || parts[2] > 60) {
    return std::nullopt;
  }
  if (fraction) {
    rest.remove_prefix(1);
    take_fraction(rest, result);
  }
  result.stamp.whole = 3600LL * parts[0] + 60LL * parts[1] + parts[2];
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

// ---- lengths of time ------------------------------------------------------------------------------------------------

/// T#1s5ms, TIME#12.5ms, LTIME#1ms0us.
std::optional<CellValue> length_of_time(std::string_view text) {
  const auto hash = text.find('#');
  if (hash == std::string_view::npos || !is_one_of(text.substr(0, hash), {"T", "TIME", "LT", "LTIME"})) {
    return std::nullopt;
  }
  struct Part {
    std::string_view unit;
    std::int64_t over, under;
    std::size_t decimals;
  };
  constexpr auto units = std::to_array<Part>({{"d", of_a_day, 1, 0},
                                              {"h", 3600, 1, 0},
                                              {"m", 60, 1, 0},
                                              {"s", 1, 1, 0},
                                              {"ms", 1, 1000, 3},
                                              {"us", 1, 1'000'000, 6},
                                              {"ns", 1, 1'000'000'000, 9}});
  std::string_view rest = text.substr(hash + 1);
  const bool negative = take(rest, "-");
  CellValue value{.kind = CellKind::Clock};
  std::size_t decimals = 0;
  do {
    std::int64_t whole = 0;
    std::size_t count = 0;
    while (!rest.empty() && count < 12 && (is_digit(rest.front()) || (rest.front() == '_' && count > 0))) {
      whole = rest.front() == '_' ? whole : 10 * whole + (rest.front() - '0');
      ++count;
      rest.remove_prefix(1);
    }
    TimeOfDay behind_point;
    if (has_fraction(rest, ".")) {
      rest.remove_prefix(1);
      take_fraction(rest, behind_point);
    }
    const std::string_view name = take_letters(rest);
    (void)take(rest, "_");
    const auto* const unit =
        std::ranges::find_if(units, [&](const Part& one) { return equal_ignoring_case(one.unit, name); });
    if (count == 0 || unit == units.end()) {
      return std::nullopt;
    }
    value.stamp.whole += whole / unit->under * unit->over;
    value.stamp.fraction += (static_cast<double>(whole % unit->under) + behind_point.stamp.fraction) *
                            static_cast<double>(unit->over) / static_cast<double>(unit->under);
    decimals = std::max(decimals, unit->decimals + behind_point.digits.size());
  } while (!rest.empty());
  value.stamp = negative ? Stamp{-value.stamp.whole, -value.stamp.fraction} : value.stamp;
  value.digits = decimals == 0 ? std::string_view("0") : zeros.substr(0, decimals);
  return value;
}

/// 0 days 00:00:00.001, as pandas writes a length of time.
std::optional<std::int64_t> take_days(std::string_view& text) {
  std::string_view rest = text;
  const auto days = take_digits(rest, 9);
  skip(rest, " ");
  if (!days || !is_one_of(take_letters(rest), {"day", "days"})) {
    return std::nullopt;
  }
  skip(rest, ", +");
  text = rest;
  return *days;
}

/// DT#, DATE#, TOD# and their long forms.
std::string_view without_prefix(std::string_view text) {
  const auto hash = text.find('#');
  return hash != std::string_view::npos &&
                 is_one_of(text.substr(0, hash), {"DT", "DATE_AND_TIME", "LDT", "LDATE_AND_TIME", "D", "DATE", "LD",
                                                  "LDATE", "TOD", "TIME_OF_DAY", "LTOD", "LTIME_OF_DAY"})
             ? text.substr(hash + 1)
             : text;
}

}  // namespace

std::optional<CellValue> time_cell(std::string_view text) {
  if (const auto length = length_of_time(text)) {
    return length;
  }
  text = without_prefix(text);
  CellValue value;
  std::string_view rest = text;
  std::int64_t whole = 0;
  const auto days = take_days(rest);
  whole += of_a_day * days.value_or(0);
  auto day = days ? std::nullopt : take_date_of_digits(rest);
  day = days || day ? day : take_basic_date(rest);
  const NamedDate named = days || day ? NamedDate{} : take_named_date(rest);
  const bool year_to_come = named.day != 0 && named.year == 0;
  if (named.year != 0) {
    day = day_of(named.year, named.month, named.day);
    if (!day) {
      return std::nullopt;
    }
  }
  if (day && trimmed(rest).empty()) {
    value.kind = CellKind::Date;
    value.stamp.whole = of_a_day * day->days;
    value.is_ambiguous = day->is_ambiguous;
    return value;
  }
  if (day && rest.starts_with("/ ")) {  // 2024/06/03/ 10:00:00::001 of Serial Studio
    rest.remove_prefix(1);
  }
  if ((day || year_to_come) && !take(rest, "T t_,-")) {
    return std::nullopt;
  }
  rest = trimmed(rest);
  auto clock = take_clock(rest);
  clock = clock ? clock : take_clock_without_colons(rest, day.has_value());
  if (!clock) {
    return std::nullopt;
  }
  if (year_to_come) {  // Jun  3 10:00:00.001 2024, and 10:00:00 CEST 2024 of Java
    skip(rest, " ");
    if (!rest.empty() && is_letter(rest.front())) {  // one zone for all rows does not count
      rest.remove_prefix(rest.rfind(' ') == std::string_view::npos ? 0 : rest.rfind(' ') + 1);
    }
    const std::size_t before = rest.size();
    const auto year = take_digits(rest, 4);
    day = year && before - rest.size() == 4 ? day_of(*year, named.month, named.day) : std::nullopt;
    if (!day) {
      return std::nullopt;
    }
  }
  const auto zone = take_zone(rest);
  if (!zone) {
    return std::nullopt;
  }
  value.kind = day ? CellKind::DateTime : CellKind::Clock;
  value.stamp = clock->stamp;
  value.stamp.whole += (day ? of_a_day * day->days : whole) + *zone;
  value.digits = clock->digits;
  // 00:58 alone: hours and minutes, or minutes and seconds.
  value.is_ambiguous = day ? day->is_ambiguous : clock->digits.empty();
  return value;
}

std::string_view behind_arrival(std::string_view text) {
  if (const auto arrow = text.find(" -> "); arrow != std::string_view::npos) {
    std::string_view clock = text.substr(0, arrow);
    if (take_clock(clock) && clock.empty()) {
      return trimmed(text.substr(arrow + 4));
    }
  }
  // 2024-06-03 10:00:00.001 1.5
  if (const auto blank = text.rfind(' '); blank != std::string_view::npos && blank > 10 && is_digit(text.front()) &&
                                          is_digit(text.back()) && !time_cell(text)) {
    const auto before = time_cell(trimmed(text.substr(0, blank)));
    if (before && before->kind == CellKind::DateTime) {
      return trimmed(text.substr(blank + 1));
    }
  }
  const auto closing = text.starts_with('[') ? text.find(']') : std::string_view::npos;
  const std::string_view behind = closing == std::string_view::npos ? text : trimmed(text.substr(closing + 1));
  return !behind.empty() && closing != std::string_view::npos && time_cell(trimmed(text.substr(1, closing - 1)))
             ? behind
             : text;
}

}  // namespace hysteron::records
