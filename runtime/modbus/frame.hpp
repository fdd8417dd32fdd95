// Framing of Modbus TCP: from a stream of bytes to requests, as a pure function of the bytes.
//
// A frame is the MBAP header (transaction 2, protocol 2, length 2, unit 1) and the PDU of 1 to 253 bytes; the length
// counts the unit and the PDU. Whether a header can be one is decided with the first byte that says so: what is no
// frame is never waited for, and never answered, because nobody knows where the next one begins.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace hysteron::runtime::modbus {

inline constexpr std::size_t header_size = 7;
inline constexpr std::size_t longest_pdu = 253;
inline constexpr std::size_t longest_frame = header_size + longest_pdu;

struct Frame {
  std::uint16_t transaction = 0;
  std::uint8_t unit = 0;
  std::span<const std::uint8_t> pdu{};
};

enum class FrameStatus : std::uint8_t {
  incomplete,      ///< what is there may become a frame
  complete,        ///< the first `size` bytes are one
  wrong_protocol,  ///< a protocol identifier other than 0
  wrong_length,    ///< a length that no frame has
};

struct FrameScan {
  FrameStatus status = FrameStatus::incomplete;
  std::size_t size = 0;  ///< bytes of the complete frame
  Frame frame{};
};

/// The frame at the start of the bytes.
[[nodiscard]] constexpr FrameScan scan_frame(std::span<const std::uint8_t> bytes) {
  if ((bytes.size() > 2 && bytes[2] != 0) || (bytes.size() > 3 && bytes[3] != 0)) {
    return {.status = FrameStatus::wrong_protocol};
  }
  if (bytes.size() > 4 && bytes[4] != 0) {
    return {.status = FrameStatus::wrong_length};
  }
  if (bytes.size() < 6) {
    return {};
  }
  const std::size_t length = bytes[5];
  if (length < 2 || length > 1 + longest_pdu) {
    return {.status = FrameStatus::wrong_length};
  }
  if (bytes.size() < 6 + length) {
    return {};
  }
  return {.status = FrameStatus::complete,
          .size = 6 + length,
          .frame = {.transaction = static_cast<std::uint16_t>(bytes[0] << 8U | bytes[1]),
                    .unit = bytes[6],
                    .pdu = bytes.subspan(header_size, length - 1)}};
}

/// The header of an answer to a request, for a PDU of that size.
[[nodiscard]] constexpr std::array<std::uint8_t, header_size> header_of(const Frame& request, std::size_t pdu_size) {
  return {static_cast<std::uint8_t>(request.transaction >> 8U),
          static_cast<std::uint8_t>(request.transaction & 0xFFU),
          0,
          0,
          0,
          static_cast<std::uint8_t>(1 + pdu_size),
          request.unit};
}

}  // namespace hysteron::runtime::modbus
