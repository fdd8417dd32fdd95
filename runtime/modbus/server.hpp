// The Modbus server, over TCP and on a serial line: one thread, one bounded event loop, beside the cyclic task and
// never in its way.
//
// No client can hold up another: nothing in the loop waits for a client, every connection has bounded buffers and
// deadlines (connection.hpp), there are at most `connections` of them, and one turn takes at most one buffer of each.
// Where no place is left, who has been silent for longest gives way.
// It listens on loopback unless told otherwise. With a TLS context it is Modbus/TCP Security: handshakes and records
// have deadlines of their own (tls_session.hpp), and one turn takes at most one step of one handshake, because that is
// dear.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "runtime/modbus/connection.hpp"
#include "runtime/modbus/heartbeat.hpp"
#include "runtime/modbus/register_map.hpp"
#include "runtime/modbus/responder.hpp"
#include "runtime/modbus/rtu_line.hpp"
#include "runtime/modbus/tls_context.hpp"
#include "support/diagnostic.hpp"

namespace hysteron::runtime::modbus {

struct ServerOptions {
  std::string listen = "127.0.0.1";  ///< a numeric address; empty: a serial line alone
  std::uint16_t port = 1502;         ///< 0 takes any that is free
  std::vector<std::string> allow{};  ///< networks in CIDR notation; none: whoever can reach the port
  std::size_t connections = 32;
  std::size_t connections_per_address = 0;  ///< 0: as many as connections
  milliseconds evict{5'000};  ///< silence after which a client gives way to one for whom there is no place
  bool read_only = false;
  std::optional<RtuOptions> rtu{};
  ConnectionLimits limits{};
  HeartbeatOptions heartbeat{};
  Identity identity{};
  /// Called in the server's thread when the client is lost, and when it is back. Must return at once.
  std::function<void(bool lost)> client_lost{};
  std::shared_ptr<const TlsContext> tls{};  ///< none: in the clear
  /// Called in the server's thread with a line on a client that TLS refused or that has too many connections, on a
  /// request that the program refused, on a point beyond its format, on a serial line that is lost or back. Each kind
  /// once a second at the most. Must return at once.
  std::function<void(const std::string& line)> tell{};
  Place place{};  ///< of these settings, for errors
};

/// Counted since the start.
struct ServerStatus {
  std::uint64_t open = 0;  ///< connections now
  std::uint64_t accepted = 0;
  std::uint64_t refused_full = 0;     ///< beyond the connections allowed at once
  std::uint64_t refused_share = 0;    ///< beyond those allowed from one address
  std::uint64_t refused_address = 0;  ///< not in the allow-list
  std::uint64_t requests = 0;
  std::uint64_t exceptions = 0;
  std::uint64_t writes = 0;  ///< requests that wrote
  std::uint64_t closed_by_client = 0;
  std::uint64_t frame_late = 0;  ///< dropped, as Ending says, and so on
  std::uint64_t idle = 0;
  std::uint64_t unread = 0;
  std::uint64_t wrong_protocol = 0;
  std::uint64_t wrong_length = 0;
  std::uint64_t handshake_late = 0;
  std::uint64_t tls_failed = 0;
  std::uint64_t evicted = 0;    ///< silent, and gave way to another
  std::uint64_t saturated = 0;  ///< values that were read and are beyond what their format reaches
  RtuCounts line{};
  bool client_lost = false;
};

class Server {
 public:
  /// Listens and serves from here on. The door must outlive the server. Throws InputError HY827 to HY830.
  Server(RegisterMap map, PointDoor& door, const ServerOptions& options);
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;
  Server(Server&&) = delete;
  Server& operator=(Server&&) = delete;
  /// Closes all connections.
  ~Server();

  /// Connections from now on are served by this certificate; those that are open go on. From any thread.
  void renew(std::shared_ptr<const TlsContext> tls);
  /// From the next request on, another map of points that the door has. From any thread.
  void show(RegisterMap map);
  [[nodiscard]] std::uint16_t port() const;
  [[nodiscard]] std::shared_ptr<const RegisterMap> map() const;
  [[nodiscard]] ServerStatus status() const;

 private:
  class Loop;
  std::unique_ptr<Loop> loop_;
};

}  // namespace hysteron::runtime::modbus
