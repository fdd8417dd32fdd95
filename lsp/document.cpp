#include "lsp/document.hpp"

#include <algorithm>
#include <charconv>

#include "support/byte_order_mark.hpp"
#include "support/utf8.hpp"

namespace hysteron::lsp {
namespace {

/// The begin of a line, from 0; the end of the text where there is no such line.
std::size_t line_start(std::string_view text, std::uint64_t line) {
  std::size_t start = 0;
  for (; line > 0; --line) {
    const auto end = text.find('\n', start);
    if (end == std::string_view::npos) {
      return text.size();
    }
    start = end + 1;
  }
  return start;
}

/// The end of the line that begins at an offset, without its line break.
std::size_t line_end(std::string_view text, std::size_t start) {
  const auto end = std::min(text.find('\n', start), text.size());
  return end > start && text[end - 1] == '\r' && end < text.size() ? end - 1 : end;
}

/// How much of a line a character takes. Above U+FFFF, where UTF-8 has four bytes, UTF-16 has two units.
std::uint64_t units(std::size_t length, Encoding encoding) {
  return encoding == Encoding::Utf8 ? length : length == 4 ? 2 : 1;
}

}  // namespace

std::size_t offset_of(std::string_view text, Position position, Encoding encoding) {
  auto offset = line_start(text, position.line);
  const auto end = line_end(text, offset);
  while (offset < end) {
    const auto length = utf8_length(text.substr(offset));
    const auto taken = units(length, encoding);
    if (taken > position.character) {
      break;
    }
    position.character -= taken;
    offset += length;
  }
  return offset;
}

Position position_of(std::string_view text, std::size_t offset, Encoding encoding) {
  offset = std::min(offset, text.size());
  Position position;
  position.line =
      static_cast<std::uint64_t>(std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(offset), '\n'));
  for (auto at = line_start(text, position.line); at < offset;) {
    const auto length = utf8_length(text.substr(at));
    position.character += units(length, encoding);
    at += length;
  }
  return position;
}

std::size_t offset_of_place(std::string_view text, std::uint32_t line, std::uint32_t column) {
  auto offset = line_start(text, line > 0 ? line - 1 : 0);
  if (offset == 0 && text.starts_with(byte_order_mark)) {
    offset = byte_order_mark.size();
  }
  const auto end = line_end(text, offset);
  for (; column > 1 && offset < end; --column) {
    offset += utf8_length(text.substr(offset));
  }
  return offset;
}

std::string path_of(std::string_view uri) {
  constexpr std::string_view scheme = "file://";
  if (!uri.starts_with(scheme)) {
    return std::string(uri);
  }
  uri.remove_prefix(scheme.size());
  std::string path;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    int value = 0;
    if (uri[i] == '%' && i + 2 < uri.size()) {
      const auto* const first = uri.data() + i + 1;
      if (const auto read = std::from_chars(first, first + 2, value, 16); read.ptr == first + 2 && value > 0) {
        path += static_cast<char>(value);
        i += 2;
        continue;
      }
    }
    path += uri[i];
  }
  return path;
}

}  // namespace hysteron::lsp
