// The mark that some editors put before a text in UTF-8. It is no part of the text.
#pragma once

#include <string>
#include <string_view>

namespace hysteron {

inline constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";

/// The text itself.
[[nodiscard]] inline std::string without_mark(std::string text) {
  if (text.starts_with(byte_order_mark)) {
    text.erase(0, byte_order_mark.size());
  }
  return text;
}

}  // namespace hysteron
