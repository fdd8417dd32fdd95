// One connection of the Modbus client to one device, over TCP or a serial line.
//
// libmodbus opens the link, keeps its timeouts and, on a serial line, its checksums. The answer is checked here, to the
// byte: transaction, protocol, length, unit, function and size. Its own client takes a late answer for the next one and
// then stays off by one for ever; here whatever is not the exact answer ends the connection. Several devices may hang
// on one serial line, and of several processes: exchanges take turns. Units behind a gateway may share one connection:
// then each exchange is one of them, and the next opens the connection again where one ended it.
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "runtime/modbus/host_names.hpp"

namespace hysteron::runtime::modbus {

struct TcpLink {
  std::string host = "127.0.0.1";
  std::uint16_t port = 502;
  std::vector<std::string> known{};  ///< numeric addresses of the host, as found at the start; tried first
  friend bool operator==(const TcpLink&, const TcpLink&) = default;
};

struct SerialLink {
  std::string path{};
  int baud = 19200;
  char parity = 'E';
  int data_bits = 8;
  int stop_bits = 1;
  bool has_echo = false;  ///< the adapter gives back what is sent
  friend bool operator==(const SerialLink&, const SerialLink&) = default;
};

/// Where a device is: 127.0.0.1:502, /dev/ttyUSB0.
[[nodiscard]] std::string text_of(const std::variant<TcpLink, SerialLink>& link);

enum class Exchange : std::uint8_t {
  answered,
  exception,     ///< the device refuses; the link is sound
  no_link,       ///< cannot be opened
  timeout,       ///< no whole answer in time
  closed,        ///< ended by the device
  wrong_answer,  ///< bytes that are not the answer
  bad_checksum,  ///< on a serial line: bytes that were damaged on their way
};

inline constexpr std::size_t exchange_outcomes = 7;

class ClientLink {
 public:
  ClientLink(const std::variant<TcpLink, SerialLink>& to, std::chrono::milliseconds response);
  ClientLink(const ClientLink&) = delete;
  ClientLink& operator=(const ClientLink&) = delete;
  ClientLink(ClientLink&&) = delete;
  ClientLink& operator=(ClientLink&&) = delete;
  ~ClientLink();

  [[nodiscard]] bool is_open() const { return open_; }
  /// False where the device is not there within the response time, or its name has no address by then. Nothing to do
  /// where it is open.
  bool open();
  void close();
  /// Sends a request to a unit and waits for its answer, at most the response time. All but answered and exception
  /// close the link. One that another user of the link closed is opened first.
  Exchange exchange(std::uint8_t unit, std::span<const std::uint8_t> request, std::vector<std::uint8_t>& answer);
  /// From another thread: ends a wait for an answer at once.
  void interrupt();

 private:
  struct Free {
    void operator()(void* context) const;
  };
  bool connect();
  /// Over TCP: the context is for this address from now on; false where there is none.
  bool aim_at(const std::string& address);
  Exchange transfer(std::uint8_t unit, std::span<const std::uint8_t> request, std::vector<std::uint8_t>& answer);
  [[nodiscard]] Exchange send(std::uint8_t unit, std::span<const std::uint8_t> request);
  [[nodiscard]] Exchange take_echo(std::span<const std::uint8_t> sent);

  std::unique_ptr<void, Free> context_;
  std::optional<HostName> name_{};  ///< over TCP
  std::string aimed_at_{};          ///< the address of the context
  std::string port_{};
  bool serial_;
  bool has_echo_;
  std::chrono::milliseconds response_;
  std::uint16_t transaction_ = 0;
  std::atomic<bool> open_{false};
  std::mutex turns_;        ///< of those who use the link
  std::mutex socket_lock_;  ///< of open, close and interrupt
  bool interrupted_ = false;
};

/// Whether an answer has the form that its request calls for: the same function with the bytes asked for, or the echo.
[[nodiscard]] bool answers_request(std::span<const std::uint8_t> request, std::span<const std::uint8_t> answer);

}  // namespace hysteron::runtime::modbus
