#include "records/csv_line.hpp"

#include <algorithm>

namespace hysteron::records {
namespace {

constexpr bool is_space(char c) {
  return c == ' ' || c == '\t';
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_space(text.front())) {
    text.remove_prefix(1);
  }
  while (!text.empty() && is_space(text.back())) {
    text.remove_suffix(1);
  }
  return text;
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

}  // namespace

void cut_line(std::string_view line, char separator, std::vector<Cell>& cells) {
  cells.clear();
  std::size_t begin = 0;
  while (true) {
    const std::size_t end = end_of_cell(line, begin, separator);
    auto text = trimmed(line.substr(begin, end - begin));
    if (text.size() >= 2 && text.front() == '"' && text.back() == '"') {
      text = trimmed(text.substr(1, text.size() - 2));
    }
    const std::size_t offset = text.empty() ? begin : static_cast<std::size_t>(text.data() - line.data());
    cells.push_back({.text = text, .offset = offset});
    if (end == line.size()) {
      return;
    }
    begin = end + 1;
  }
}

char separator_of(std::string_view header) {
  bool quoted = false;
  int brackets = 0;
  bool tab = false;
  for (const char c : header) {
    quoted = quoted != (c == '"');
    brackets += c == '[' ? 1 : (c == ']' ? -1 : 0);
    if (!quoted && brackets <= 0) {
      if (c == ';') {
        return ';';
      }
      tab = tab || c == '\t';
    }
  }
  return tab ? '\t' : ',';
}

bool is_blank(std::string_view line, char separator) {
  return std::all_of(line.begin(), line.end(), [&](char c) { return is_space(c) || c == separator || c == '"'; });
}

HeaderName split_header(std::string_view cell) {
  const auto open = cell.find('[');
  if (open == std::string_view::npos || cell.back() != ']') {
    return {.name = std::string(cell)};
  }
  return {.name = std::string(trimmed(cell.substr(0, open))),
          .unit = std::string(trimmed(cell.substr(open + 1, cell.size() - open - 2)))};
}

}  // namespace hysteron::records
