#include "records/text/row_block.hpp"

#include <algorithm>
#include <string_view>
#include <utility>

#include "records/text/cell_value.hpp"
#include "records/text/layout.hpp"
#include "records/text/names_above.hpp"

namespace hysteron::records {
namespace {

/// Which cells hold a value. Between blanks, 0.35,1.05 is two of them.
std::vector<bool> values_of(const std::vector<Cell>& cells, char separator) {
  std::vector<bool> values;
  values.reserve(cells.size());
  for (const Cell& cell : cells) {
    const CellKind kind = cell_value(cell.text).kind;
    values.push_back(is_value(kind) && !(separator == ' ' && kind == CellKind::TwoMarks));
  }
  return values;
}

}  // namespace

RowBlock longest_block(const std::vector<Line>& head, char separator) {
  RowBlock best;
  RowBlock now;
  std::vector<Cell> cells;
  for (std::size_t i = 0; i < head.size(); ++i) {
    if (is_blank(head[i].text, separator) || is_comment(head[i].text, separator)) {
      continue;
    }
    cut_line(head[i].text, separator, cells);
    std::vector<bool> values = values_of(cells, separator);
    const bool begins_empty = !cells.empty() && cells.front().text.empty();
    if (now.goes_on_with(values, begins_empty)) {
      ++now.rows;
    } else {
      best = now.score() > best.score() ? now : best;
      const bool any = std::ranges::find(values, true) != values.end();
      now =
          any ? RowBlock{.first = i, .rows = 1, .values = std::move(values), .begins_empty = begins_empty} : RowBlock{};
    }
  }
  return now.score() > best.score() ? now : best;
}

bool has_names_above(const std::vector<Line>& head, const RowBlock& block, char separator) {
  std::vector<Cell> cells;
  for (std::size_t i = block.first; block.rows > 0 && block.values.size() > 1 && i > 0;) {
    const std::string_view line = head[--i].text;
    if (!is_blank(line, separator) && !is_comment(line, separator)) {
      cut_line(line, separator, cells);
      return cells.size() == block.values.size() && begins_with_text(cells);
    }
  }
  return false;
}

void take_earlier_rows(const std::vector<Line>& head, char separator, RowBlock& block) {
  std::vector<Cell> cells;
  for (std::size_t i = 0; i < block.first; ++i) {
    if (is_blank(head[i].text, separator) || is_comment(head[i].text, separator)) {
      continue;
    }
    cut_line(head[i].text, separator, cells);
    const std::vector<bool> values = values_of(cells, separator);
    if (!values.empty() && values.front() == block.values.front() &&
        block.goes_on_with(values, cells.front().text.empty())) {
      block.first = i;
      return;
    }
  }
}

}  // namespace hysteron::records
