#include "support/utf8.hpp"

#include <cstdint>
#include <cstring>

namespace hysteron {
namespace {

constexpr unsigned char byte_at(std::string_view text, std::size_t index) {
  return index < text.size() ? static_cast<unsigned char>(text[index]) : 0;
}

constexpr bool within(unsigned char byte, unsigned char low, unsigned char high) {
  return byte >= low && byte <= high;
}

/// The length of the well-formed character at the front, 0 where it is malformed.
std::size_t well_formed_length(std::string_view text) {
  const unsigned char first = byte_at(text, 0);
  const unsigned char second = byte_at(text, 1);
  const auto continues = [&](std::size_t index) { return within(byte_at(text, index), 0x80, 0xBF); };
  if (first < 0x80) {
    return 1;
  }
  if (within(first, 0xC2, 0xDF)) {
    return continues(1) ? 2 : 0;
  }
  if (within(first, 0xE0, 0xEF)) {
    const bool allowed = within(second, first == 0xE0 ? 0xA0 : 0x80, first == 0xED ? 0x9F : 0xBF);
    return allowed && continues(2) ? 3 : 0;
  }
  if (within(first, 0xF0, 0xF4)) {
    const bool allowed = within(second, first == 0xF0 ? 0x90 : 0x80, first == 0xF4 ? 0x8F : 0xBF);
    return allowed && continues(2) && continues(3) ? 4 : 0;
  }
  return 0;
}

/// The C1 controls U+0080 to U+009F: some terminals obey them as they do ESC.
bool is_control(std::string_view character) {
  const unsigned char first = byte_at(character, 0);
  if (character.size() == 1) {
    return (first < 0x20 && first != '\t') || first == 0x7F;
  }
  return first == 0xC2 && byte_at(character, 1) < 0xA0;
}

}  // namespace

std::size_t first_invalid_utf8(std::string_view text) {
  std::size_t offset = 0;
  while (offset < text.size()) {
    // Records are nearly all ASCII: eight bytes at a time while no high bit is set.
    std::uint64_t word = 0;
    if (text.size() - offset >= sizeof word) {
      std::memcpy(&word, text.data() + offset, sizeof word);
      if ((word & 0x8080808080808080ULL) == 0) {
        offset += sizeof word;
        continue;
      }
    }
    const std::size_t length = well_formed_length(text.substr(offset));
    if (length == 0) {
      return offset;
    }
    offset += length;
  }
  return std::string_view::npos;
}

std::size_t utf8_length(std::string_view text) {
  const std::size_t length = well_formed_length(text);
  return length == 0 ? 1 : length;
}

std::size_t character_count(std::string_view text) {
  std::size_t count = 0;
  for (; !text.empty(); text.remove_prefix(utf8_length(text))) {
    ++count;
  }
  return count;
}

std::string clipped(std::string_view text, std::size_t most) {
  if (character_count(text) <= most) {
    return std::string(text);
  }
  std::size_t end = 0;
  for (std::size_t kept = 1; kept < most; ++kept) {
    end += utf8_length(text.substr(end));
  }
  return std::string(text.substr(0, end)) + "…";
}

std::string printable(std::string_view text) {
  constexpr std::string_view replacement = "\xEF\xBF\xBD";
  std::string result;
  result.reserve(text.size());
  while (!text.empty()) {
    const std::size_t length = well_formed_length(text);
    const auto character = text.substr(0, length == 0 ? 1 : length);
    result += length == 0 || is_control(character) ? replacement : character;
    text.remove_prefix(character.size());
  }
  return result;
}

}  // namespace hysteron
