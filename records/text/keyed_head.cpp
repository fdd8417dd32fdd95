#include "records/text/keyed_head.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string_view>
#include <utility>

#include "records/text/cell_value.hpp"
#include "records/text/scale_row.hpp"
#include "records/text/unit_text.hpp"
#include "support/names.hpp"

namespace hysteron::records {
namespace {

/// What stands behind a key, `Source,CH1,Source,CH2,` without the key itself and without what is empty.
std::vector<std::string_view> said_of(const std::vector<Cell>& cells) {
  std::vector<std::string_view> said;
  for (std::size_t c = 1; c < cells.size(); ++c) {
    if (!cells[c].text.empty() && cells[c].text != cells.front().text) {
      said.push_back(cells[c].text);
    }
  }
  return said;
}

/// V of `10.000 V`; LabChart writes * where a channel has no unit of its own.
std::string unit_in(std::string_view text) {
  if (text == "*") {
    return {};
  }
  const auto scaled = scaled_unit(text);
  return scaled ? scaled->unit : unit_of_word(text);
}

}  // namespace

std::optional<KeyedHead> keyed_head(const std::vector<Line>& head, std::size_t first_row,
                                    const std::vector<bool>& values, char separator) {
  std::vector<std::string_view> names;
  std::vector<std::string> units;
  std::vector<std::string> keys_of_units;
  std::string unit_of_time;
  std::vector<std::pair<std::string_view, std::vector<std::string_view>>> scales;
  bool counts = false;
  bool ends_head = false;  // whether the line right above the rows says that a head ends here
  std::vector<Cell> cells;
  for (std::size_t i = 0; i < first_row; ++i) {
    if (is_blank(head[i].text, separator)) {
      continue;
    }
    cut_line(head[i].text, separator, cells);
    std::string_view key = cells.front().text;
    const bool has_equals = key.ends_with('=');
    key.remove_suffix(has_equals ? 1 : 0);
    const std::vector<std::string_view> said = said_of(cells);
    // `SymbolBased;True;True` right above the rows: one key more, and no names.
    const bool is_setting =
        std::ranges::any_of(said, [](std::string_view one) { return is_value(cell_value(one).kind); });
    ends_head = has_equals || is_setting || is_one_of(key, {"waveform data"});
    if (is_one_of(key, {"source", "channeltitle", "tracename", "name"})) {
      names = said;
    } else if (equal_ignoring_case(split_header(key).name, "SampleTime")) {
      unit_of_time = split_header(key).unit;
    } else if (is_key_of_scale(key)) {
      scales.emplace_back(key, said);
    } else if (is_key_of_units(key) || is_one_of(key, {"vertical units", "vunit", "range", "unitname"})) {
      for (std::size_t c = 0; c < said.size(); ++c) {
        units.resize(std::max(units.size(), said.size()));
        std::string unit = unit_in(said[c]);
        units[c] = unit.empty() ? units[c] : std::move(unit);
      }
      keys_of_units.emplace_back(cells.front().text);
    } else if (is_one_of(key, {"mode"})) {
      counts = !said.empty() && equal_ignoring_case(said.front(), "fast");
    }
  }
  const auto filled = static_cast<std::size_t>(std::ranges::count(values, true));
  const std::size_t count = names.size();
  const bool alone = filled == count;
  const bool one_time = filled == count + 1;
  if (!ends_head || count == 0 || (!alone && !one_time && filled != 2 * count)) {
    return std::nullopt;
  }
  KeyedHead result;
  result.columns.resize(values.size() - (values.back() ? 0 : 1));  // a row may end with a separator
  std::size_t at = 0;                                              // among the cells that hold numbers
  for (std::size_t c = 0; c < result.columns.size(); ++c) {
    if (!values[c]) {
      continue;
    }
    const bool is_time = one_time ? at == 0 : !alone && at % 2 == 0;
    const std::size_t signal = alone ? at : one_time ? at - 1 : at / 2;
    result.columns[c].cell = c;
    result.columns[c].name = is_time ? "t" : std::string(names[signal]);
    result.columns[c].unit = is_time ? unit_of_time : std::string();
    result.columns[c].is_time = is_time;
    if (!is_time && !counts && signal < units.size()) {
      result.columns[c].unit = units[signal];
    }
    ++at;
  }
  for (const auto& [key, said] : scales) {
    for (std::size_t c = 0; c < std::min(said.size(), count); ++c) {
      if (auto note = note_of_scale(key, said[c], names[c])) {
        result.notes.push_back(std::move(*note));
      }
    }
  }
  if (counts) {
    result.notes.emplace_back(
        "the head says Mode Fast: the numbers are steps of the converter, without a unit; Detail writes volts");
  } else if (!units.empty()) {
    result.notes.push_back(fmt::format("the units are those of {} above the rows", fmt::join(keys_of_units, " and ")));
  }
  return result;
}

}  // namespace hysteron::records
