// Measures the Modbus server beside a plain libmodbus server under the same attacks, and prints its section of
// docs/runtime-results.md.
//
//   runtime_results [seconds an attack] [seconds of throughput] [connections to open and close]
#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "tests/runtime/modbus/client_socket.hpp"
#include "tests/runtime/modbus/hostile_clients.hpp"
#include "tests/runtime/modbus/tls_files.hpp"
#include "tests/soak/served_process.hpp"

namespace hysteron::soak {
namespace {

using std::chrono::milliseconds;
using Clock = std::chrono::steady_clock;

/// The processor time that the host kept from this machine, of all that went by, since the start.
class Steal {
 public:
  [[nodiscard]] double percent() const {
    const Times now = read();
    const double all = now.all - begin_.all;
    return all > 0 ? 100.0 * (now.steal - begin_.steal) / all : 0.0;
  }

 private:
  struct Times {
    double steal = 0;
    double all = 0;
  };
  static Times read() {
    std::ifstream file("/proc/stat");
    std::string name;
    file >> name;
    Times times;
    for (int i = 0; i < 8; ++i) {
      double ticks = 0;
      file >> ticks;
      times.all += ticks;
      times.steal = i == 7 ? ticks : times.steal;
    }
    return times;
  }
  Times begin_ = read();
};

std::string milliseconds_at(std::vector<double> latencies, double part) {
  if (latencies.empty()) {
    return "–";
  }
  std::ranges::sort(latencies);
  const auto last = static_cast<double>(latencies.size() - 1);
  return fmt::format("{:.1f}", 1e3 * latencies[static_cast<std::size_t>(part * last)]);
}

/// What clients and the server need for TLS; nothing where it is in the clear.
struct Tls {
  test::TlsFiles files{};
  runtime::modbus::TlsOptions options = files.options();
  test::ClientContext client = files.client_of("all");
};

/// Whether each victim of ours had its answers, and no wrong one.
bool all_well = true;

std::string row_of(ServerKind kind, const std::string& attack, milliseconds time, const Tls* tls = nullptr) {
  const ServedProcess server(kind, tls != nullptr ? &tls->options : nullptr);
  const auto result = test::victim_beside(attack, server.port(), time, std::chrono::seconds(2),
                                          {.connections = 1100, .tls = tls != nullptr ? tls->client.get() : nullptr});
  all_well = all_well && (kind == ServerKind::plain || (result.errors == 0 && result.wrong == 0 && server.is_alive()));
  return fmt::format("{} | {} | {} | {} | {}{}", result.requests, result.errors, result.wrong,
                     milliseconds_at(result.latencies, 0.99), milliseconds_at(result.latencies, 1.0),
                     server.is_alive() ? "" : ", died");
}

void print_attacks(milliseconds time) {
  fmt::print(
      "| attack | requests | errors | wrong | p99, ms | worst, ms | plain: requests | errors | wrong | p99, ms | "
      "worst, "
      "ms |\n| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
  for (const std::string& attack : test::names_of(test::attacks())) {
    const std::string ours = row_of(ServerKind::ours, attack, time);
    fmt::print("| {} | {} | {} |\n", attack, ours, row_of(ServerKind::plain, attack, time));
  }
}

void print_attacks_through_tls(milliseconds time, const Tls& tls) {
  fmt::print(
      "\nThe same through TLS, where attackers have certificates as the victim has, and what can be done to TLS "
      "besides:\n\n| attack | requests | errors | wrong | p99, ms | worst, ms |\n| --- | --- | --- | --- | --- | --- "
      "|\n");
  for (const auto* const list : {&test::attacks(), &test::tls_attacks()}) {
    for (const std::string& attack : test::names_of(*list)) {
      fmt::print("| {} | {} |\n", attack, row_of(ServerKind::ours, attack, time, &tls));
    }
  }
}

struct Throughput {
  std::uint64_t requests = 0;
  std::uint64_t wrong = 0;
};

/// 32 connections in eight threads; each asks for the 16 registers of the pattern as fast as it is answered.
Throughput throughput(std::uint16_t port, milliseconds time, ssl_ctx_st* tls) {
  std::atomic<std::uint64_t> requests{0};
  std::atomic<std::uint64_t> wrong{0};
  test::Bytes expected = test::framed(1, {3, 32});
  expected[5] = 3 + 32;
  for (std::size_t i = 0; i < test::pattern_registers; ++i) {
    expected.push_back(static_cast<std::uint8_t>(test::pattern_of(i) >> 8U));
    expected.push_back(static_cast<std::uint8_t>(test::pattern_of(i) & 0xFFU));
  }
  const auto end = Clock::now() + time;
  std::vector<std::jthread> threads;
  for (int thread = 0; thread < 8; ++thread) {
    threads.emplace_back([&] {
      const test::Bytes request = test::framed(1, {3, 0, 0, 0, 16});
      std::vector<std::unique_ptr<test::ClientSocket>> sockets;
      for (int i = 0; i < 4; ++i) {
        sockets.push_back(std::make_unique<test::ClientSocket>(port, std::chrono::seconds(5), tls));
      }
      while (Clock::now() < end) {
        for (const auto& socket : sockets) {
          socket->send(request);
        }
        for (const auto& socket : sockets) {
          wrong += socket->receive(expected.size()) == expected ? 0 : 1;
          ++requests;
        }
      }
    });
  }
  threads.clear();
  return {requests, wrong};
}

void print_throughput(milliseconds time, const Tls& tls) {
  fmt::print(
      "\n| server | 32 connections, FC 03 × 16, {} s: requests a second | wrong replies |\n| --- | --- | --- |\n",
      time.count() / 1000);
  const auto row = [&](const char* name, const ServedProcess& server, ssl_ctx_st* client) {
    const Throughput done = throughput(server.port(), time, client);
    all_well = all_well && done.wrong == 0;
    fmt::print("| {} | {:.0f} | {} |\n", name,
               1e3 * static_cast<double>(done.requests) / static_cast<double>(time.count()), done.wrong);
    (void)std::fflush(stdout);
  };
  row("ours", ServedProcess(ServerKind::ours), nullptr);
  row("plain", ServedProcess(ServerKind::plain), nullptr);
  row("ours, through TLS", ServedProcess(ServerKind::ours, &tls.options), tls.client.get());
}

void print_connects(int count) {
  const ServedProcess server(ServerKind::ours);
  const long before = server.open_descriptors();
  int failed = 0;
  for (int i = 0; i < count; ++i) {
    test::ClientSocket socket(server.port());
    failed += socket.connected() ? 0 : 1;
    socket.reset();  // or the ports of this machine would soon all wait for late packets
  }
  const auto until = Clock::now() + std::chrono::seconds(10);
  while (server.open_descriptors() != before && Clock::now() < until) {
    std::this_thread::sleep_for(milliseconds(20));
  }
  all_well = all_well && failed == 0 && server.open_descriptors() == before;
  fmt::print("\nConnected and closed {} times: {} failed, {} descriptors lost.\n", count, failed,
             server.open_descriptors() - before);
}

}  // namespace
}  // namespace hysteron::soak

int main(int count, char** arguments) {
  const auto number = [&](int i, int otherwise) { return count > i ? std::stoi(arguments[i]) : otherwise; };
  rlimit files{};
  ::getrlimit(RLIMIT_NOFILE, &files);
  files.rlim_cur = files.rlim_max;
  ::setrlimit(RLIMIT_NOFILE, &files);
  const hysteron::soak::Steal steal;
  fmt::print(
      "The left half is Hysteron's server, the right half libmodbus' documented `select` server; both had the same "
      "attack\nbeside the same victim, one after the other. The victim asks 200 times a second; an error is an answer "
      "that did not\ncome within 2 s, wrong is a value that nobody may have written.\n\n");
  const hysteron::soak::Tls tls;
  hysteron::soak::print_attacks(std::chrono::seconds(number(1, 5)));
  hysteron::soak::print_attacks_through_tls(std::chrono::seconds(number(1, 5)), tls);
  hysteron::soak::print_throughput(std::chrono::seconds(number(2, 60)), tls);
  hysteron::soak::print_connects(number(3, 100'000));
  std::array<double, 3> load{};
  ::getloadavg(load.data(), 3);
  fmt::print(
      "\nThe host kept {:.2f} % of the processor time from this machine meanwhile. The load of its {} processors, "
      "averaged over 5 minutes, was {:.1f} at the end:\nlatencies and requests a second hold for such a machine.\n",
      steal.percent(), std::thread::hardware_concurrency(), load[1]);
  return hysteron::soak::all_well ? 0 : 1;
}
