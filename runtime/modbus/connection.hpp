// What the server knows of one client, as a pure function of the bytes it sent and of a given now. No sockets.
//
// Bytes come in by `received`, whole requests are answered into a bounded output, and `due` says when and why the
// connection must end. A request that has begun must be whole within the frame deadline, however slowly its bytes drip;
// a client that asks and does not read is asked no more (`wants_input`), and dropped when nothing of its output went
// for a while.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "runtime/modbus/responder.hpp"

namespace hysteron::runtime::modbus {

using Instant = std::chrono::steady_clock::time_point;
using std::chrono::milliseconds;

struct ConnectionLimits {
  milliseconds frame_deadline{500};
  milliseconds idle{60'000};
  milliseconds unread{2'000};       ///< output that does not move for so long
  milliseconds handshake{5'000};    ///< of TLS, from its connection on
  std::size_t output_bytes = 8192;  ///< beyond which no further request is taken
};

enum class Ending : std::uint8_t {
  frame_late,  ///< of Modbus, or a record of TLS
  idle,
  unread,
  wrong_protocol,
  wrong_length,
  handshake_late,
  tls_failed,  ///< no certificate that counts, or what is no TLS
};
inline constexpr std::size_t endings = 7;

/// What the requests of one call did.
struct Served {
  std::uint32_t requests = 0;
  std::uint32_t exceptions = 0;
  std::uint32_t writes = 0;  ///< requests whose values were taken

  /// One more request, which was answered so.
  void count(const Reply& reply) {
    ++requests;
    exceptions += reply.exception == Exception::none ? 0 : 1;
    writes += reply.wrote ? 1 : 0;
  }
};

class Connection {
 public:
  Connection(Instant now, const ConnectionLimits& limits) : limits_(limits), last_request_(now) {}

  /// How many bytes may be given to `received` now; 0 while the client does not read its answers.
  [[nodiscard]] std::size_t wants_input() const {
    return ending_ || output_size() >= limits_.output_bytes ? 0 : input_.size() - input_size_;
  }
  /// Takes bytes from the client and answers the requests that are whole.
  Served received(std::span<const std::uint8_t> bytes, Instant now, Responder& responder, const Caller& caller);
  /// Answers what is whole already, after output went.
  Served resume(Instant now, Responder& responder, const Caller& caller);

  [[nodiscard]] std::span<const std::uint8_t> output() const { return std::span(output_).subspan(output_sent_); }
  void sent(std::size_t count, Instant now);

  /// Since when the client has asked nothing; its connection where it never did.
  [[nodiscard]] Instant silent_since() const { return last_request_; }

  /// Why the connection must end at this instant, if it must.
  [[nodiscard]] std::optional<Ending> due(Instant now) const;
  /// The next instant at which `due` may change by itself.
  [[nodiscard]] Instant next_deadline() const;

 private:
  [[nodiscard]] std::size_t output_size() const { return output_.size() - output_sent_; }

  ConnectionLimits limits_;
  std::array<std::uint8_t, 4 * longest_frame> input_{};
  std::size_t input_size_ = 0;
  std::vector<std::uint8_t> output_;
  std::size_t output_sent_ = 0;
  Instant last_request_;                 ///< when the last whole request was taken
  std::optional<Instant> frame_began_;   ///< when the first byte of an unfinished one came
  std::optional<Instant> output_waits_;  ///< since when no output went
  std::optional<Ending> ending_;
};

}  // namespace hysteron::runtime::modbus
