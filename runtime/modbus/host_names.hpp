// The addresses of a host by its name, looked up where nobody waits for it longer than he can.
//
// getaddrinfo waits for a name server as long as the system is set to, ten seconds and more, and cannot be ended. While
// a process has one thread, and may fork, a process of its own asks; later a thread does.
#pragma once

#include <chrono>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace hysteron::runtime::modbus {

/// Its numeric addresses, in the system's order; empty where the name is not known. Waits as long as the system does.
/// localhost is this machine (RFC 6761), also without a table of hosts.
[[nodiscard]] std::vector<std::string> addresses_of(const std::string& host);

/// The same for many hosts, all at once, in processes of their own: none of those that did not answer in time. A
/// numeric host needs no name server. To be called while the process has one thread.
[[nodiscard]] std::vector<std::vector<std::string>> addresses_within(std::span<const std::string> hosts,
                                                                     std::chrono::milliseconds patience);

/// A host whose addresses are needed again and again, as each connection is opened anew. One thread uses it at a time.
class HostName {
 public:
  /// `known`: its addresses as they were found before; tried first.
  explicit HostName(std::string host, std::vector<std::string> known = {});

  /// The address to try next, the known ones in turn: a new look-up begins once all have been tried, and is waited for
  /// at most so long. Empty where there is none.
  [[nodiscard]] std::string next_address(std::chrono::milliseconds patience);
  /// The address that was given last leads to the host: it is the one to begin with.
  void was_reached();

 private:
  struct LookUp;

  /// Takes newer addresses, where they come in time.
  void look_up(std::chrono::milliseconds patience);

  std::string host_;
  std::vector<std::string> known_;
  std::size_t next_ = 0;  ///< of known_
  bool is_numeric_ = false;
  std::shared_ptr<LookUp> asked_{};
};

}  // namespace hysteron::runtime::modbus
