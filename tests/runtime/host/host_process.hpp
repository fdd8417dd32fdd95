// A host in a process of its own, and the device that it works with.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "runtime/host/host.hpp"
#include "runtime/host/served_map.hpp"
#include "runtime/modbus/device.hpp"
#include "runtime/modbus/server.hpp"
#include "support/descriptor.hpp"
#include "support/diagnostic.hpp"
#include "tests/runtime/modbus/free_port.hpp"
#include "tests/runtime/modbus/memory_door.hpp"
#include "tests/runtime/namespaces.hpp"
#include "tests/support/exit_code.hpp"

namespace hysteron::runtime::test {

using std::chrono::milliseconds;

/// Y := 2 · X; where X is 13, the step never ends.
class Twice final : public StepProgram {
 public:
  [[nodiscard]] const ProgramShape& shape() const noexcept override { return shape_; }
  void reset() noexcept override {}
  void step(std::span<const double> inputs, std::span<double> outputs) noexcept override {
    for (volatile bool hangs = inputs[0] == 13.0; hangs;) {
    }
    outputs[0] = 2.0 * inputs[0];
  }
  void set_parameter(std::size_t /*parameter*/, double /*value*/) noexcept override {}
  [[nodiscard]] double parameter(std::size_t /*parameter*/) const noexcept override { return 0.0; }
  [[nodiscard]] std::size_t state_size() const noexcept override { return 0; }
  void save(std::span<std::byte> /*bytes*/) const noexcept override {}
  void restore(std::span<const std::byte> /*bytes*/) noexcept override {}

 private:
  ProgramShape shape_{
      .name = "TWICE", .period = 1'000'000, .inputs = {{.name = "X"}}, .outputs = {{.name = "Y"}}, .layout = "twice"};
};

/// Our own server as the device: it gives X and takes Y.
struct Stage {
  MemoryDoor door{{{.name = "X"}, {.name = "Y", .kind = PointKind::parameter, .writable = true}}};
  std::uint16_t port = free_port();
  std::unique_ptr<modbus::Server> server;

  void start() {
    server = std::make_unique<modbus::Server>(modbus::make_register_map(door.points(), {}), door,
                                              modbus::ServerOptions{.port = port});
  }
  void give(double x) { door.set(0, x); }
  [[nodiscard]] double taken() { return door.value(1); }
};

/// run_host in a process of its own, begun while the test has one thread.
class HostProcess {
 public:
  explicit HostProcess(const std::string& run_file) {
    std::array<int, 2> ends{};
    if (::pipe(ends.data()) != 0) {
      std::abort();
    }
    said_ = Descriptor(ends[0]);
    process_ = ::fork();
    if (process_ == 0) {
      (void)::dup2(::fileno(told_.get()), STDERR_FILENO);
      Twice program;
      const auto say = [&](std::string_view text) {
        [[maybe_unused]] const ssize_t written = ::write(ends[1], text.data(), text.size());
      };
      try {
        ::_exit(run_host(program, parse_run_config("RUN.toml", run_file, program.shape()), {.how = "linked"}, say) ? 0
                                                                                                                   : 1);
      } catch (const InputError& refused) {
        const Diagnostic& first = refused.diagnostics().all().front();
        say(fmt::format("HY{} {}:{}: {}\n", first.number, first.place.file, first.place.line, first.cause));
        ::_exit(2);
      }
    }
    ::close(ends[1]);
    std::string started = line();
    while (!started.empty() && started.find("Modbus on") == std::string::npos) {
      before_ += std::exchange(started, line()) + "\n";
    }
    if (started.empty()) {
      return;
    }
    const auto at = started.find("Modbus on 127.0.0.1:");
    port_ = at == std::string::npos ? std::uint16_t{1} : static_cast<std::uint16_t>(std::stoi(started.substr(at + 20)));
  }
  HostProcess(const HostProcess&) = delete;
  HostProcess& operator=(const HostProcess&) = delete;
  HostProcess(HostProcess&&) = delete;
  HostProcess& operator=(HostProcess&&) = delete;
  ~HostProcess() {
    if (process_ > 0) {
      ::kill(process_, SIGKILL);
      ::waitpid(process_, nullptr, 0);
    }
  }

  /// A client that reads points by their names.
  [[nodiscard]] std::unique_ptr<modbus::Device> client(const std::vector<std::string>& names) const {
    const Twice program;
    RunConfig config;
    config.task.inputs = {{.from_device = true}};
    config.task.outputs.resize(1);
    const auto map = register_map_of(config, program);
    modbus::DeviceOptions options{.link = modbus::TcpLink{.port = port_}, .response = milliseconds(2000)};
    for (const std::string& name : names) {
      for (const auto& entry : map.entries()) {
        if (map.point_of(entry).name == name) {
          options.values.push_back({.at = entry.at, .format = entry.format});
        }
      }
    }
    return std::make_unique<modbus::Device>(options);
  }
  [[nodiscard]] std::uint16_t port() const { return port_; }
  /// What it said before it ran; all that it said, where it was refused.
  [[nodiscard]] const std::string& said_before() const { return before_; }
  /// What it said on standard error up to now.
  [[nodiscard]] std::string told() const {
    std::string text(4096, '\0');
    const auto size = ::pread(::fileno(told_.get()), text.data(), text.size(), 0);
    text.resize(static_cast<std::size_t>(std::max<ssize_t>(size, 0)));
    return text;
  }
  /// The process of its guard.
  [[nodiscard]] pid_t guard() const {
    std::ifstream children(fmt::format("/proc/{0}/task/{0}/children", process_));
    pid_t child = 0;
    children >> child;
    return child;
  }
  void send(int signal) const { ::kill(process_, signal); }
  /// Ends it by SIGKILL. Its guard goes on.
  void kill() {
    send(SIGKILL);
    ::waitpid(std::exchange(process_, 0), nullptr, 0);
  }
  /// Ends it by SIGTERM; its exit code, and what it said at its end.
  std::pair<int, std::string> end() {
    send(SIGTERM);
    return ended();
  }
  /// The same, once it ends by itself or was killed.
  std::pair<int, std::string> ended() {
    const std::string last = line();
    int status = 0;
    ::waitpid(std::exchange(process_, 0), &status, 0);
    return {exit_code(status), last};
  }

 private:
  std::string line() {
    std::string text;
    for (char letter = 0; ::read(said_.number(), &letter, 1) == 1 && letter != '\n';) {
      text += letter;
    }
    return text;
  }

  struct Close {
    void operator()(std::FILE* file) const { (void)std::fclose(file); }
  };
  Descriptor said_;
  std::unique_ptr<std::FILE, Close> told_{std::tmpfile()};
  std::string before_;
  pid_t process_ = 0;
  std::uint16_t port_ = 0;
};

/// The guard is patient: a machine that is busy with something else is no hang.
inline std::string run_file(std::uint16_t stage, const std::string& rest) {
  return fmt::format(
      "[task]\nscheduling = \"other\"\nlock_memory = false\n[watchdog]\nsilence = \"5s\"\n[devices.stage]\nport = {}\n"
      "cycle = \"2ms\"\ntimeout = \"1s\"\n[outputs.Y]\nsafe = -1.0\ndevice = \"stage\"\n[modbus]\nport = 0\n{}",
      stage, rest);
}

inline constexpr const char* x_on_stage = "[inputs.X]\ndevice = \"stage\"\narea = \"input\"\nlongest_age = \"1s\"\n";

}  // namespace hysteron::runtime::test
