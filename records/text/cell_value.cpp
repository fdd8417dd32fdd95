#include "records/text/cell_value.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <initializer_list>
#include <optional>
#include <string>

#include "records/text/characters.hpp"
#include "records/text/time_cell.hpp"
#include "support/names.hpp"
#include "support/numbers.hpp"
#include "support/trimmed.hpp"

namespace hysteron::records {
namespace {

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
  // Instruments say "overload" and "no value" so (SCPI 1999, 7.2.1.4).
  const double size = std::abs(number.value);
  switch (number.status) {
    case NumberStatus::Finite:
      if (size == 9.9e37 || size == 9.91e37) {
        value.kind = CellKind::NotFinite;
        return value;
      }
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

/// 1'234.5 and 1 234,5, with the marks that are never decimal ones: an apostrophe, and blanks of every width. Groups of
/// three digits behind one to three; nothing where the text is no such number.
std::optional<CellValue> as_grouped_number(std::string_view text, std::initializer_list<std::string_view> marks,
                                           std::string_view decimals) {
  std::string plain;
  std::size_t group = 0;   // digits since the last mark
  std::size_t groups = 0;  // marks so far
  const bool leads_with_zero = text.find_first_of("123456789") > text.find('0');
  bool behind_point = false;
  char point = '\0';
  // 0.001 is no thousand.
  const auto ends_well = [&] { return groups == 0 ? group >= 1 && group <= 3 && !leads_with_zero : group == 3; };
  for (std::size_t at = 0; at < text.size();) {
    const auto* const mark =
        std::ranges::find_if(marks, [&](std::string_view one) { return text.substr(at).starts_with(one); });
    if (is_digit(text[at])) {
      ++group;
      plain += text[at++];
    } else if (at == 0 && (text[at] == '-' || text[at] == '+')) {
      plain += text[at++];
    } else if (!behind_point && mark != marks.end() && ends_well()) {
      group = 0;
      ++groups;
      at += mark->size();
    } else if (!behind_point && decimals.find(text[at]) != std::string_view::npos && groups > 0 && ends_well()) {
      behind_point = true;
      plain += '.';
      point = text[at++];
    } else {
      return std::nullopt;
    }
  }
  if (groups == 0 || (!behind_point && !ends_well())) {
    return std::nullopt;
  }
  CellValue value = as_number(plain);
  value.digits = text;
  value.has_comma = point == ',';
  value.has_point = point == '.';
  return value.kind == CellKind::Number ? std::optional(value) : std::nullopt;
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
  std::size_t length = number_length(text);
  if (length < text.size()) {
    text = behind_arrival(text);
    length = number_length(text);
  }
  // The minus of typography, and the dashes that word processors and spreadsheets put in its place.
  for (const std::string_view minus : {"\xE2\x88\x92", "\xE2\x80\x93", "\xE2\x80\x90", "\xE2\x80\x91"}) {
    if (text.starts_with(minus) && text.size() > minus.size() && is_digit(text[minus.size()]) &&
        number_length(text.substr(minus.size())) == text.size() - minus.size()) {
      value = as_number(text.substr(minus.size()));
      value.number = -value.number;
      value.stamp = {-value.stamp.whole, -value.stamp.fraction};
      return value;
    }
  }
  if (length == text.size()) {
    value = as_number(text);
    const auto time = value.kind == CellKind::TwoMarks ? time_cell(text) : std::nullopt;  // 03.06.2024
    return time.value_or(value);
  }
  if (is_one_of(text, {"nan", "-nan", "+nan", "nan(ind)", "-nan(ind)", "inf", "-inf", "+inf", "infinity", "-infinity",
                       "null", "na", "n/a", "#n/a", "none", "1.#inf", "-1.#inf", "1.#qnan", "-1.#ind"})) {
    value.kind = CellKind::NotFinite;
    return value;
  }
  if (is_one_of(text, {"true", "on", "wahr", "vrai"})) {
    value.kind = CellKind::Truth;
    value.number = 1.0;
    return value;
  }
  if (is_one_of(text, {"false", "off", "falsch", "faux"})) {
    value.kind = CellKind::Truth;
    return value;
  }
  if (const auto time = time_cell(text)) {
    return *time;
  }
  if (const auto number =
          as_grouped_number(text, {"'", "\xE2\x80\x99", " ", "\xC2\xA0", "\xE2\x80\xAF", "\xE2\x80\x89"}, ".,")) {
    return *number;
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

CellValue number_with_mark(std::string_view text, char decimal) {
  text = trimmed(text);
  CellValue value = cell_value(text);
  const bool other = decimal == '.' ? value.has_comma : value.has_point;
  if (value.kind != CellKind::TwoMarks && !(value.kind == CellKind::Number && other)) {
    return value;
  }
  const auto grouped = as_grouped_number(text, {decimal == '.' ? "," : "."}, std::string_view(&decimal, 1));
  return grouped.value_or(CellValue{.kind = CellKind::TwoMarks});
}

bool says_missing(std::string_view text) {
  return is_one_of(
      text,
      {"-",       "--",       "---",      "ol",        "+ol",          "-ol",           "over",          "ovl",
       "ovld",    "overload", "overflow", "underflow", "\xE2\x88\x9E", "-\xE2\x88\x9E", "+\xE2\x88\x9E", "#value!",
       "#div/0!", "#ref!",    "#num!",    "bad",       "no data",      "nodata",        "missing",       "invalid"});
}

}  // namespace hysteron::records
