#include "runtime/modbus/listener.hpp"

#include <fmt/format.h>

#include <algorithm>
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
  if (tell_) {
    tell_(
        fmt::format("{} port {} cannot be listened on yet: {}. It is tried again, every 2 s at last; the control "
                    "goes on. See that the network is up and has this address.",
                    address_, port, std::system_category().message(first.problem)));
  }
}

std::optional<Listener::Instant> Listener::next_try() const {
  return is_open() ? std::nullopt : std::optional(next_);
}

bool Listener::try_again(Instant now) {
  if (is_open() || now < next_) {
    return false;
  }
  socket_ = try_to_listen(address_, port()).socket;
  if (!is_open()) {
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
