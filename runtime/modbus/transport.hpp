// A client's bytes on their way between its socket and its connection: as they are, or through TLS. Neither framing nor
// answers know which. Nothing here waits.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "runtime/modbus/connection.hpp"
#include "runtime/modbus/responder.hpp"
#include "support/descriptor.hpp"

namespace hysteron::runtime::modbus {

class TlsContext;

/// What a call moved, and what it met.
struct Moved {
  std::size_t count = 0;
  bool blocked = false;  ///< no more for now
  bool gone = false;     ///< the client has left
};

class Transport {
 public:
  Transport() = default;
  Transport(const Transport&) = delete;
  Transport& operator=(const Transport&) = delete;
  virtual ~Transport() = default;

  /// Reads the socket at most once. Bytes for the connection may be there without any from the socket.
  virtual Moved receive(const Descriptor& socket, std::span<std::uint8_t> into, Instant now) = 0;
  /// Sends what waits in it, and takes of the bytes what it can.
  virtual Moved send(const Descriptor& socket, std::span<const std::uint8_t> bytes) = 0;

  [[nodiscard]] virtual bool is_in_handshake() const { return false; }
  /// Whether `receive` would read the socket; where not, it is not waited for.
  [[nodiscard]] virtual bool wants_input() const { return true; }
  /// Whether `receive` has bytes without any from the socket.
  [[nodiscard]] virtual bool has_buffered() const { return false; }
  /// Whether the socket is waited for until it takes bytes.
  [[nodiscard]] virtual bool has_output() const { return false; }
  [[nodiscard]] virtual Rights rights() const { return {}; }
  /// Why it failed, for a log.
  [[nodiscard]] virtual std::string failure() const { return {}; }
  [[nodiscard]] virtual std::optional<Ending> due(Instant /*now*/) const { return {}; }
  [[nodiscard]] virtual std::optional<Instant> next_deadline() const { return {}; }
};

/// Through TLS, or as they are where there is no context.
[[nodiscard]] std::unique_ptr<Transport> make_transport(std::shared_ptr<const TlsContext> tls,
                                                        const ConnectionLimits& limits, Instant now);

}  // namespace hysteron::runtime::modbus
