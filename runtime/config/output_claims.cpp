#include "runtime/config/output_claims.hpp"

#include <fmt/format.h>
#include <sys/socket.h>
#include <sys/un.h>

#include <cerrno>
#include <cstddef>
#include <cstring>
#include <system_error>

#include "support/sha256.hpp"

namespace hysteron::runtime {
namespace {

std::string name_of(const modbus::DeviceOptions& device, const modbus::Stretch& at) {
  return "hysteron-output-" +
         sha256(fmt::format("{} {} {} {}", text_of(device.link), device.unit, static_cast<int>(at.area), at.address));
}

struct Address {
  sockaddr_un text{};
  socklen_t size = 0;
};

/// A name that is in no file system: a zero byte stands before it.
Address address_of(const std::string& name) {
  Address address;
  address.text.sun_family = AF_UNIX;
  std::memcpy(static_cast<char*>(address.text.sun_path) + 1, name.data(), name.size());
  address.size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + name.size());
  return address;
}

modbus::Descriptor socket_or_throw() {
  modbus::Descriptor socket(::socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  if (!socket.is_open()) {
    throw std::system_error(errno, std::system_category(), "a socket to claim an output by");
  }
  return socket;
}

bool bind_to(const modbus::Descriptor& socket, const std::string& name) {
  const Address address = address_of(name);
  if (::bind(socket.number(), reinterpret_cast<const sockaddr*>(&address.text), address.size) == 0) {
    return true;
  }
  if (errno != EADDRINUSE) {
    throw std::system_error(errno, std::system_category(), "the name by which an output is claimed");
  }
  return false;
}

/// The process that listens there; none where nobody does.
std::optional<pid_t> listener_of(const std::string& name) {
  const modbus::Descriptor socket = socket_or_throw();
  const Address address = address_of(name);
  if (::connect(socket.number(), reinterpret_cast<const sockaddr*>(&address.text), address.size) != 0) {
    return std::nullopt;
  }
  ucred peer{};
  socklen_t size = sizeof peer;
  (void)::getsockopt(socket.number(), SOL_SOCKET, SO_PEERCRED, &peer, &size);
  return peer.pid;
}

}  // namespace

OutputClaims::OutputClaims(const RunConfig& config) {
  for (const DeviceOutput& output : config.device_outputs) {
    const modbus::DeviceOptions& device = config.devices[output.link.device];
    names_.push_back(name_of(device, device.values[output.link.value].at));
  }
}

std::optional<OutputClaims::Holder> OutputClaims::claim() {
  if (!sockets_.empty()) {
    return std::nullopt;  // claimed before
  }
  std::vector<modbus::Descriptor> sockets;
  for (const std::string& name : names_) {
    sockets.push_back(socket_or_throw());
    if (!bind_to(sockets.back(), name)) {
      // None is kept: of two tasks that wait for one another's outputs, each would wait for ever.
      return Holder{.output = sockets.size() - 1, .guard = listener_of(name)};
    }
  }
  sockets_ = std::move(sockets);
  return std::nullopt;
}

void OutputClaims::listen() const noexcept {
  for (const modbus::Descriptor& socket : sockets_) {
    (void)::listen(socket.number(), SOMAXCONN);
  }
}

}  // namespace hysteron::runtime
