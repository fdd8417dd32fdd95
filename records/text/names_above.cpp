#include "records/text/names_above.hpp"

#include <algorithm>

#include "records/text/cell_value.hpp"
#include "records/text/layout.hpp"
#include "records/text/unit_text.hpp"
#include "records/time/time_unit.hpp"
#include "support/names.hpp"

namespace hysteron::records {
namespace {

/// Names, units, kinds of processing, comments: no tool writes more rows of them.
constexpr std::size_t most_lines = 6;

std::size_t filled(const std::vector<Cell>& cells) {
  return static_cast<std::size_t>(std::ranges::count_if(cells, [](const Cell& cell) { return !cell.text.empty(); }));
}

/// Whether a name stands twice. `units` is the row below: what is in a unit of time may, each signal with its own.
bool repeats_itself(const std::vector<Cell>& cells, const std::vector<Cell>* units = nullptr) {
  for (std::size_t i = 0; i < cells.size(); ++i) {
    for (std::size_t k = 0; k < i && !cells[i].text.empty(); ++k) {
      const bool is_time =
          units != nullptr && i < units->size() && time_unit(without_brackets((*units)[i].text)).has_value();
      if (!is_time && equal_ignoring_case(cells[i].text, cells[k].text)) {
        return true;
      }
    }
  }
  return false;
}

bool has_value(const std::vector<Cell>& cells) {
  return std::ranges::any_of(cells, [](const Cell& cell) { return is_value(cell_value(cell.text).kind); });
}

/// `t,u,` below a line of titles is a row of names, whatever it lacks; `t,,` is the name of an index.
bool names_time(const std::vector<Cell>& cells) {
  return filled(cells) > 1 &&
         std::ranges::any_of(cells, [](const Cell& cell) { return time_name(cell.text).has_value(); });
}

}  // namespace

std::vector<HeadLine> lines_above(const std::vector<Line>& head, std::size_t first_row, char separator) {
  std::vector<HeadLine> result;
  for (std::size_t i = first_row; i > 0 && result.size() < most_lines;) {
    const std::string_view text = head[--i].text;
    const bool is_of_ignition = i > 0 && is_one_of(head[i - 1].text, {"#TYPES", "#ROWS"});
    if (!is_blank(text, separator) && !is_comment(text, separator) && !is_of_ignition) {
      result.push_back({.line = i});
      cut_line(text, separator, result.back().cells);
    }
  }
  return result;
}

bool begins_with_text(const std::vector<Cell>& cells) {
  const auto first = std::ranges::find_if(cells, [](const Cell& cell) { return !cell.text.empty(); });
  return first != cells.end() && !is_value(cell_value(first->text).kind);
}

bool states_units(const std::vector<Cell>& cells) {
  bool time = false;
  bool bracketed = true;
  std::size_t units = 0;
  std::size_t words = 0;
  for (std::size_t c = 0; c < cells.size(); ++c) {
    const std::string_view text = without_unit_key(cells[c].text);
    if (text.empty() || text == "-" || (c == 0 && is_key_of_units(text))) {
      continue;
    }
    const std::string_view bare = without_brackets(text);
    if (is_value(cell_value(text).kind) || bare.size() > 16) {
      return false;
    }
    ++words;
    const bool known =
        is_known_unit(bare) || time_unit(bare) || unit_of_word(bare) != bare || text.size() != cells[c].text.size();
    units += known ? 1 : 0;
    time = time || time_unit(bare).has_value();
    bracketed = bracketed && bare.size() != text.size();
  }
  return words > 0 && (time || 2 * units >= words || (bracketed && !cells.front().text.empty()));
}

bool is_name_of_index(const std::vector<Cell>& cells) {
  return cells.size() > 1 && filled(cells) == 1 && !cells.front().text.empty();
}

std::size_t row_of_names(std::span<const HeadLine> words) {
  std::size_t names = 0;
  while (names + 1 < words.size()) {
    const std::vector<Cell>& low = words[names].cells;
    const std::vector<Cell>& high = words[names + 1].cells;
    const bool odd = repeats_itself(low) || filled(low) < filled(high);
    const bool second = states_units(low) || (odd && !names_time(low) && !has_value(high));
    if (!second || repeats_itself(high, &low) || filled(high) < filled(low)) {
      break;
    }
    ++names;
  }
  return names;
}

}  // namespace hysteron::records
