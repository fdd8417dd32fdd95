// UTF-8: where a text stops being UTF-8, how many characters it has, and a form of it that is safe to print.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace hysteron {

/// The offset of the first byte that is not part of a well-formed UTF-8 sequence (Unicode 15, table 3-7: no
/// surrogates, no overlong forms), or npos where the whole text is UTF-8.
[[nodiscard]] std::size_t first_invalid_utf8(std::string_view text);

/// The length in bytes of the character at the front of a text that is not empty; 1 where it is malformed.
[[nodiscard]] std::size_t utf8_length(std::string_view text);

/// The number of characters (code points); a malformed byte counts as one.
[[nodiscard]] std::size_t character_count(std::string_view text);

/// At most so many characters, with an ellipsis for the rest.
[[nodiscard]] std::string clipped(std::string_view text, std::size_t most);

/// The text with control characters (other than the tab) and malformed bytes replaced by U+FFFD, so that a hostile
/// file can neither move the cursor of a terminal nor break a JSON document.
[[nodiscard]] std::string printable(std::string_view text);

}  // namespace hysteron
