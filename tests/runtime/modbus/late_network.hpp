// A server that is started before its network is there, in a process with a network of its own.
#pragma once

#include <arpa/inet.h>
#include <net/if.h>
#include <netinet/in.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstring>
#include <string>

#include "runtime/modbus/device.hpp"
#include "runtime/modbus/server.hpp"
#include "support/descriptor.hpp"
#include "tests/runtime/modbus/memory_door.hpp"
#include "tests/support/exit_code.hpp"
#include "tests/support/soon.hpp"

namespace hysteron::test {

enum class LateNetwork : int { served = 0, not_told = 1, never_listened = 2, not_served = 3, none = 77 };

/// Notes whether the server lacks its address.
class NotedDoor final : public MemoryDoor {
 public:
  NotedDoor() : MemoryDoor({{.name = "X"}}) {}
  void shortage(runtime::Shortage what, bool is_there) noexcept override {
    if (what == runtime::Shortage::address) {
      lacks_address = is_there;
    }
  }
  std::atomic<bool> lacks_address{false};
};

inline constexpr const char* late_address = "10.1.2.3";

inline ifreq request_to(const char* name) {
  ifreq request{};
  std::strncpy(static_cast<char*>(request.ifr_name), name, IFNAMSIZ - 1);
  return request;
}

inline void bring_up_loopback() {
  const Descriptor any(::socket(AF_INET, SOCK_DGRAM, 0));
  ifreq request = request_to("lo");
  request.ifr_flags = IFF_UP | IFF_RUNNING;
  (void)::ioctl(any.number(), SIOCSIFFLAGS, &request);
}

/// The loopback has the late address, too, from now on.
inline void give_address() {
  const Descriptor any(::socket(AF_INET, SOCK_DGRAM, 0));
  ifreq request = request_to("lo:1");
  sockaddr_in address{};
  address.sin_family = AF_INET;
  (void)::inet_pton(AF_INET, late_address, &address.sin_addr);
  std::memcpy(&request.ifr_addr, &address, sizeof address);
  (void)::ioctl(any.number(), SIOCSIFADDR, &request);
}

inline LateNetwork serve_before_the_network() {
  if (::unshare(CLONE_NEWNET) != 0 && ::unshare(CLONE_NEWUSER | CLONE_NEWNET) != 0) {
    return LateNetwork::none;  // this machine lets nobody have one
  }
  namespace modbus = runtime::modbus;
  bring_up_loopback();
  NotedDoor door;
  std::string told;
  const modbus::Server server(
      modbus::make_register_map(door.points(), {}), door,
      {.listen = late_address, .port = 1502, .tell = [&](const std::string& line) { told += line; }});
  if (!door.lacks_address || told.find("cannot be listened on yet") == std::string::npos) {
    return LateNetwork::not_told;
  }
  give_address();
  if (!soon([&] { return !door.lacks_address; })) {
    return LateNetwork::never_listened;
  }
  door.set(0, 4.5);
  const auto map = server.map();
  const auto& entry = map->entries()[0];
  const modbus::Device client({.link = modbus::TcpLink{.host = late_address, .port = 1502},
                               .values = {{.at = entry.at, .format = entry.format}},
                               .response = std::chrono::seconds(2)});
  return soon([&] { return client.read(0).value == 4.5; }) ? LateNetwork::served : LateNetwork::not_served;
}

/// The address comes later than the server.
inline LateNetwork meet_a_late_network() {
  const pid_t process = ::fork();
  if (process == 0) {
    ::_exit(static_cast<int>(serve_before_the_network()));
  }
  int status = 0;
  (void)::waitpid(process, &status, 0);
  return static_cast<LateNetwork>(exit_code(status));
}

}  // namespace hysteron::test
