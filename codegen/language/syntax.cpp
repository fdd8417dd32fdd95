#include "codegen/language/syntax.hpp"

#include <algorithm>

#include "codegen/language/lexer.hpp"
#include "support/byte_order_mark.hpp"
#include "support/names.hpp"
#include "support/text_file.hpp"
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

bool names_bit(std::string_view member) {
  constexpr std::size_t longest = 3;
  return member.size() > 1 && member.size() <= longest && same_name(member.substr(0, 1), "X") &&
         member.find_first_not_of("0123456789", 1) == std::string_view::npos;
}

std::string upper(std::string_view name) {
  return in_capitals(name);
}

SourceFile parse_file(const std::string& path, Diagnostics& diagnostics) {
  try {
    return parse(path, read_text_file(path), diagnostics);
  } catch (const InputError& problem) {
    diagnostics.add_all(problem.diagnostics());
    SourceFile file;
    file.path = path;
    file.text = std::make_shared<const std::string>();
    return file;
  }
}

}  // namespace hysteron::language
