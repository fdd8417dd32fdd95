// The stage as a Modbus device: a process of its own, by libmodbus alone.
//
//   holding registers 0 to 3   the voltage, V, a 64-bit float, high word first
//   input registers 0 to 3     the displacement, µm, likewise
#include <fmt/format.h>
#include <modbus.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <bit>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "examples/08_served_stage/stage.hpp"

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::string_view usage =
    "A simulated piezo stage as a Modbus device on 127.0.0.1.\n"
    "\n"
    "  stage [--lockstep] [PORT]\n"
    "\n"
    "Time passes by the clock of the machine; with --lockstep, a period of 1 ms with each voltage that is written. "
    "Port 0,\n"
    "which is the default, is any that is free; the first line that it prints says which. It ends once its last "
    "client\n"
    "goes.\n";

constexpr int write_registers = 16;

class Device {
 public:
  explicit Device(bool lockstep)
      : lockstep_(lockstep), registers_(modbus_mapping_new(0, 0, 4, 4), modbus_mapping_free) {
    show();
  }

  [[nodiscard]] modbus_mapping_t* registers() const { return registers_.get(); }

  /// Before an answer: the time that has passed since the one before, with the voltage as it was.
  void before() {
    if (lockstep_) {
      return;
    }
    const auto due = static_cast<std::int64_t>(std::chrono::duration<double>(Clock::now() - begin_).count() /
                                               simulated::Stage::period);
    for (; periods_ < due; ++periods_) {
      stage_.advance(voltage());
    }
    show();
  }
  void after(int function) {
    if (lockstep_ && function == write_registers) {
      stage_.advance(voltage());
      show();
    }
  }

 private:
  [[nodiscard]] double voltage() const {
    std::uint64_t bits = 0;
    for (const std::uint16_t word : std::span(registers_->tab_registers, 4)) {
      bits = bits << 16U | word;
    }
    return std::bit_cast<double>(bits);
  }
  void show() {
    auto bits = std::bit_cast<std::uint64_t>(stage_.reading());
    for (int i = 3; i >= 0; --i, bits >>= 16U) {
      registers_->tab_input_registers[i] = static_cast<std::uint16_t>(bits & 0xFFFFU);
    }
  }

  bool lockstep_;
  simulated::Stage stage_;
  std::unique_ptr<modbus_mapping_t, void (*)(modbus_mapping_t*)> registers_;
  Clock::time_point begin_ = Clock::now();
  std::int64_t periods_ = 0;
};

/// Answers its clients, of whom each may be trusted, until none is left.
void serve(modbus_t* context, int listener, Device& device) {
  std::vector<pollfd> sockets{{.fd = listener, .events = POLLIN, .revents = 0}};
  bool had_client = false;
  while (!had_client || sockets.size() > 1) {
    (void)::poll(sockets.data(), sockets.size(), -1);
    for (std::size_t i = 1; i < sockets.size(); ++i) {
      if (sockets[i].revents == 0) {
        continue;
      }
      modbus_set_socket(context, sockets[i].fd);
      std::array<std::uint8_t, MODBUS_TCP_MAX_ADU_LENGTH> query{};
      const int length = modbus_receive(context, query.data());
      if (length > 0) {
        device.before();
        modbus_reply(context, query.data(), length, device.registers());
        device.after(query[7]);
      } else if (length < 0) {
        ::close(sockets[i].fd);
        sockets[i].fd = -1;
      }
    }
    if (sockets[0].revents != 0) {
      const int client = ::accept4(listener, nullptr, nullptr, SOCK_CLOEXEC);
      if (client >= 0) {
        sockets.push_back({.fd = client, .events = POLLIN, .revents = 0});
        had_client = true;
      }
    }
    std::erase_if(sockets, [](const pollfd& one) { return one.fd < 0; });
  }
}

int run(bool lockstep, int port) {
  const std::unique_ptr<modbus_t, void (*)(modbus_t*)> context(modbus_new_tcp("127.0.0.1", port), modbus_free);
  int listener = context ? modbus_tcp_listen(context.get(), 8) : -1;
  sockaddr_in address{};
  socklen_t size = sizeof address;
  if (listener < 0 || ::getsockname(listener, reinterpret_cast<sockaddr*>(&address), &size) != 0) {
    fmt::print(stderr, "stage: cannot listen on port {}: {}\n", port, modbus_strerror(errno));
    return 1;
  }
  fmt::print("{}\n", ntohs(address.sin_port));
  (void)std::fflush(stdout);
  Device device(lockstep);
  serve(context.get(), listener, device);
  ::close(listener);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  bool lockstep = false;
  int port = 0;
  for (const std::string_view word : std::span(argv, static_cast<std::size_t>(argc)).subspan(1)) {
    if (word == "--lockstep") {
      lockstep = true;
    } else if (word.find_first_not_of("0123456789") == std::string_view::npos && word.size() < 6) {
      port = std::stoi(std::string(word));
    } else {
      fmt::print(word == "--help" ? stdout : stderr, "{}", usage);
      return word == "--help" ? 0 : 2;
    }
  }
  return run(lockstep, port);
}
