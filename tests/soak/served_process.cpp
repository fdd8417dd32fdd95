// FD_SET beyond FD_SETSIZE aborts, as it does in every program that Debian builds.
#undef _FORTIFY_SOURCE
#define _FORTIFY_SOURCE 2

#include "tests/soak/served_process.hpp"

#include <modbus/modbus.h>
#include <netinet/in.h>
#include <sys/prctl.h>
#include <sys/select.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <stdexcept>

#include "runtime/modbus/server.hpp"
#include "tests/runtime/modbus/hostile_clients.hpp"
#include "tests/runtime/modbus/memory_door.hpp"

namespace hysteron::soak {
namespace {

void tell(int pipe, std::uint16_t port) {
  if (::write(pipe, &port, sizeof port) != sizeof port) {
    ::_exit(1);
  }
}

[[noreturn]] void serve_ours(int pipe, const runtime::modbus::TlsOptions* tls) {
  namespace modbus = runtime::modbus;
  test::MemoryDoor door(test::registers_to_serve());
  for (std::size_t i = 0; i < test::pattern_registers; ++i) {
    door.set(i, test::pattern_of(i));
  }
  const modbus::Server server(
      modbus::make_register_map(door.points(), {.title = "SOAK"}), door,
      {.port = 0, .tls = tls != nullptr ? std::make_shared<modbus::TlsContext>(*tls) : nullptr});
  tell(pipe, server.port());
  while (true) {
    ::pause();
  }
}

/// The server of libmodbus' own example for several clients.
[[noreturn]] void serve_plain(int pipe) {
  ::signal(SIGPIPE, SIG_IGN);
  modbus_t* const context = ::modbus_new_tcp("127.0.0.1", 0);
  modbus_mapping_t* const mapping = ::modbus_mapping_new(0, 0, test::served_registers, 0);
  for (std::size_t i = 0; i < test::pattern_registers; ++i) {
    mapping->tab_registers[i] = test::pattern_of(i);
  }
  const int listening = ::modbus_tcp_listen(context, 32);
  sockaddr_in own{};
  socklen_t size = sizeof own;
  ::getsockname(listening, reinterpret_cast<sockaddr*>(&own), &size);
  tell(pipe, ntohs(own.sin_port));
  fd_set all;
  FD_ZERO(&all);
  FD_SET(listening, &all);
  int highest = listening;
  while (true) {
    fd_set ready = all;
    if (::select(highest + 1, &ready, nullptr, nullptr, nullptr) < 0) {
      ::_exit(1);
    }
    for (int socket = 0; socket <= highest; ++socket) {
      if (!FD_ISSET(socket, &ready)) {
        continue;
      }
      if (socket == listening) {
        const int client = ::accept(listening, nullptr, nullptr);
        if (client >= 0) {
          FD_SET(client, &all);
          highest = std::max(highest, client);
        }
        continue;
      }
      ::modbus_set_socket(context, socket);
      std::array<std::uint8_t, MODBUS_TCP_MAX_ADU_LENGTH> query{};
      const int length = ::modbus_receive(context, query.data());
      if (length > 0) {
        ::modbus_reply(context, query.data(), length, mapping);
      } else if (length < 0) {
        ::close(socket);
        FD_CLR(socket, &all);
      }
    }
  }
}

}  // namespace

ServedProcess::ServedProcess(ServerKind kind, const runtime::modbus::TlsOptions* tls) {
  std::array<int, 2> ends{};
  if (::pipe(ends.data()) != 0) {
    throw std::runtime_error("no pipe");
  }
  process_ = ::fork();
  if (process_ == 0) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    ::close(ends[0]);
    kind == ServerKind::ours ? serve_ours(ends[1], tls) : serve_plain(ends[1]);
  }
  ::close(ends[1]);
  const bool told = ::read(ends[0], &port_, sizeof port_) == sizeof port_;
  ::close(ends[0]);
  if (!told) {
    throw std::runtime_error("the server did not start");
  }
}

ServedProcess::~ServedProcess() {
  ::kill(process_, SIGKILL);
  ::waitpid(process_, nullptr, 0);
}

bool ServedProcess::is_alive() const {
  siginfo_t info{};
  return ::waitid(P_PID, static_cast<id_t>(process_), &info, WEXITED | WNOHANG | WNOWAIT) == 0 && info.si_pid == 0;
}

long ServedProcess::open_descriptors() const {
  const std::filesystem::directory_iterator all("/proc/" + std::to_string(process_) + "/fd");
  return std::distance(all, std::filesystem::directory_iterator());
}

}  // namespace hysteron::soak
