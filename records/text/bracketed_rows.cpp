#include "records/text/bracketed_rows.hpp"

#include <algorithm>
#include <cstddef>
#include <string_view>

#include "support/trimmed.hpp"

namespace hysteron::records {
namespace {

constexpr std::size_t lines_looked_at = 20;

/// `[0, 1],` and `(0, 1)`, with digits in it and no letters but the e of 1e-3.
bool is_bracketed(std::string_view line) {
  line = trimmed(line, " \t\r,;");
  const bool brackets =
      line.size() > 2 && ((line.front() == '[' && line.back() == ']') || (line.front() == '(' && line.back() == ')'));
  return brackets && line.find_first_not_of("0123456789+-.,;eE \t", 1) == line.size() - 1;
}

}  // namespace

bool clear_brackets(std::string& text) {
  std::size_t lines = 0;
  for (std::size_t at = 0; at < text.size() && lines < lines_looked_at;) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string_view line = std::string_view(text).substr(at, end - at);
    at = end + 1;
    if (trimmed(line, " \t\r").empty()) {
      continue;
    }
    // A row of names may stand above.
    if (!is_bracketed(line) && (lines > 0 || line.find('[') != std::string_view::npos)) {
      return false;
    }
    ++lines;
  }
  if (lines < 3) {
    return false;
  }
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    if (is_bracketed(std::string_view(text).substr(at, end - at))) {
      const std::size_t last = text.find_last_of("])", end);
      std::fill(text.begin() + static_cast<std::ptrdiff_t>(last), text.begin() + static_cast<std::ptrdiff_t>(end), ' ');
      text[text.find_first_of("[(", at)] = ' ';
    }
    at = end + 1;
  }
  return true;
}

}  // namespace hysteron::records
