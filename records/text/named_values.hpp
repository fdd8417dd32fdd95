// Values with their names at the end of a line: u: 1.0, y: 2.0 V; u=1 y=2.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string_view>
#include <vector>

namespace hysteron::records {

/// A part of a line.
struct Span {
  std::size_t begin = 0;
  std::size_t end = 0;

  [[nodiscard]] std::string_view of(std::string_view line) const { return line.substr(begin, end - begin); }
};

struct NamedValue {
  Span name{};
  Span value{};
  Span unit{};  ///< behind the value; empty where there is none
};

[[nodiscard]] constexpr std::size_t behind_blanks(std::string_view line, std::size_t at) {
  return std::min(line.find_first_not_of(" \t", at), line.size());
}

/// The values from the first place on from which nothing else stands to the end of the line; none where there is no
/// such place, or no number among them. Names have several words only where commas stand between the values, and where
/// that gives more of them: of `motor speed: 1, motor current: 2`, `current` alone is a name as well.
[[nodiscard]] std::vector<NamedValue> named_values(std::string_view line);

}  // namespace hysteron::records
