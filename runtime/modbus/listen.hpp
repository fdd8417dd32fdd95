// Opens the socket on which a server listens, or says why not.
#pragma once

#include <sys/socket.h>

#include <cstdint>
#include <string>

#include "runtime/modbus/descriptor.hpp"
#include "support/diagnostic.hpp"

namespace hysteron::runtime::modbus {

/// A listening socket that does not block. Throws InputError HY827 to HY829.
[[nodiscard]] Descriptor listen_on(const std::string& address, std::uint16_t port, const Place& place);

/// The port that a socket listens on.
[[nodiscard]] std::uint16_t port_of(const Descriptor& listening);

/// The numeric address of a peer, for logs.
[[nodiscard]] std::string address_text(const sockaddr_storage& peer);

}  // namespace hysteron::runtime::modbus
