// The text of an open document, and the two ways to name a place in it: by offset, and as the protocol does.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace hysteron::lsp {

/// What the protocol counts within a line. UTF-16 is its default; a client may agree on UTF-8.
enum class Encoding : std::uint8_t { Utf16, Utf8 };

/// Line and character count from 0, as in LSP 3.17, "Position".
struct Position {
  std::uint64_t line = 0;
  std::uint64_t character = 0;
};

/// The offset in bytes of a position. A line that is not there is the end of the text; a character behind the end of
/// its line is that end; a position within a character is the begin of it.
[[nodiscard]] std::size_t offset_of(std::string_view text, Position position, Encoding encoding);

/// The position of an offset in bytes; one behind the end of the text is that end.
[[nodiscard]] Position position_of(std::string_view text, std::size_t offset, Encoding encoding);

/// The offset of a place of a diagnostic: line and column from 1, in characters. A byte order mark is in no column.
[[nodiscard]] std::size_t offset_of_place(std::string_view text, std::uint32_t line, std::uint32_t column);

/// The path that a URI names: what is behind file://, its %XX decoded. Another URI is its own path.
[[nodiscard]] std::string path_of(std::string_view uri);

}  // namespace hysteron::lsp
