#include "codegen/language/syntax.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <system_error>

#include "codegen/language/lexer.hpp"
#include "support/errors.hpp"
#include "support/names.hpp"
#include "support/utf8.hpp"

namespace hysteron::language {

Place SourceFile::place(Span span) const {
  Place place{.file = path};
  if (!text || line_starts.empty()) {
    return place;
  }
  const std::string_view all = *text;
  const auto size = static_cast<std::uint32_t>(all.size());
  const std::uint32_t offset = std::min(span.offset, size);
  const auto after = std::upper_bound(line_starts.begin(), line_starts.end(), offset);
  const auto line = static_cast<std::uint32_t>(after - line_starts.begin());
  std::uint32_t start = *(after - 1);
  if (line == 1 && all.starts_with(byte_order_mark)) {
    start = std::min(offset, static_cast<std::uint32_t>(byte_order_mark.size()));
  }
  const auto stretch = all.substr(offset, std::min(span.length, size - offset));
  place.line = line;
  place.column = static_cast<std::uint32_t>(character_count(all.substr(start, offset - start))) + 1;
  place.length =
      std::max(1U, static_cast<std::uint32_t>(character_count(stretch.substr(0, stretch.find_first_of("\r\n")))));
  return place;
}

bool same_name(std::string_view a, std::string_view b) {
  return equal_ignoring_case(a, b);
}

std::string upper(std::string_view name) {
  return in_capitals(name);
}

SourceFile parse_file(const std::string& path, Diagnostics& diagnostics) {
  const auto refuse = [&](std::string cause) {
    diagnostics.error(error::unreadable_file, {.file = path}, std::move(cause),
                      "Check the path, and that you may read it.");
    SourceFile file;
    file.path = path;
    file.text = std::make_shared<const std::string>();
    return file;
  };
  std::error_code problem;
  if (std::filesystem::is_directory(path, problem)) {
    return refuse(path + " is a folder, not a file.");
  }
  std::ifstream stream(path, std::ios::binary);
  if (!stream) {
    return refuse(path + " cannot be opened.");
  }
  std::string text((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
  if (stream.bad()) {
    return refuse(path + " cannot be read to its end.");
  }
  return parse(path, std::move(text), diagnostics);
}

}  // namespace hysteron::language
