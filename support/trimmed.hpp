// A text without the blanks at its ends.
#pragma once

#include <string_view>

namespace hysteron {

/// Without spaces and tabs at both ends.
[[nodiscard]] constexpr std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t");
  return first == std::string_view::npos ? text.substr(0, 0)
                                         : text.substr(first, text.find_last_not_of(" \t") + 1 - first);
}

}  // namespace hysteron
