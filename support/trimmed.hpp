// A text without the blanks at its ends.
#pragma once

#include <string_view>

namespace hysteron {

/// Without blanks at both ends: spaces and tabs, where no others are named.
[[nodiscard]] constexpr std::string_view trimmed(std::string_view text, std::string_view blanks = " \t") {
  const auto first = text.find_first_not_of(blanks);
  return first == std::string_view::npos ? text.substr(0, 0)
                                         : text.substr(first, text.find_last_not_of(blanks) + 1 - first);
}

}  // namespace hysteron
