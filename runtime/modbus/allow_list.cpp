#include "runtime/modbus/allow_list.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>

#include <algorithm>
#include <cstring>

#include "support/errors.hpp"
#include "support/whole_number.hpp"

namespace hysteron::runtime::modbus {
namespace {

constexpr unsigned mapped_prefix = 96;  // the bits before an IPv4 address in ::ffff:a.b.c.d

AddressBytes mapped(const in_addr& four) {
  AddressBytes bytes{};
  bytes[10] = 0xFF;
  bytes[11] = 0xFF;
  std::memcpy(bytes.data() + 12, &four, 4);
  return bytes;
}

in_addr four_of(const AddressBytes& bytes) {
  in_addr four{};
  std::memcpy(&four, bytes.data() + 12, sizeof four);
  return four;
}

/// The bits of a byte that belong to the first `length` bits of an address.
std::uint8_t mask_of_byte(std::size_t index, unsigned length) {
  const unsigned before = static_cast<unsigned>(index) * 8;
  const unsigned bits = length <= before ? 0 : std::min(8U, length - before);
  return static_cast<std::uint8_t>(0xFF00U >> bits);
}

}  // namespace

std::optional<AddressBytes> address_bytes(std::string_view text) {
  const std::string ended(text);
  in_addr four{};
  if (::inet_pton(AF_INET, ended.c_str(), &four) == 1) {
    return mapped(four);
  }
  AddressBytes bytes{};
  if (::inet_pton(AF_INET6, ended.c_str(), bytes.data()) == 1) {
    return bytes;
  }
  return std::nullopt;
}

std::optional<AddressBytes> address_bytes(const sockaddr_storage& peer) {
  if (peer.ss_family == AF_INET) {
    sockaddr_in four{};
    std::memcpy(&four, &peer, sizeof four);
    return mapped(four.sin_addr);
  }
  if (peer.ss_family == AF_INET6) {
    sockaddr_in6 six{};
    std::memcpy(&six, &peer, sizeof six);
    AddressBytes bytes{};
    std::memcpy(bytes.data(), &six.sin6_addr, bytes.size());
    return bytes;
  }
  return std::nullopt;
}

std::optional<AddressBytes> origin_of(const sockaddr_storage& peer) {
  auto bytes = address_bytes(peer);
  if (bytes && *bytes != mapped(four_of(*bytes))) {
    std::fill(bytes->begin() + 8, bytes->end(), std::uint8_t{0});
  }
  return bytes;
}

std::optional<Network> Network::parse(std::string_view text) {
  const auto slash = text.find('/');
  const std::string_view address = text.substr(0, slash);
  const auto bytes = address_bytes(address);
  if (!bytes) {
    return std::nullopt;
  }
  const bool four = address.find(':') == std::string_view::npos;
  Network network;
  network.address_ = *bytes;
  if (slash != std::string_view::npos) {
    const auto length = whole_number(text.substr(slash + 1), 0U, four ? 32U : 128U);
    if (!length) {
      return std::nullopt;
    }
    network.length_ = four ? mapped_prefix + *length : *length;
  }
  for (std::size_t i = 0; i < bytes->size(); ++i) {
    if (((*bytes)[i] & ~mask_of_byte(i, network.length_)) != 0) {
      return std::nullopt;
    }
  }
  return network;
}

bool Network::contains(const AddressBytes& address) const {
  for (std::size_t i = 0; i < address.size(); ++i) {
    if (((address[i] ^ address_[i]) & mask_of_byte(i, length_)) != 0) {
      return false;
    }
  }
  return true;
}

std::vector<Network> networks_of(const std::vector<std::string>& texts, const Place& place) {
  Diagnostics diagnostics;
  std::vector<Network> list;
  for (const std::string& text : texts) {
    if (const auto network = Network::parse(text)) {
      list.push_back(*network);
    } else {
      diagnostics.error(error::malformed_allow_list, place, text + " is no network.",
                        "write an address and the bits that count, with zeros behind them: 192.168.10.0/24");
    }
  }
  if (diagnostics.has_errors()) {
    throw InputError(diagnostics);
  }
  return list;
}

bool is_allowed(const std::vector<Network>& list, const sockaddr_storage& peer) {
  if (list.empty()) {
    return true;
  }
  const auto address = address_bytes(peer);
  return address && std::ranges::any_of(list, [&](const Network& network) { return network.contains(*address); });
}

}  // namespace hysteron::runtime::modbus
