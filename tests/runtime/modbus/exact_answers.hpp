// Every function code with every length of a PDU, each answer held against the oracle; and every way to cut a request.
#pragma once

#include <cstdint>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "runtime/modbus/connection.hpp"
#include "tests/runtime/modbus/memory_door.hpp"
#include "tests/runtime/modbus/oracle.hpp"

namespace hysteron::test {

using Bytes = std::vector<std::uint8_t>;

inline std::string hex(const Bytes& bytes) {
  std::string text;
  for (const std::uint8_t byte : bytes) {
    constexpr const char* digits = "0123456789abcdef";
    text += {digits[byte >> 4U], digits[byte & 15U], ' '};
  }
  return text;
}

/// A request of a function and length, of which many are sound.
inline Bytes request_of(int function, std::size_t size, std::mt19937& random) {
  Bytes pdu(size);
  for (auto& byte : pdu) {
    byte = static_cast<std::uint8_t>(random());
  }
  pdu[0] = static_cast<std::uint8_t>(function);
  const auto put = [&](std::size_t at, std::size_t value) {
    if (at + 1 < size) {
      pdu[at] = static_cast<std::uint8_t>(value >> 8U);
      pdu[at + 1] = static_cast<std::uint8_t>(value & 0xFFU);
    }
  };
  const auto address = [&] { return random() % 16 == 0 ? 40000 + random() % 700 : random() % 48; };
  const auto count = [&](std::size_t most) { return random() % 16 == 0 ? random() % 3000 : 1 + random() % most; };
  if (random() % 16 == 0) {
    return pdu;
  }
  put(1, address());
  put(3, count(8));
  if (function == 5) {
    put(3, random() % 2 * 0xFF00);
  } else if ((function == 15 || function == 16) && size > 6) {
    const std::size_t data = size - 6;
    put(1, random() % 24);
    put(3, function == 16 ? data / 2 : 8 * data - random() % 8);
    pdu[5] = static_cast<std::uint8_t>(data);
  } else if (function == 23 && size > 10) {
    put(5, random() % 24);
    put(7, (size - 10) / 2);
    pdu[9] = static_cast<std::uint8_t>(size - 10);
  } else if (function == 43 && size > 2) {
    pdu[1] = 14;
    pdu[2] = static_cast<std::uint8_t>(random() % 6);
  }
  return pdu;
}

struct ExactAnswers {
  std::uint64_t answers = 0;
  std::uint64_t exceptions = 0;
  std::string first_wrong{};  ///< the request, what came, what should have come
};

/// The longest PDU is one byte too long.
inline ExactAnswers every_function_and_length(runtime::modbus::WordOrder order) {
  namespace modbus = runtime::modbus;
  MemoryDoor door(points_of_every_type());
  const modbus::RegisterMap map = modbus::make_register_map(door.points(), {.title = "BENCH", .order = order});
  modbus::Responder responder(map, door, {});
  Oracle oracle(map);
  std::mt19937 random(5 + static_cast<unsigned>(order));
  ExactAnswers result;
  for (int function = 0; function < 256; ++function) {
    for (std::size_t size = 1; size <= 254; ++size) {
      const Bytes pdu = request_of(function, size, random);
      const Bytes expected = oracle.answer(pdu);
      const modbus::Reply reply = responder.answer(pdu, {});
      const Bytes got(reply.pdu().begin(), reply.pdu().end());
      if (got != expected && result.first_wrong.empty()) {
        result.first_wrong = hex(pdu) + "→ " + hex(got) + "not " + hex(expected);
      }
      ++result.answers;
      result.exceptions += got[0] >= 128 ? 1 : 0;
    }
  }
  return result;
}

struct EveryCut {
  std::uint64_t ways = 0;
  std::uint64_t wrong = 0;  ///< an answer too early, or another one
};

/// A request of 12 bytes, cut into segments in every way.
inline EveryCut cut_every_way() {
  namespace modbus = runtime::modbus;
  const Bytes request{0x12, 0x34, 0, 0, 0, 6, 1, 3, 0, 0, 0, 2};
  MemoryDoor door(points_of_every_type());
  const modbus::RegisterMap map = modbus::make_register_map(door.points(), {.title = "B"});
  modbus::Responder responder(map, door, {});
  const modbus::Instant start{};
  Bytes expected;
  EveryCut result;
  for (unsigned cuts = 0; cuts < 1U << (request.size() - 1); ++cuts) {
    modbus::Connection connection(start, {});
    bool early = false;
    std::size_t from = 0;
    for (std::size_t end = 1; end <= request.size(); ++end) {
      if (end == request.size() || (cuts >> (end - 1) & 1U) != 0) {
        early = early || !connection.output().empty();
        connection.received(std::span(request).subspan(from, end - from), start + modbus::milliseconds(end), responder,
                            {});
        from = end;
      }
    }
    const Bytes got(connection.output().begin(), connection.output().end());
    expected = cuts == 0 ? got : expected;  // what the whole request is answered
    connection.sent(got.size(), start);
    const bool lives = connection.due(start + modbus::milliseconds(5000)) == std::nullopt;
    result.wrong += early || !lives || got.size() != 13 || got != expected ? 1 : 0;
    ++result.ways;
  }
  return result;
}

}  // namespace hysteron::test
