// The server on a serial line, as a pure function of the bytes on it and of a given now. No line, no clock.
//
// A line has one master and several stations; each hears everything. Requests to this unit are answered, those to unit
// 0 are carried out and not answered, all others are passed over, with the answers of others. A frame ends with a
// silence of 3.5 characters, 1.75 ms at least; an answer waits for that. Bytes that come later than a frame's
// `longest_gap` begin a new one. What is no frame then is counted and forgotten. The specification lets no gap within a
// frame be longer than 1.5 characters; no program beside a kernel's buffer can measure that, so the gap is an option.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "runtime/modbus/connection.hpp"
#include "runtime/modbus/responder.hpp"
#include "runtime/modbus/rtu_frame.hpp"

namespace hysteron::runtime::modbus {

struct RtuTiming {
  std::chrono::nanoseconds silence{};      ///< before an answer
  std::chrono::nanoseconds longest_gap{};  ///< between two reads of bytes of one frame
};

/// 3.5 characters of 11 bits, and 1.75 ms above 19200 baud.
[[nodiscard]] std::chrono::nanoseconds rtu_silence(int baud);

/// Counted since the start.
struct RtuCounts {
  std::uint64_t frames = 0;      ///< sound ones on the line, of every unit
  std::uint64_t broken = 0;      ///< bytes that are none, up to a silence: checksum, length, a torn frame
  std::uint64_t broadcasts = 0;  ///< requests to unit 0
  std::uint64_t echo_lost = 0;   ///< answers that did not come back as they were sent: two spoke at once
};

class RtuStation {
 public:
  /// `has_echo`: the line's adapter gives back what is sent.
  RtuStation(std::uint8_t unit, const RtuTiming& timing, bool has_echo)
      : unit_(unit), timing_(timing), has_echo_(has_echo) {}

  /// Takes bytes from the line, and answers a request that is whole.
  Served received(std::span<const std::uint8_t> bytes, Instant now, Responder& responder, const Caller& caller);
  /// To be called as time goes by: a silence ends a frame whose length its function does not tell.
  Served silent(Instant now, Responder& responder, const Caller& caller);

  /// What is to be sent now; empty while the line has to be silent.
  [[nodiscard]] std::span<const std::uint8_t> output(Instant now) const;
  void sent(std::size_t count, Instant now);
  /// When silent() or output() have something to do next.
  [[nodiscard]] std::optional<Instant> next_deadline() const;
  [[nodiscard]] const RtuCounts& counts() const { return counts_; }
  /// The line was lost: what was on it is forgotten.
  void reset();

 private:
  [[nodiscard]] bool is_own(std::uint8_t unit) const { return unit == unit_ || unit == 0; }
  [[nodiscard]] std::size_t whole_frame() const;
  void take_echo(std::span<const std::uint8_t>& bytes, Instant now);
  void forget_output();
  Served frames(Instant now, Responder& responder, const Caller& caller);
  Served answer(std::span<const std::uint8_t> frame, Instant now, Responder& responder, const Caller& caller);

  std::uint8_t unit_;
  RtuTiming timing_;
  bool has_echo_;
  std::vector<std::uint8_t> input_;
  bool is_spoiled_ = false;  ///< the rest up to a silence is no frame
  Instant last_byte_{};      ///< of what was received
  std::vector<std::uint8_t> output_;
  std::size_t output_sent_ = 0;
  Instant answer_at_{};
  std::vector<std::uint8_t> echo_;  ///< that is still to come back
  Instant echo_until_{};
  RtuCounts counts_;
};

}  // namespace hysteron::runtime::modbus
