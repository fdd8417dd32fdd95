// What a command prints against what a page shows: … stands for any text, alone on a line for any lines.
#pragma once

#include <sstream>
#include <string>
#include <string_view>
#include <vector>

namespace hysteron::test {

inline constexpr std::string_view anything = "…";

inline bool line_matches(std::string_view line, std::string_view pattern) {
  const auto gap = pattern.find(anything);
  if (gap == std::string_view::npos) {
    return line == pattern;
  }
  if (!line.starts_with(pattern.substr(0, gap))) {
    return false;
  }
  line.remove_prefix(gap);
  pattern.remove_prefix(gap + anything.size());
  for (std::size_t skipped = 0; skipped <= line.size(); ++skipped) {
    if (line_matches(line.substr(skipped), pattern)) {
      return true;
    }
  }
  return false;
}

/// The lines of a text, without empty ones at its end.
inline std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) {
    lines.push_back(line);
  }
  while (!lines.empty() && lines.back().empty()) {
    lines.pop_back();
  }
  return lines;
}

inline bool lines_match(const std::vector<std::string>& lines, std::size_t at, const std::vector<std::string>& patterns,
                        std::size_t next) {
  if (next == patterns.size()) {
    return at == lines.size();
  }
  if (patterns[next] == anything) {
    for (std::size_t end = at; end <= lines.size(); ++end) {
      if (lines_match(lines, end, patterns, next + 1)) {
        return true;
      }
    }
    return false;
  }
  return at < lines.size() && line_matches(lines[at], patterns[next]) && lines_match(lines, at + 1, patterns, next + 1);
}

}  // namespace hysteron::test
