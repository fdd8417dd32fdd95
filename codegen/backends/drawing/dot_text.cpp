#include "codegen/backends/drawing/dot_text.hpp"

#include <fmt/format.h>

#include <utility>

namespace hysteron::dot {
namespace {

/// Characters of a line, and lines of a box, that are still read at a glance.
constexpr std::size_t line_length = 30;
constexpr std::size_t most_lines = 4;

}  // namespace

std::string opening(std::string_view name, std::string_view title) {
  return fmt::format(
      "digraph {} {{\n"
      "  graph [rankdir=LR, label=<{}>, labelloc=t, fontname=\"Helvetica,Arial,sans-serif\", fontsize=14, "
      "nodesep=0.22, ranksep=0.55, splines=true, bgcolor=white];\n"
      "  node [shape=box, style=\"rounded,filled\", fontname=\"Helvetica,Arial,sans-serif\", fontsize=11, "
      "margin=\"0.10,0.05\", height=0.3, penwidth=0.8];\n"
      "  edge [arrowsize=0.6, penwidth=0.9, fontname=\"Helvetica,Arial,sans-serif\", fontsize=9, "
      "fontcolor=\"{}\"];\n\n",
      quoted(name), title, faint);
}

std::string duration_of(std::int64_t nanoseconds) {
  for (const auto& [factor, unit] : {std::pair{1'000'000'000, "s"}, {1'000'000, "ms"}, {1'000, "µs"}}) {
    if (nanoseconds % factor == 0) {
      return fmt::format("{} {}", nanoseconds / factor, unit);
    }
  }
  return fmt::format("{} ns", nanoseconds);
}

std::string escaped(std::string_view text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

std::string quoted(std::string_view text) {
  std::string result = "\"";
  for (const char c : text) {
    result += c == '"' || c == '\\' ? std::string{'\\', c} : std::string(1, c);
  }
  return result + "\"";
}

std::string small_text(std::string_view text) {
  return fmt::format("<FONT POINT-SIZE=\"9\" COLOR=\"{}\">{}</FONT>", faint, escaped(text));
}

std::vector<std::string> lines_of(std::string_view text) {
  std::vector<std::string> lines;
  while (text.size() > line_length && lines.size() + 1 < most_lines) {
    std::size_t end = text.rfind(' ', line_length);
    end = end == std::string_view::npos || end == 0 ? text.find(' ') : end;
    if (end == std::string_view::npos) {
      break;
    }
    lines.emplace_back(text.substr(0, end));
    text.remove_prefix(end + 1);
  }
  constexpr std::size_t longest = 2 * line_length;
  if (text.size() <= longest) {
    lines.emplace_back(text);
    return lines;
  }
  std::size_t end = longest;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) {
    --end;  // not within a character
  }
  lines.push_back(std::string(text.substr(0, end)) + " …");
  return lines;
}

std::vector<std::string> lines_of(const std::vector<std::string>& items) {
  std::vector<std::string> lines;
  for (const std::string& item : items) {
    if (!lines.empty()) {
      lines.back() += ',';
    }
    if (lines.empty() || lines.back().size() + 1 + item.size() > line_length) {
      if (lines.size() == most_lines) {
        lines.back() += " …";
        return lines;
      }
      lines.push_back(item.size() > 2 * line_length ? lines_of(std::string_view(item)).back() : item);
    } else {
      lines.back() += " " + item;
    }
  }
  return lines;
}

std::string broken(std::string_view text) {
  std::string result;
  for (const std::string& line : lines_of(text)) {
    result += (result.empty() ? "" : "<BR/>") + escaped(line);
  }
  return result;
}

}  // namespace hysteron::dot
