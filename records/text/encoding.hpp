// The bytes of a text file as UTF-8.
#pragma once

#include <cstddef>
#include <string>

namespace hysteron::records {

struct DecodedText {
  std::string text{};
  std::string encoding{};       ///< what it was, where that was not UTF-8
  std::size_t empty_bytes = 0;  ///< behind the text, that were laid out and not written
};

/// Reads UTF-8, UTF-16 with or without a byte order mark, and Windows-1252 where the bytes are no UTF-8: loggers of
/// Windows write µ and ° so. Throws InputError HY510 where the bytes are no text at all; `file` stands in its place.
[[nodiscard]] DecodedText decoded(const std::string& file, std::string bytes);

}  // namespace hysteron::records
