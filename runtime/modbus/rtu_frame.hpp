// Framing of Modbus RTU: a frame is the unit, the PDU and a checksum of 16 bits, its low byte first. Pure functions.
//
// Nothing in a frame says how long it is. Silence ends it; before that, its function tells how long a request or an
// answer is, and the checksum whether it is one.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace hysteron::runtime::modbus {

inline constexpr std::size_t shortest_rtu_frame = 4;
inline constexpr std::size_t longest_rtu_frame = 256;

/// CRC-16 of the specification: polynomial 0xA001, from 0xFFFF; 0 over a frame with its own behind it.
[[nodiscard]] constexpr std::uint16_t rtu_checksum(std::span<const std::uint8_t> bytes) {
  std::uint32_t sum = 0xFFFF;
  for (const std::uint8_t byte : bytes) {
    sum ^= byte;
    for (int bit = 0; bit < 8; ++bit) {
      sum = (sum & 1U) != 0 ? sum >> 1U ^ 0xA001U : sum >> 1U;
    }
  }
  return static_cast<std::uint16_t>(sum);
}

[[nodiscard]] constexpr bool is_rtu_frame(std::span<const std::uint8_t> bytes) {
  return bytes.size() >= shortest_rtu_frame && bytes.size() <= longest_rtu_frame && rtu_checksum(bytes) == 0;
}

/// A frame of a unit and its PDU.
[[nodiscard]] inline std::vector<std::uint8_t> rtu_frame(std::uint8_t unit, std::span<const std::uint8_t> pdu) {
  std::vector<std::uint8_t> frame(1 + pdu.size() + 2);
  frame[0] = unit;
  std::copy(pdu.begin(), pdu.end(), frame.begin() + 1);
  const std::uint16_t sum = rtu_checksum(std::span(frame).first(1 + pdu.size()));
  frame[1 + pdu.size()] = static_cast<std::uint8_t>(sum & 0xFFU);
  frame[2 + pdu.size()] = static_cast<std::uint8_t>(sum >> 8U);
  return frame;
}

/// How long a request is that begins so; 0 where its function does not tell, or not yet.
[[nodiscard]] constexpr std::size_t rtu_request_size(std::span<const std::uint8_t> bytes) {
  const auto counted = [&](std::size_t at) { return bytes.size() > at ? at + 1 + bytes[at] + 2 : std::size_t{0}; };
  switch (bytes.size() < 2 ? 0 : bytes[1]) {
    case 1:
    case 2:
    case 3:
    case 4:
    case 5:
    case 6:
      return 8;
    case 15:
    case 16:
      return counted(6);
    case 20:
      return counted(2);
    case 22:
      return 10;
    case 23:
      return counted(10);
    case 43:
      return 7;
    default:
      return 0;
  }
}

/// The same of an answer.
[[nodiscard]] constexpr std::size_t rtu_answer_size(std::span<const std::uint8_t> bytes) {
  const std::uint8_t function = bytes.size() < 2 ? 0 : bytes[1];
  switch (function) {
    case 1:
    case 2:
    case 3:
    case 4:
    case 20:
    case 23:
      return bytes.size() > 2 ? std::size_t{3} + bytes[2] + 2 : 0;
    case 5:
    case 6:
    case 15:
    case 16:
      return 8;
    case 22:
      return 10;
    default:
      return function >= 0x80 ? 5 : 0;
  }
}

}  // namespace hysteron::runtime::modbus
