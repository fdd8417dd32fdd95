#include "support/wrapped.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <optional>

#include "support/utf8.hpp"
#include "support/whole_number.hpp"

namespace hysteron {
namespace {

/// Narrower than this nothing can be read, broken or not.
constexpr std::size_t least_width = 20;
constexpr std::size_t least_room = 12;  ///< behind an indent
constexpr std::size_t shallow_column = 2;
constexpr std::size_t below = 4;  ///< further in than a first column, a second one that stands below it

/// Without the escape sequences of colours.
std::size_t shown_count(std::string_view text) {
  std::string shown;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '\033') {
      i = std::min(text.find('m', i), text.size());
    } else {
      shown += text[i];
    }
  }
  return character_count(shown);
}

/// `   9 |   AMP(XNI := U);`, or `   $ nproc`
bool is_to_be_copied(std::string_view line) {
  const auto first = std::min(line.find_first_not_of(" 0123456789"), line.size());
  return line.substr(first).starts_with("|") || line.substr(first).starts_with("$ ");
}

/// Where the second of two columns begins, 0 where there is one column; nothing where the line is a row of a table.
std::optional<std::size_t> second_column(std::string_view line) {
  const std::size_t first = line.find_first_not_of(' ');
  std::size_t second = 0;
  std::size_t columns = 0;
  for (auto gap = line.find("  ", first); gap != std::string_view::npos; gap = line.find("  ", second)) {
    const auto word = line.find_first_not_of(' ', gap);
    if (word == std::string_view::npos) {
      break;
    }
    second = word;
    ++columns;
  }
  return columns > 1 ? std::nullopt : std::optional(second);
}

/// The end of what fits into the width: a blank behind `first`, the first one at least; npos where there is none.
std::size_t break_of(std::string_view line, std::size_t first, std::size_t width) {
  std::size_t found = std::string_view::npos;
  for (auto blank = line.find(' ', first); blank != std::string_view::npos; blank = line.find(' ', blank + 1)) {
    const bool is_end = line.find_first_not_of(' ', blank) == std::string_view::npos;
    if (is_end || (found != std::string_view::npos && shown_count(line.substr(0, blank)) > width)) {
      break;
    }
    found = blank;
  }
  return found;
}

/// A line of one column, what follows of it `indent` characters from the left. The first word is not broken off.
void append_broken(std::string& result, std::string_view line, std::size_t indent, std::size_t first,
                   std::size_t width) {
  std::size_t room = width;
  while (shown_count(line) > room) {
    const std::size_t end = break_of(line, first, room);
    if (end == std::string_view::npos) {
      break;
    }
    result += line.substr(0, end);
    result += "\n" + std::string(indent, ' ');
    line.remove_prefix(line.find_first_not_of(' ', end));
    room = width - indent;
    first = 0;
  }
  result += line;
}

void append_wrapped(std::string& result, std::string_view line, std::size_t width) {
  const std::size_t first = line.find_first_not_of(' ');
  const bool stays = first == std::string_view::npos || shown_count(line) <= width || is_to_be_copied(line);
  const auto second = stays ? std::nullopt : second_column(line);
  if (!second) {
    result += line;
    return;
  }
  const std::size_t hanging = std::max(first, *second);
  const std::size_t indent = shown_count(line.substr(0, hanging));
  if (indent + least_room <= width) {
    append_broken(result, line, indent, hanging, width);
    return;
  }
  // What has no room so far in stands further out, the second column below the first.
  const std::size_t shallow = std::min(first, shallow_column) + below;
  if (*second == 0) {
    append_broken(result, std::string(shallow, ' ') + std::string(line.substr(first)), shallow, shallow, width);
    return;
  }
  append_broken(result, line.substr(0, line.find_last_not_of(' ', *second - 1) + 1), shallow, first, width);
  result += '\n';
  append_broken(result, std::string(shallow, ' ') + std::string(line.substr(*second)), shallow, shallow, width);
}

}  // namespace

std::size_t terminal_width(std::FILE* stream) {
  if (const char* const columns = std::getenv("COLUMNS")) {
    if (const auto width = whole_number<std::size_t>(columns, 1)) {
      return *width;
    }
  }
  winsize size{};
  return ioctl(fileno(stream), TIOCGWINSZ, &size) == 0 ? size.ws_col : 0;
}

std::string wrapped(std::string_view text, std::size_t width) {
  if (width < least_width) {
    return std::string(text);
  }
  std::string result;
  while (!text.empty()) {
    const auto end = std::min(text.find('\n'), text.size());
    append_wrapped(result, text.substr(0, end), width);
    result += end < text.size() ? "\n" : "";
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return result;
}

}  // namespace hysteron
