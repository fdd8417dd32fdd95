// Classes of characters, of ASCII alone: what std::isdigit says depends on the locale.
#pragma once

namespace hysteron::records {

[[nodiscard]] constexpr bool is_digit(char c) {
  return c >= '0' && c <= '9';
}
[[nodiscard]] constexpr bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

}  // namespace hysteron::records
