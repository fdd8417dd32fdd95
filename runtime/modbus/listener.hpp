// A socket that listens, for the life of a server: where its address is not there yet, it is tried again, with
// growing pauses, in the thread of the server.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "support/descriptor.hpp"
#include "support/diagnostic.hpp"

namespace hysteron::runtime::modbus {

class Listener {
 public:
  using Instant = std::chrono::steady_clock::time_point;
  /// Takes a line for standard error.
  using Tell = std::function<void(const std::string& line)>;

  /// Listens, or says by `tell` that the address is not there yet. Throws InputError as listen_on where that will not
  /// pass: HY827 to HY829.
  Listener(std::string address, std::uint16_t port, const Place& place, Tell tell);

  [[nodiscard]] bool is_open() const { return socket_.is_open(); }
  [[nodiscard]] const Descriptor& socket() const { return socket_; }
  /// From any thread. Before it listens, the port that was asked for.
  [[nodiscard]] std::uint16_t port() const { return port_.load(std::memory_order_relaxed); }
  /// When it wants to be tried again; nothing once it listens.
  [[nodiscard]] std::optional<Instant> next_try() const;
  /// Tries again where that is due; true where it listens from now on.
  bool try_again(Instant now);

 private:
  /// Where it is another reason than the one that was told last.
  void tell_why(int problem);

  std::string address_;
  std::atomic<std::uint16_t> port_;
  Tell tell_;
  Descriptor socket_{};
  std::chrono::milliseconds wait_;
  int told_ = 0;  ///< the errno
  Instant next_{};
};

}  // namespace hysteron::runtime::modbus
