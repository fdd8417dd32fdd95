// The live page's server: HTTP and WebSocket in one thread of its own, beside the cyclic task and never in its way.
//
// It sees the task through the door alone, as the Modbus server does. No client can hold up another or make memory
// grow: nothing waits for a client, connections and streams are counted, requests have a size and a deadline, and a
// stream that does not take its values loses those that come meanwhile. Where all connections are taken, the one that
// owes its request for longest gives way.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "runtime/point.hpp"
#include "runtime/web/access.hpp"
#include "runtime/web/live_text.hpp"

namespace hysteron::runtime::web {

using std::chrono::milliseconds;

struct Limits {
  std::size_t connections = 32;
  std::size_t streams = 16;
  std::size_t header_bytes = 8192;
  std::size_t body_bytes = 65'536;
  milliseconds request{5'000};   ///< from the connection, or from the answer before, to the end of the request
  milliseconds answer{10'000};   ///< for a client to take an answer
  milliseconds unread{5'000};    ///< for a stream to take one set of values
  milliseconds silence{20'000};  ///< of a stream's client, which answers a ping at half of it
  milliseconds interval{50};     ///< between two sets of values
};

struct ServerOptions {
  Endpoint endpoint{};
  Access access{};
  Limits limits{};
  std::function<void(const std::string& line)> tell{};  ///< takes a line for standard error
};

/// Counted since the start.
struct ServerStatus {
  std::uint64_t open = 0;     ///< connections now
  std::uint64_t streams = 0;  ///< of them, those that are sent values
  std::uint64_t accepted = 0;
  std::uint64_t refused_full = 0;
  std::uint64_t gave_way = 0;  ///< closed for a newer connection
  std::uint64_t answers = 0;
  std::uint64_t sent = 0;     ///< sets of values
  std::uint64_t dropped = 0;  ///< sets of values that a stream was too slow for
  std::uint64_t unread = 0;   ///< streams closed since they took nothing
};

class Server {
 public:
  /// Listens and serves from here on. The door must outlive the server. Throws InputError HY827 to HY829 and HY843.
  Server(PointDoor& door, const Subject& subject, const ServerOptions& options);
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;
  Server(Server&&) = delete;
  Server& operator=(Server&&) = delete;
  /// Closes all connections.
  ~Server();

  [[nodiscard]] std::uint16_t port() const;
  [[nodiscard]] ServerStatus status() const;

 private:
  class Loop;
  std::unique_ptr<Loop> loop_;
};

}  // namespace hysteron::runtime::web
