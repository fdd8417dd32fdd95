#include "records/text/encoding.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>

#include "support/byte_order_mark.hpp"
#include "support/diagnostic.hpp"
#include "support/errors.hpp"
#include "support/utf8.hpp"

namespace hysteron::records {
namespace {

using namespace std::string_literals;

void append_utf8(std::string& text, std::uint32_t code) {
  if (code < 0x80) {
    text += static_cast<char>(code);
  } else if (code < 0x800) {
    text += static_cast<char>(0xC0U | (code >> 6U));
    text += static_cast<char>(0x80U | (code & 0x3FU));
  } else if (code < 0x10000) {
    text += static_cast<char>(0xE0U | (code >> 12U));
    text += static_cast<char>(0x80U | ((code >> 6U) & 0x3FU));
    text += static_cast<char>(0x80U | (code & 0x3FU));
  } else {
    text += static_cast<char>(0xF0U | (code >> 18U));
    text += static_cast<char>(0x80U | ((code >> 12U) & 0x3FU));
    text += static_cast<char>(0x80U | ((code >> 6U) & 0x3FU));
    text += static_cast<char>(0x80U | (code & 0x3FU));
  }
}

/// Which byte of a pair is the high one, where the text is UTF-16.
enum class Order : std::uint8_t { Little, Big };

std::optional<Order> utf16_order(std::string_view bytes) {
  if (bytes.starts_with("\xFF\xFE")) {
    return Order::Little;
  }
  if (bytes.starts_with("\xFE\xFF")) {
    return Order::Big;
  }
  // Without a mark: a table of numbers has a zero in every second byte, and always in the same.
  const std::string_view head = bytes.substr(0, 400);
  std::array<std::size_t, 2> zeros{};
  for (std::size_t i = 0; i < head.size(); ++i) {
    zeros.at(i % 2) += head[i] == '\0' ? 1 : 0;
  }
  if (head.size() < 8 || zeros[0] + zeros[1] < head.size() * 2 / 5) {
    return std::nullopt;
  }
  return zeros[0] == 0 ? std::optional(Order::Little) : zeros[1] == 0 ? std::optional(Order::Big) : std::nullopt;
}

std::string from_utf16(std::string_view bytes, Order order) {
  std::string text;
  text.reserve(bytes.size() / 2);
  const auto unit_at = [&](std::size_t i) -> std::uint32_t {
    const auto first = static_cast<unsigned char>(bytes[i]);
    const auto second = static_cast<unsigned char>(bytes[i + 1]);
    return order == Order::Little ? first | (second << 8U) : second | (first << 8U);
  };
  for (std::size_t i = 0; i + 1 < bytes.size(); i += 2) {
    std::uint32_t code = unit_at(i);
    if (code >= 0xD800 && code < 0xDC00 && i + 3 < bytes.size()) {
      if (const std::uint32_t low = unit_at(i + 2); low >= 0xDC00 && low < 0xE000) {
        code = 0x10000 + ((code - 0xD800) << 10U) + (low - 0xDC00);
        i += 2;
      }
    }
    append_utf8(text, code >= 0xD800 && code < 0xE000 ? 0xFFFD : code);
  }
  return text;
}

/// 0x80 to 0x9F of Windows-1252; 0 where it has no character.
constexpr std::array<std::uint16_t, 32> windows_1252{0x20AC, 0,      0x201A, 0x0192, 0x201E, 0x2026, 0x2020, 0x2021,
                                                     0x02C6, 0x2030, 0x0160, 0x2039, 0x0152, 0,      0x017D, 0,
                                                     0,      0x2018, 0x2019, 0x201C, 0x201D, 0x2022, 0x2013, 0x2014,
                                                     0x02DC, 0x2122, 0x0161, 0x203A, 0x0153, 0,      0x017E, 0x0178};

std::optional<std::string> from_windows_1252(std::string_view bytes) {
  std::string text;
  text.reserve(bytes.size() + bytes.size() / 8);
  for (const char c : bytes) {
    const auto byte = static_cast<unsigned char>(c);
    const std::uint32_t code = byte >= 0x80 && byte < 0xA0 ? windows_1252.at(byte - 0x80U) : byte;
    if (code == 0) {
      return std::nullopt;
    }
    append_utf8(text, code);
  }
  return text;
}

/// The first byte that no table holds.
std::size_t first_control(std::string_view text) {
  const auto found = std::ranges::find_if(text, [](char c) {
    return c >= 0 && c < ' ' && c != '\n' && c != '\r' && c != '\t' && c != '\f' && c != '\v' && c != '\x1A';
  });
  return found == text.end() ? std::string_view::npos : static_cast<std::size_t>(found - text.begin());
}

[[noreturn]] void refuse(const std::string& file, std::string_view text, std::size_t bad) {
  const auto before = text.substr(0, bad);
  const auto begin = before.rfind('\n') == std::string_view::npos ? 0 : before.rfind('\n') + 1;
  const Place place{.file = file,
                    .line = static_cast<std::uint32_t>(std::ranges::count(before, '\n')) + 1,
                    .column = static_cast<std::uint32_t>(character_count(text.substr(begin, bad - begin))) + 1};
  throw InputError(error::not_text, place,
                   fmt::format("The byte 16#{:02X} belongs to no text.", static_cast<unsigned char>(text[bad])),
                   "export the record as CSV; a damaged file has to be saved anew.");
}

/// What a terminal is told between the words, ESC [ 0 ; 3 2 m of a colour, as blanks.
void clear_colours(std::string& text) {
  for (std::size_t at = 0; (at = text.find("\x1B[", at)) != std::string::npos;) {
    const auto end = text.find_first_not_of("0123456789;", at + 2);
    if (end == std::string::npos || (text[end] != 'm' && text[end] != 'K')) {
      return;
    }
    std::fill(text.begin() + static_cast<std::ptrdiff_t>(at), text.begin() + static_cast<std::ptrdiff_t>(end) + 1, ' ');
  }
}

/// Old programs end lines by CR alone, and Python on Windows by CR CR LF where newline='' was forgotten; a name in
/// quotes may go over several lines, as in spreadsheets. Both keep the length of the text; a line end in a name becomes
/// the vertical tab, which is a blank.
void settle_line_ends(std::string& text) {
  if (text.find('\n') == std::string::npos) {
    std::ranges::replace(text, '\r', '\n');
  }
  for (std::size_t at = 0; (at = text.find("\r\r\n", at)) != std::string::npos; ++at) {
    text[at] = ' ';
  }
  constexpr std::size_t most = 4000;  // names stand at the top
  for (std::size_t at = 0; at < std::min(most, text.size()); ++at) {
    const bool opens =
        text[at] == '"' && (at == 0 || std::string_view(",;\t\n|").find(text[at - 1]) != std::string_view::npos);
    const auto closing = opens ? text.find('"', at + 1) : std::string::npos;
    const bool closes =
        closing != std::string::npos && closing - at <= 200 &&
        (closing + 1 == text.size() || std::string_view(",;\t|\r\n").find(text[closing + 1]) != std::string_view::npos);
    if (!closes) {
      continue;
    }
    for (; at < closing; ++at) {
      text[at] = text[at] == '\n' ? '\v' : text[at] == '\r' ? ' ' : text[at];
    }
  }
}

DecodedText decoded_bytes(const std::string& file, std::string bytes) {
  if (const auto order = utf16_order(bytes)) {
    DecodedText result{.text = without_mark(from_utf16(bytes, *order)), .encoding = "UTF-16"};
    if (const auto bad = first_control(result.text); bad != std::string_view::npos) {
      refuse(file, result.text, bad);
    }
    return result;
  }
  if (const auto bad = first_control(bytes); bad != std::string_view::npos) {
    refuse(file, bytes, bad);
  }
  bytes = without_mark(std::move(bytes));
  const auto bad = first_invalid_utf8(bytes);
  if (bad == std::string_view::npos) {
    return {.text = std::move(bytes)};
  }
  auto text = from_windows_1252(bytes);
  if (!text) {
    refuse(file, bytes, bad);
  }
  return {.text = std::move(*text), .encoding = "Windows-1252"};
}

}  // namespace

DecodedText decoded(const std::string& file, std::string bytes) {
  // Loggers lay a file out beforehand: what they have not written are zeros, or the ones of an empty flash memory.
  const auto written = bytes.find_last_not_of("\0\xFF"s);
  const std::size_t empty = written == std::string::npos ? 0 : bytes.size() - written - 1;
  if (empty > 2) {
    bytes.resize(written + 1);
  }
  clear_colours(bytes);
  DecodedText result = decoded_bytes(file, std::move(bytes));
  result.empty_bytes = empty > 2 ? empty : 0;
  settle_line_ends(result.text);
  return result;
}

}  // namespace hysteron::records
