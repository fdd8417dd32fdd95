// A serial line with noise: requests to this station and to others, whole or damaged, in pieces, with bytes between.
#pragma once

#include <chrono>
#include <cstdint>
#include <random>
#include <vector>

#include "runtime/modbus/rtu_frame.hpp"
#include "runtime/modbus/rtu_station.hpp"
#include "tests/runtime/modbus/memory_door.hpp"
#include "tests/runtime/modbus/oracle.hpp"

namespace hysteron::test {

struct NoisyLine {
  std::uint64_t frames = 0;
  std::uint64_t answered = 0;
  std::uint64_t unanswered = 0;  ///< sound requests to this station without their exact answer
  std::uint64_t unasked = 0;     ///< answers to what was damaged, or to another station
  std::uint64_t writes = 0;      ///< that nobody asked for
};

inline NoisyLine talk_on_a_noisy_line(std::uint64_t count) {
  namespace modbus = runtime::modbus;
  constexpr std::uint8_t own = 17;
  const modbus::RtuTiming timing{.silence = std::chrono::microseconds(1750),
                                 .longest_gap = std::chrono::milliseconds(20)};
  MemoryDoor door(points_of_every_type());
  const auto map = modbus::make_register_map(door.points(), {.title = "B"});
  modbus::Responder responder(map, door, {});
  modbus::RtuStation station(own, timing, false);
  std::mt19937 random(23);
  modbus::Instant now{modbus::Instant{} + std::chrono::hours(1)};
  NoisyLine result;
  const std::vector<std::uint8_t> read{3, 0, 20, 0, 2};
  const auto reply = responder.answer(read, {});
  const auto answer = modbus::rtu_frame(own, std::vector<std::uint8_t>(reply.pdu().begin(), reply.pdu().end()));
  const auto writes_before = door.writes();
  for (; result.frames < count; ++result.frames) {
    const bool is_own = random() % 3 != 0;
    auto frame = modbus::rtu_frame(is_own ? own : std::uint8_t{18}, read);
    const bool is_damaged = random() % 2 == 0;
    if (is_damaged) {
      frame[random() % frame.size()] ^= static_cast<std::uint8_t>(1U << random() % 8);
    }
    // In one to three pieces, sometimes with noise before, which a silence ends.
    if (random() % 4 == 0) {
      std::vector<std::uint8_t> noise(1 + random() % 7);
      for (auto& byte : noise) {
        byte = static_cast<std::uint8_t>(random());
      }
      (void)station.received(noise, now, responder, {});
      now += timing.longest_gap + std::chrono::microseconds(1);
      (void)station.silent(now, responder, {});
    }
    const std::size_t cut = random() % frame.size();
    (void)station.received(std::span(frame).first(cut), now, responder, {});
    now += std::chrono::milliseconds(1);
    (void)station.received(std::span(frame).subspan(cut), now, responder, {});
    now += timing.silence;
    auto output = station.output(now);
    if (output.empty()) {
      now += timing.longest_gap + std::chrono::microseconds(1);
      (void)station.silent(now, responder, {});
      now += timing.silence;
      output = station.output(now);
    }
    const std::vector<std::uint8_t> said(output.begin(), output.end());
    station.sent(said.size(), now);
    result.answered += said == answer ? 1 : 0;
    result.unanswered += is_own && !is_damaged && said != answer ? 1 : 0;
    result.unasked += (!is_own || is_damaged) && !said.empty() ? 1 : 0;
    now += timing.longest_gap + std::chrono::microseconds(1);
    (void)station.silent(now, responder, {});
  }
  result.writes = door.writes() - writes_before;
  return result;
}

}  // namespace hysteron::test
