#include "runtime/modbus/listen.hpp"

#include <fmt/format.h>
#include <netdb.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <memory>
#include <system_error>
#include <utility>

#include "support/errors.hpp"

namespace hysteron::runtime::modbus {

void refuse_to_listen(int reason, const std::string& address, std::uint16_t port, const Place& place) {
  if (reason == EADDRINUSE) {
    throw InputError(error::port_in_use, place, fmt::format("Another program listens on {} port {}.", address, port),
                     fmt::format("end it, or choose another port; ss -ltnp sport = :{} names it", port));
  }
  if (reason == EACCES) {
    throw InputError(error::privileged_port, place, fmt::format("Port {} may be opened by root alone.", port),
                     "choose a port from 1024 on, or give the program CAP_NET_BIND_SERVICE");
  }
  throw InputError(
      error::unusable_listen_address, place,
      fmt::format("{} port {} cannot be listened on: {}.", address, port, std::system_category().message(reason)),
      "name a numeric address of this machine: 127.0.0.1 for this machine alone, 0.0.0.0 for all networks");
}

bool passes(int problem) {
  return problem == EADDRNOTAVAIL || problem == ENETDOWN || problem == ENOBUFS || problem == ENOMEM ||
         problem == EMFILE || problem == ENFILE;
}

Listening try_to_listen(const std::string& address, std::uint16_t port) {
  addrinfo hints{};
  hints.ai_flags = AI_NUMERICHOST | AI_NUMERICSERV | AI_PASSIVE;
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  if (::getaddrinfo(address.c_str(), std::to_string(port).c_str(), &hints, &found) != 0) {
    return {.problem = EINVAL};
  }
  const std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)> release(found, &::freeaddrinfo);
  Descriptor socket(::socket(found->ai_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  const int on = 1;
  if (!socket.is_open() || ::setsockopt(socket.number(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof on) != 0 ||
      ::bind(socket.number(), found->ai_addr, found->ai_addrlen) != 0 || ::listen(socket.number(), SOMAXCONN) != 0) {
    return {.problem = errno};
  }
  return {.socket = std::move(socket)};
}

Descriptor listen_on(const std::string& address, std::uint16_t port, const Place& place) {
  Listening tried = try_to_listen(address, port);
  if (!tried.socket.is_open()) {
    refuse_to_listen(tried.problem, address, port, place);
  }
  return std::move(tried.socket);
}

std::uint16_t port_of(const Descriptor& listening) {
  sockaddr_storage own{};
  socklen_t size = sizeof own;
  if (::getsockname(listening.number(), reinterpret_cast<sockaddr*>(&own), &size) != 0) {
    return 0;
  }
  if (own.ss_family == AF_INET6) {
    sockaddr_in6 six{};
    std::memcpy(&six, &own, sizeof six);
    return ntohs(six.sin6_port);
  }
  sockaddr_in four{};
  std::memcpy(&four, &own, sizeof four);
  return ntohs(four.sin_port);
}

std::string address_text(const sockaddr_storage& peer) {
  std::array<char, NI_MAXHOST> text{};
  const int failed = ::getnameinfo(reinterpret_cast<const sockaddr*>(&peer), sizeof peer, text.data(), text.size(),
                                   nullptr, 0, NI_NUMERICHOST);
  return failed == 0 ? text.data() : "a client";
}

}  // namespace hysteron::runtime::modbus
