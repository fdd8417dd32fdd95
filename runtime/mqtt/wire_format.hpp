// The wire format of Protocol Buffers, as far as Sparkplug B needs it: fields written one behind the other, and read
// back. https://protobuf.dev/programming-guides/encoding
#pragma once

#include <bit>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace hysteron::runtime {

class WireWriter {
 public:
  void varint(std::uint32_t field, std::uint64_t value) {
    head(field, 0);
    raw(value);
  }
  void real(std::uint32_t field, double value) {
    head(field, 1);
    fixed(std::bit_cast<std::uint64_t>(value), 8);
  }
  void real(std::uint32_t field, float value) {
    head(field, 5);
    fixed(std::bit_cast<std::uint32_t>(value), 4);
  }
  /// A text, or a message within.
  void bytes(std::uint32_t field, std::string_view value) {
    head(field, 2);
    raw(value.size());
    bytes_ += value;
  }
  [[nodiscard]] const std::string& written() const { return bytes_; }

 private:
  void head(std::uint32_t field, std::uint32_t kind) { raw(field << 3U | kind); }
  void raw(std::uint64_t value) {
    for (; value >= 0x80; value >>= 7U) {
      bytes_ += static_cast<char>(value | 0x80U);
    }
    bytes_ += static_cast<char>(value);
  }
  /// Lowest byte first.
  void fixed(std::uint64_t value, int size) {
    for (int i = 0; i < size; ++i, value >>= 8U) {
      bytes_ += static_cast<char>(value & 0xFFU);
    }
  }

  std::string bytes_{};
};

struct WireField {
  std::uint32_t number = 0;
  std::uint64_t value = 0;   ///< of a varint or a fixed number, its bits
  std::string_view bytes{};  ///< of a text or message
};

/// The fields of a message that somebody sent: nothing in it is trusted.
class WireReader {
 public:
  explicit WireReader(std::string_view bytes) : bytes_(bytes) {}

  /// The next field; nothing at the end, and where the rest is no field.
  [[nodiscard]] std::optional<WireField> next() {
    const auto head = varint();
    if (!head || *head >> 3U == 0 || *head >> 3U > 0x1FFFFFFF) {
      return std::nullopt;
    }
    WireField field{.number = static_cast<std::uint32_t>(*head >> 3U)};
    std::optional<std::uint64_t> value;
    switch (*head & 7U) {
      case 0:
        value = varint();
        break;
      case 1:
        value = fixed(8);
        break;
      case 2:
        value = varint();
        if (!value || *value > bytes_.size()) {
          return std::nullopt;
        }
        field.bytes = bytes_.substr(0, static_cast<std::size_t>(*value));
        bytes_.remove_prefix(static_cast<std::size_t>(*value));
        return field;
      case 5:
        value = fixed(4);
        break;
      default:
        break;
    }
    if (!value) {
      return std::nullopt;
    }
    field.value = *value;
    return field;
  }

 private:
  std::optional<std::uint64_t> varint() {
    std::uint64_t value = 0;
    for (unsigned shift = 0; shift < 64 && !bytes_.empty(); shift += 7) {
      const auto byte = static_cast<unsigned char>(bytes_.front());
      bytes_.remove_prefix(1);
      value |= static_cast<std::uint64_t>(byte & 0x7FU) << shift;
      if ((byte & 0x80U) == 0) {
        return value;
      }
    }
    return std::nullopt;
  }
  std::optional<std::uint64_t> fixed(std::size_t size) {
    if (bytes_.size() < size) {
      return std::nullopt;
    }
    std::uint64_t value = 0;
    for (std::size_t i = size; i > 0; --i) {
      value = value << 8U | static_cast<unsigned char>(bytes_[i - 1]);
    }
    bytes_.remove_prefix(size);
    return value;
  }

  std::string_view bytes_;
};

}  // namespace hysteron::runtime
