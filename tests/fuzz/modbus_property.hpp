// What holds for every sequence of bytes whatever that a client sends to the Modbus server.
#pragma once

#include <algorithm>
#include <span>
#include <string>
#include <vector>

#include "runtime/modbus/connection.hpp"
#include "tests/runtime/modbus/memory_door.hpp"

namespace hysteron::test {

/// What is wrong with the answers; empty if nothing. The first byte says how the rest is cut into segments.
inline std::string flaw_of_conversation(std::span<const std::uint8_t> bytes) {
  namespace modbus = runtime::modbus;
  static MemoryDoor door(points_of_every_type());
  static const modbus::RegisterMap map = modbus::make_register_map(door.points(), {.title = "FUZZ"});
  static modbus::Responder responder(map, door, {});
  if (bytes.empty()) {
    return "";
  }
  const std::size_t step = 1U + bytes[0] % 64U;
  bytes = bytes.subspan(1);
  modbus::Connection connection({}, {});
  std::vector<std::uint8_t> answers;
  std::size_t requests = 0;
  while (!bytes.empty() && connection.wants_input() > 0) {
    const auto segment = bytes.first(std::min({step, bytes.size(), connection.wants_input()}));
    requests += connection.received(segment, {}, responder, {}).requests;
    answers.insert(answers.end(), connection.output().begin(), connection.output().end());
    connection.sent(connection.output().size(), {});
    bytes = bytes.subspan(segment.size());
  }
  for (std::span<const std::uint8_t> rest(answers); !rest.empty(); --requests) {
    const modbus::FrameScan scan = modbus::scan_frame(rest);
    if (scan.status != modbus::FrameStatus::complete || requests == 0) {
      return "an answer that is no frame, or one too many";
    }
    if ((scan.frame.pdu[0] & 0x80U) != 0 && scan.frame.pdu.size() != 2) {
      return "an exception of another length than two";
    }
    rest = rest.subspan(scan.size);
  }
  if (requests != 0) {
    return "a request without an answer";
  }
  runtime::Snapshot now;
  door.read(now);
  for (std::size_t i = 0; i < now.values.size(); ++i) {
    const runtime::Point& point = door.points()[i];
    if (!(now.values[i] >= point.low && now.values[i] <= point.high) || (!point.writable && now.values[i] != 0.0)) {
      return point.name + " has a value that nobody may write";
    }
  }
  return "";
}

}  // namespace hysteron::test
