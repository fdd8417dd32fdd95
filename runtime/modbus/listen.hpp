// Opens the socket on which a server listens, or says why not.
#pragma once

#include <sys/socket.h>

#include <cstdint>
#include <string>

#include "support/descriptor.hpp"
#include "support/diagnostic.hpp"

namespace hysteron::runtime::modbus {

/// A listening socket that does not block. Throws InputError HY827 to HY829.
[[nodiscard]] Descriptor listen_on(const std::string& address, std::uint16_t port, const Place& place);

/// A socket that listens, or why there is none, as errno says it.
struct Listening {
  Descriptor socket{};
  int problem = 0;
};
[[nodiscard]] Listening try_to_listen(const std::string& address, std::uint16_t port);
/// Whether a problem may go by itself: an address that this machine does not have yet, a want of means.
[[nodiscard]] bool passes(int problem);
/// Throws InputError HY827 to HY829.
[[noreturn]] void refuse_to_listen(int problem, const std::string& address, std::uint16_t port, const Place& place);

/// The port that a socket listens on.
[[nodiscard]] std::uint16_t port_of(const Descriptor& listening);

/// The numeric address of a peer, for logs.
[[nodiscard]] std::string address_text(const sockaddr_storage& peer);

}  // namespace hysteron::runtime::modbus
