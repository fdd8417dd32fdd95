// Who may connect: a list of networks in CIDR notation, asked before a byte of a client is read.
#pragma once

#include <sys/socket.h>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "support/diagnostic.hpp"

namespace hysteron::runtime::modbus {

/// An IPv4 or IPv6 address as 16 bytes; IPv4 as ::ffff:a.b.c.d, so that a socket of either family is judged alike.
using AddressBytes = std::array<std::uint8_t, 16>;

[[nodiscard]] std::optional<AddressBytes> address_bytes(std::string_view text);
[[nodiscard]] std::optional<AddressBytes> address_bytes(const sockaddr_storage& peer);

/// Who a peer is when connections are counted: its IPv4 address, or the /64 of its IPv6 address, since whoever has one
/// address of that has all. Nothing for other families.
[[nodiscard]] std::optional<AddressBytes> origin_of(const sockaddr_storage& peer);

class Network {
 public:
  /// 192.168.10.0/24, fd00::/8, 10.1.2.3. Empty where it is none, or has bits set behind its length.
  [[nodiscard]] static std::optional<Network> parse(std::string_view text);
  [[nodiscard]] bool contains(const AddressBytes& address) const;

 private:
  AddressBytes address_{};
  unsigned length_ = 128;
};

/// Throws InputError HY830 with all that are none.
[[nodiscard]] std::vector<Network> networks_of(const std::vector<std::string>& texts, const Place& place);

/// An empty list allows everyone who can reach the port.
[[nodiscard]] bool is_allowed(const std::vector<Network>& list, const sockaddr_storage& peer);

}  // namespace hysteron::runtime::modbus
