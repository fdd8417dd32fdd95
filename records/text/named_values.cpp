#include "records/text/named_values.hpp"

#include <utility>

#include "records/text/cell_value.hpp"
#include "records/text/characters.hpp"
#include "records/text/time_cell.hpp"
#include "records/text/unit_text.hpp"
#include "support/trimmed.hpp"

namespace hysteron::records {
namespace {

constexpr bool is_blank_character(char c) {
  return c == ' ' || c == '\t';
}

constexpr bool is_of_name(char c) {
  return is_letter(c) || is_digit(c) || std::string_view("_./[]-").find(c) != std::string_view::npos ||
         static_cast<unsigned char>(c) >= 0x80;
}

constexpr bool may_begin_name(char c) {
  return is_letter(c) || c == '_' || c == '/' || static_cast<unsigned char>(c) >= 0x80;
}

/// The end of a number; where there is none, its begin. A comma behind it separates.
std::size_t end_of_number(std::string_view line, std::size_t at) {
  std::size_t end = std::min(line.find_first_not_of("0123456789+-.,eE", at), line.size());
  while (end > at && (line[end - 1] == ',' || !is_value(cell_value(line.substr(at, end - at)).kind))) {
    --end;
  }
  return end;
}

/// The end of a time of day or of a date with one, of one word or two; where there is none, its begin.
std::size_t end_of_time(std::string_view line, std::size_t at) {
  std::size_t end = at;
  for (int words = 1; words <= 2; ++words) {
    end = std::min(line.find_first_of(" \t,;|", std::min(end + 1, line.size())), line.size());
    const auto time = time_cell(trimmed(line.substr(at, end - at)));
    if (time && (time->kind == CellKind::DateTime || (time->kind == CellKind::Clock && !time->digits.empty()))) {
      return end;
    }
  }
  return at;
}

bool ends_value(std::string_view line, std::size_t at) {
  return at >= line.size() || is_blank_character(line[at]) || line[at] == ',' || line[at] == ';' || line[at] == '|';
}

/// A value and the unit behind it: 1.5, 1.5V, 1.5 V, true, "a word", and behind = any word at all.
bool take_value(std::string_view line, std::size_t& at, char joint, NamedValue& pair) {
  if (at < line.size() && line[at] == '"') {
    const auto closing = line.find('"', at + 1);
    if (closing == std::string_view::npos) {
      return false;
    }
    pair.value = {.begin = at + 1, .end = closing};
    at = closing + 1;
    return ends_value(line, at);
  }
  if (const std::size_t end = end_of_time(line, at); end > at) {
    pair.value = {.begin = at, .end = end};
    at = end;
    return true;
  }
  const std::size_t end = end_of_number(line, at);
  if (end > at) {
    pair.value = {.begin = at, .end = end};
    const std::size_t unit = behind_blanks(line, end);
    const std::size_t behind = std::min(line.find_first_of(" \t,;|", unit), line.size());
    if (unit < behind && is_known_unit(line.substr(unit, behind - unit))) {
      pair.unit = {.begin = unit, .end = behind};
      at = behind;
      return true;
    }
    if (ends_value(line, end)) {
      at = end;
      return true;
    }
  }
  const std::size_t behind =
      joint == '='
          ? std::min(line.find_first_of(" \t,;|", at), line.size())
          : static_cast<std::size_t>(std::find_if_not(line.begin() + static_cast<std::ptrdiff_t>(at), line.end(),
                                                      [](char c) { return is_letter(c) || c == '_'; }) -
                                     line.begin());
  pair.value = {.begin = at, .end = behind};
  at = behind;
  return pair.value.begin < behind && ends_value(line, behind);
}

/// The values from a place on to the end of the line; none where something else stands there. Names of several words
/// only where commas stand between the values.
std::vector<NamedValue> pairs_from(std::string_view line, std::size_t at, bool words) {
  std::vector<NamedValue> pairs;
  bool any_number = false;
  bool commas_join = false;
  while (at < line.size()) {
    NamedValue pair{.name = {.begin = at}};
    if (!may_begin_name(line[at])) {
      return {};
    }
    while (at < line.size() && (is_of_name(line[at]) || (words && line[at] == ' '))) {
      ++at;
    }
    pair.name.end = at;
    while (pair.name.end > pair.name.begin && line[pair.name.end - 1] == ' ') {
      --pair.name.end;
    }
    at = behind_blanks(line, at);
    if (at >= line.size() || (line[at] != ':' && line[at] != '=')) {
      return {};
    }
    const char joint = line[at];
    at = behind_blanks(line, at + 1);
    if (!take_value(line, at, joint, pair)) {
      return {};
    }
    any_number = any_number || is_value(cell_value(pair.value.of(line)).kind);
    pairs.push_back(pair);
    const std::size_t end = at;
    while (at < line.size() &&
           (is_blank_character(line[at]) || line[at] == ',' || line[at] == ';' || line[at] == '|')) {
      ++at;
    }
    const std::string_view between = line.substr(end, at - end);
    if (words && at < line.size() && between.find_first_of(",;|") == std::string_view::npos) {
      return {};
    }
    commas_join = commas_join || (at < line.size() && between == ",");
  }
  // `pos:1,2,u:3`: the comma in a value may separate as well.
  const bool two_readings = commas_join && std::ranges::any_of(pairs, [&](const NamedValue& one) {
                              return one.value.of(line).find(',') != std::string_view::npos;
                            });
  return any_number && !two_readings ? pairs : std::vector<NamedValue>{};
}

}  // namespace

std::vector<NamedValue> named_values(std::string_view line) {
  std::vector<NamedValue> best;
  for (const bool words : {false, true}) {
    for (std::size_t at = 0; at < line.size(); ++at) {
      const bool begins = at == 0 || std::string_view(" \t]>)|,").find(line[at - 1]) != std::string_view::npos;
      std::vector<NamedValue> pairs =
          begins && may_begin_name(line[at]) ? pairs_from(line, at, words) : std::vector<NamedValue>{};
      if (pairs.empty()) {
        continue;
      }
      if (pairs.size() > best.size()) {
        best = std::move(pairs);
      }
      break;
    }
  }
  return best;
}

}  // namespace hysteron::records
