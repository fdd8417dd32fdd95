#include "records/text/source_text.hpp"

#include <algorithm>
#include <cstdint>

#include "support/names.hpp"
#include "support/utf8.hpp"

namespace hysteron::records {

Line SourceText::line_at(std::size_t offset) const {
  const auto end = std::min(text.find('\n', offset), text.size());
  Line line{.text = std::string_view(text).substr(offset, end - offset),
            .offset = offset,
            .next = std::min(end + 1, text.size())};
  if (line.text.ends_with('\r')) {
    line.text.remove_suffix(1);
  }
  return line;
}

Place SourceText::place_of(const Line& line) const {
  const auto before = std::string_view(text).substr(0, line.offset);
  return {
      .file = file,
      .line =
          static_cast<std::uint32_t>(std::ranges::count_if(before, [](char c) { return c == '\n' || c == '\v'; })) + 1,
      .column = 1,
      .length = static_cast<std::uint32_t>(std::max<std::size_t>(1, character_count(line.text)))};
}

Place SourceText::place_of(const Line& line, const Cell& cell) const {
  Place place = place_of(line);
  place.column = static_cast<std::uint32_t>(character_count(line.text.substr(0, cell.offset))) + 1;
  place.length = static_cast<std::uint32_t>(std::max<std::size_t>(1, character_count(cell.text)));
  return place;
}

Place SourceText::place(std::string_view column, std::size_t row) const {
  const Line line = line_at(rows[row]);
  const auto written = std::ranges::find(names, column);
  const auto named = written != names.end() ? written : std::ranges::find_if(names, [&](const std::string& name) {
    return equal_ignoring_case(name, column);
  });
  std::vector<Cell> cells;
  cut_line(line.text, separator, cells);
  const auto at = static_cast<std::size_t>(named - names.begin());
  return at < cells.size() ? place_of(line, cells[at]) : place_of(line);
}

}  // namespace hysteron::records
