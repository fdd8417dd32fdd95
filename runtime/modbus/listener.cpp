#include "runtime/modbus/listener.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <system_error>
#include <utility>

#include "runtime/modbus/listen.hpp"

namespace hysteron::runtime::modbus {
namespace {

constexpr std::chrono::milliseconds first_pause{50};
constexpr std::chrono::milliseconds longest_pause{2000};

}  // namespace

Listener::Listener(std::string address, std::uint16_t port, const Place& place, Tell tell)
    : address_(std::move(address)), port_(port), tell_(std::move(tell)), wait_(first_pause) {
  Listening first = try_to_listen(address_, port);
  if (first.socket.is_open()) {
    socket_ = std::move(first.socket);
    port_ = port_of(socket_);
    return;
  }
  if (!passes(first.problem)) {
    refuse_to_listen(first.problem, address_, port, place);
  }
  next_ = std::chrono::steady_clock::now() + wait_;
  tell_why(first.problem);
}

void Listener::tell_why(int problem) {
  if (std::exchange(told_, problem) == problem || !tell_) {
    return;
  }
  tell_(
      fmt::format("{} port {} cannot be listened on yet: {}. It is tried again, every 2 s at last; the control goes "
                  "on. {}",
                  address_, port(), std::system_category().message(problem),
                  problem == EADDRNOTAVAIL || problem == ENETDOWN ? "See that the network is up and has this address."
                  : problem == EADDRINUSE                         ? "See which other program listens there."
                                                                  : "See to that; no restart is needed."));
}

std::optional<Listener::Instant> Listener::next_try() const {
  return is_open() ? std::nullopt : std::optional(next_);
}

bool Listener::try_again(Instant now) {
  if (is_open() || now < next_) {
    return false;
  }
  Listening again = try_to_listen(address_, port());
  socket_ = std::move(again.socket);
  if (!is_open()) {
    tell_why(again.problem);
    wait_ = std::min(2 * wait_, longest_pause);
    next_ = now + wait_;
    return false;
  }
  port_ = port_of(socket_);
  if (tell_) {
    tell_(fmt::format("listens on {} port {} now.", address_, port()));
  }
  return true;
}

}  // namespace hysteron::runtime::modbus
