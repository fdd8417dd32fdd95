#include "codegen/backends/drawing/body_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <vector>

#include "codegen/backends/drawing/dot_text.hpp"
#include "support/utf8.hpp"

namespace hysteron::dot {
namespace {

constexpr std::size_t longest_body_line = 64;
constexpr std::size_t most_body_lines = 24;
constexpr std::size_t body_tab_width = 4;

/// The lines of a text from where its first one begins, with blanks for tabs and without those at their ends.
std::vector<std::string> lines_of_body(std::string_view text) {
  std::vector<std::string> lines{""};
  for (const char c : text) {
    if (c == '\n') {
      lines.emplace_back();
    } else if (c == '\t') {
      lines.back() += std::string(body_tab_width - lines.back().size() % body_tab_width, ' ');
    } else if (c != '\r') {
      lines.back() += c;
    }
  }
  for (std::string& line : lines) {
    line.erase(line.find_last_not_of(' ') + 1);
  }
  return lines;
}

/// Blanks at the beginning are kept, which a label would drop.
std::string body_line(std::string_view line) {
  const std::size_t indent = std::min(line.find_first_not_of(' '), line.size());
  std::string text;
  for (std::size_t i = 0; i < indent; ++i) {
    text += "&#160;";
  }
  std::string_view rest = line.substr(indent);
  const bool cut = character_count(line) > longest_body_line;
  while (character_count(rest) + indent > longest_body_line && !rest.empty()) {
    while ((static_cast<unsigned char>(rest.back()) & 0xC0U) == 0x80U) {
      rest.remove_suffix(1);  // not within a character
    }
    rest.remove_suffix(1);
  }
  return text + escaped(rest) + (cut ? " …" : "");
}

}  // namespace

std::string body_text(const language::SourceFile& source, const language::body::Unit& unit) {
  if (unit.statements.empty()) {
    return {};
  }
  const std::size_t first = unit.statements.front().span.offset;
  const language::Span last = unit.statements.back().span;
  const std::string_view whole = *source.text;
  // From the beginning of the first line, so that all lines are indented alike; to the end of the last one, with the
  // semicolon that ends it.
  const std::size_t line_begin = whole.rfind('\n', first) == std::string_view::npos ? 0 : whole.rfind('\n', first) + 1;
  const bool alone = whole.substr(line_begin, first - line_begin).find_first_not_of(" \t") == std::string_view::npos;
  std::size_t end = last.offset + last.length;
  if (end < whole.size() && whole[end] == ';') {
    ++end;
  }
  const std::size_t begin = alone ? line_begin : first;
  std::vector<std::string> lines = lines_of_body(whole.substr(begin, end - begin));
  std::size_t indent = std::string::npos;
  for (const std::string& line : lines) {
    if (!line.empty()) {
      indent = std::min(indent, line.find_first_not_of(' '));
    }
  }
  std::string text;
  const std::size_t shown = lines.size() > most_body_lines ? most_body_lines - 1 : lines.size();
  for (std::size_t i = 0; i < shown; ++i) {
    text += body_line(lines[i].empty() ? "" : std::string_view(lines[i]).substr(indent)) + "<BR ALIGN=\"LEFT\"/>";
  }
  if (shown < lines.size()) {
    text += fmt::format("… and {} more lines<BR ALIGN=\"LEFT\"/>", lines.size() - shown);
  }
  return fmt::format("<FONT FACE=\"DejaVu Sans Mono,Courier New,monospace\" POINT-SIZE=\"9\">{}</FONT>", text);
}

}  // namespace hysteron::dot
