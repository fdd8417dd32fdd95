#include "records/text/csv_line.hpp"

#include <algorithm>
#include <cstddef>

#include "records/text/unit_text.hpp"
#include "records/time/time_unit.hpp"
#include "support/names.hpp"
#include "support/trimmed.hpp"

namespace hysteron::records {
namespace {

constexpr bool is_space(char c) {
  return c == ' ' || c == '\t';
}

/// A quote opens only at the begin of a cell; `""` inside stays as it is, no number and no sensible name has one.
std::size_t end_of_cell(std::string_view line, std::size_t begin, char separator) {
  std::size_t at = begin;
  while (at < line.size() && line[at] != separator && is_space(line[at])) {
    ++at;
  }
  if (at < line.size() && line[at] == '"') {
    const auto closing = line.find('"', at + 1);
    at = closing == std::string_view::npos ? begin : closing;
  }
  const auto end = line.find(separator, at);
  return end == std::string_view::npos ? line.size() : end;
}

void cut_at_blanks(std::string_view line, std::vector<Cell>& cells) {
  for (std::size_t at = 0; at < line.size();) {
    if (is_space(line[at])) {
      ++at;
      continue;
    }
    const bool quoted = line[at] == '"' && line.find('"', at + 1) != std::string_view::npos;
    const std::size_t begin = quoted ? at + 1 : at;
    const std::size_t end = quoted ? line.find('"', begin) : std::min(line.find_first_of(" \t", begin), line.size());
    cells.push_back({.text = line.substr(begin, end - begin), .offset = begin});
    at = quoted ? end + 1 : end;
  }
}

/// A unit in round brackets is told from a remark by its first character: "y (1)" has none.
bool may_begin_unit(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '%' || static_cast<unsigned char>(c) >= 0x80;
}

}  // namespace

void cut_line(std::string_view line, char separator, std::vector<Cell>& cells) {
  cells.clear();
  if (separator == ' ') {
    cut_at_blanks(line, cells);
    return;
  }
  std::size_t begin = 0;
  while (true) {
    const std::size_t end = end_of_cell(line, begin, separator);
    auto text = trimmed(line.substr(begin, end - begin));
    for (const char quote : {'"', '\''}) {
      if (text.size() >= 2 && text.front() == quote && text.back() == quote) {
        text = trimmed(text.substr(1, text.size() - 2));
      }
    }
    const std::size_t offset = text.empty() ? begin : static_cast<std::size_t>(text.data() - line.data());
    cells.push_back({.text = text, .offset = offset});
    if (end == line.size()) {
      return;
    }
    begin = end + 1;
  }
}

bool is_blank(std::string_view line, char separator) {
  return std::all_of(line.begin(), line.end(), [&](char c) { return is_space(c) || c == separator || c == '"'; });
}

namespace {

/// Behind the index of an element, which stands at its name without a blank: of `Y[2] [um]`, 4. 0 where there is none:
/// `gain [1]` is a number without a unit.
std::size_t end_of_index(std::string_view cell) {
  const auto open = cell.find('[');
  const auto close = open == std::string_view::npos ? open : cell.find_first_not_of("0123456789", open + 1);
  const bool index = close != std::string_view::npos && cell[close] == ']' && close > open + 1 && open > 0 &&
                     !is_space(cell[open - 1]);
  return index ? close + 1 : 0;
}

/// V(u) and I(R1) are names of circuit simulators, V(mV) and I(A) a voltage and a current with their units.
bool is_name_of_circuit(std::string_view name, std::string_view inner) {
  const bool voltage = equal_ignoring_case(name, "v");
  const bool current = equal_ignoring_case(name, "i");
  return (voltage && !(is_known_unit(inner) && inner.ends_with('V'))) ||
         (current && !(is_known_unit(inner) && inner.ends_with('A')));
}

/// mV, and millivolts.
bool is_unit_word(std::string_view text) {
  return is_known_unit(text) || (!text.empty() && unit_of_word(text) != text);
}

/// Of one letter a unit would be a part of the name, and an angle may stand for a speed.
bool is_clear_unit(std::string_view unit) {
  return unit.size() >= 2 && is_unit_word(unit) && !is_one_of(unit, {"deg", "rad", "inc", "pu", "cd", "min", "sec"}) &&
         unit.find_first_of("0123456789[](){}<>") == std::string_view::npos && !time_unit(unit);
}

/// The unit that ends a name, u_mV and u.mV.
std::string_view unit_of_suffix(std::string_view cell) {
  const auto joint = cell.find_last_of("_.");
  const std::string_view unit =
      joint == std::string_view::npos || joint == 0 ? std::string_view() : cell.substr(joint + 1);
  return is_clear_unit(unit) ? unit : std::string_view();
}

}  // namespace

HeaderName split_header(std::string_view cell) {
  const auto with = [&](std::size_t end, std::size_t begin, std::size_t length) {
    return HeaderName{.name = std::string(trimmed(cell.substr(0, end))),
                      .unit = std::string(trimmed(cell.substr(begin, length)))};
  };
  if (cell.ends_with(']')) {
    if (const auto open = cell.find('[', end_of_index(cell)); open != std::string_view::npos) {
      const auto close = cell.find(']', open);
      if (close + 1 == cell.size() || is_unit_word(cell.substr(open + 1, close - open - 1))) {
        return with(open, open + 1, close - open - 1);  // the first of `Time [s] [abs]`
      }
      const auto last = cell.rfind('[');
      return with(last, last + 1, cell.size() - last - 2);
    }
  }
  if (cell.ends_with(')')) {
    if (const auto open = cell.rfind('(');
        open != std::string_view::npos && open > 0 &&
        (may_begin_unit(cell[open + 1]) || scaled_unit(cell.substr(open + 1, cell.size() - open - 2))) &&
        !is_name_of_circuit(cell.substr(0, open), cell.substr(open + 1, cell.size() - open - 2))) {
      // `u, mV (LGR S/N: 20)` of HOBO: what stands behind a unit in brackets is none.
      if (!is_unit_word(cell.substr(open + 1, cell.size() - open - 2))) {
        HeaderName before = split_header(trimmed(cell.substr(0, open)));
        if (is_unit_word(before.unit)) {
          return before;
        }
      }
      return with(open, open + 1, cell.size() - open - 2);
    }
  }
  if (const auto slash = cell.find(" / "); slash != std::string_view::npos && slash > 0) {
    return with(slash, slash + 3, std::string_view::npos);
  }
  // u/mV, "u in mV" and "u, mV": a unit only where it is one.
  for (const std::string_view joint : {" in ", ", ", "/"}) {
    if (const auto at = cell.rfind(joint); at != std::string_view::npos && at > 0 && cell.find('/') >= at &&
                                           !time_name(cell) && is_unit_word(cell.substr(at + joint.size()))) {
      return with(at, at + joint.size(), std::string_view::npos);
    }
  }
  // u {mV}, u <mV>, u: mV, u - mV and u mV: a unit only where it is one, and no angle, which may stand for a speed.
  for (const std::string_view brackets : {"{}", "<>"}) {
    const auto open = cell.ends_with(brackets[1]) ? cell.rfind(brackets[0]) : std::string_view::npos;
    if (open != std::string_view::npos && open > 0 && is_unit_word(cell.substr(open + 1, cell.size() - open - 2))) {
      return with(open, open + 1, cell.size() - open - 2);
    }
  }
  for (const std::string_view joint : {" - ", ":", " "}) {
    const auto at = cell.rfind(joint);
    if (at == std::string_view::npos || at == 0) {
      continue;
    }
    const std::string_view unit = trimmed(cell.substr(at + joint.size()));
    if (is_clear_unit(unit) || (time_name(trimmed(cell.substr(0, at))) && time_unit(unit))) {
      return with(at, at + joint.size(), std::string_view::npos);
    }
  }
  return {.name = std::string(cell), .unit = std::string(unit_of_suffix(cell))};
}

}  // namespace hysteron::records
