// A real broker, mosquitto, on a free port, and a subscriber that writes down what it hears.
#pragma once

#include <fcntl.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "tests/runtime/modbus/free_port.hpp"
#include "tests/runtime/namespaces.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/support/soon.hpp"

namespace hysteron::runtime::test {

/// Where Debian has it; empty where none is installed.
inline std::string mosquitto_program() {
  for (const char* const path : {"/usr/sbin/mosquitto", "/usr/bin/mosquitto", "/usr/local/sbin/mosquitto"}) {
    if (::access(path, X_OK) == 0) {
      return path;
    }
  }
  return {};
}

inline bool has_broker() {
  return !mosquitto_program().empty() && std::system("command -v mosquitto_sub mosquitto_pub > /dev/null") == 0;
}

/// Of a test, from its SetUp.
inline void skip_without_broker() {
  if (!has_broker()) {
    GTEST_SKIP() << "mosquitto is not installed: scripts/install-dependencies test";
  }
}

/// A program in a process of its own, its output in a file.
class Program {
 public:
  Program(const std::vector<std::string>& words, const std::string& output) {
    std::vector<char*> arguments;
    for (const std::string& word : words) {
      arguments.push_back(const_cast<char*>(word.c_str()));
    }
    arguments.push_back(nullptr);
    process_ = ::fork();
    if (process_ == 0) {
      const int file = ::open(output.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0644);
      (void)::dup2(file, STDOUT_FILENO);
      (void)::dup2(file, STDERR_FILENO);
      (void)::execvp(arguments[0], arguments.data());
      ::_exit(127);
    }
  }
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;
  ~Program() { kill(); }

  void send(int signal) const {
    if (process_ > 0) {
      (void)::kill(process_, signal);
    }
  }
  void kill() {
    send(SIGKILL);
    if (process_ > 0) {
      (void)::waitpid(std::exchange(process_, 0), nullptr, 0);
    }
  }

 private:
  pid_t process_ = 0;
};

class Broker {
 public:
  /// `settings`: further lines of its configuration; what concerns the listener comes behind it.
  explicit Broker(std::string settings = "allow_anonymous true\n") : settings_(std::move(settings)) {}

  /// True once it listens.
  bool start() {
    folder_.write("broker.conf", fmt::format("{}persistence false\nmax_inflight_messages 0\nmax_queued_messages 0\n"
                                             "listener {} 127.0.0.1\n{}",
                                             ::geteuid() == 0 ? "user root\n" : "", port_, settings_));
    process_ = std::make_unique<Program>(std::vector<std::string>{mosquitto_program(), "-c", folder_ / "broker.conf"},
                                         folder_ / "log");
    return soon([&] { return is_listening(); });
  }
  /// At once, as a power cut.
  void kill() { process_->kill(); }
  /// It keeps its connections, and does nothing.
  void halt() const { process_->send(SIGSTOP); }
  void go_on() const { process_->send(SIGCONT); }

  [[nodiscard]] std::uint16_t port() const { return port_; }
  [[nodiscard]] std::string log() const { return contents_of(folder_ / "log"); }
  [[nodiscard]] const ScratchFolder& folder() const { return folder_; }

 private:
  [[nodiscard]] bool is_listening() const {
    const std::string ask = fmt::format("bash -c 'exec 3<>/dev/tcp/127.0.0.1/{}' 2> /dev/null", port_);
    return std::system(ask.c_str()) == 0;
  }

  std::string settings_;
  ScratchFolder folder_{};
  std::uint16_t port_ = free_port();
  std::unique_ptr<Program> process_{};
};

struct Heard {
  std::string topic{};
  std::string payload{};
};

/// Everything that the broker tells, from when the constructor returns.
class Subscriber {
 public:
  explicit Subscriber(const Broker& broker, const std::vector<std::string>& more = {}) {
    const std::string port = std::to_string(broker.port());
    std::vector<std::string> words{"mosquitto_sub", "-h", "localhost", "-p", port, "-t", "#", "-F", "%t %x"};
    words.insert(words.end(), more.begin(), more.end());
    std::vector<std::string> greeting{"mosquitto_pub", "-h", "localhost", "-p", port, "-t",
                                      "greeting",      "-m", "x",         "-r"};
    greeting.insert(greeting.end(), more.begin(), more.end());
    greets_ = std::make_unique<Program>(greeting, folder_ / "greeting");
    process_ = std::make_unique<Program>(words, folder_ / "heard");
    (void)soon([&] { return !all().empty(); });
  }

  /// In order; without the greeting.
  [[nodiscard]] std::vector<Heard> heard() const {
    std::vector<Heard> list = all();
    std::erase_if(list, [](const Heard& one) { return one.topic == "greeting"; });
    return list;
  }
  [[nodiscard]] std::vector<std::string> on(const std::string& topic) const {
    std::vector<std::string> list;
    for (const Heard& one : all()) {
      if (one.topic == topic) {
        list.push_back(one.payload);
      }
    }
    return list;
  }

 private:
  [[nodiscard]] std::vector<Heard> all() const {
    std::vector<Heard> list;
    std::ifstream file(folder_ / "heard");
    std::string line;
    while (std::getline(file, line) && !file.eof()) {  // the last may be half a line
      const std::size_t space = line.find(' ');
      if (space == std::string::npos) {
        continue;
      }
      Heard one{.topic = line.substr(0, space)};
      for (std::size_t i = space + 1; i + 1 < line.size(); i += 2) {
        one.payload += static_cast<char>(std::stoi(line.substr(i, 2), nullptr, 16));
      }
      list.push_back(std::move(one));
    }
    return list;
  }

  ScratchFolder folder_{};
  std::unique_ptr<Program> greets_{};
  std::unique_ptr<Program> process_{};
};

}  // namespace hysteron::runtime::test
