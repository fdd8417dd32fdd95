#include "tests/runtime/modbus/hostile_clients.hpp"

#include <algorithm>
#include <functional>
#include <memory>
#include <random>
#include <stop_token>
#include <thread>

#include "tests/runtime/modbus/client_socket.hpp"

namespace hysteron::test {
namespace {

using std::chrono::milliseconds;
using Clock = std::chrono::steady_clock;

void wait(const std::stop_token& stop, milliseconds time) {
  const auto until = Clock::now() + time;
  while (!stop.stop_requested() && Clock::now() < until) {
    std::this_thread::sleep_for(std::min(time, milliseconds(20)));
  }
}

/// Sends the bytes on a new connection, again and again; waits a little where asked, so that the answer can come.
void repeat(std::uint16_t port, const std::stop_token& stop, const std::function<Bytes()>& bytes, milliseconds stay) {
  while (!stop.stop_requested()) {
    const ClientSocket socket(port, milliseconds(200));
    for (int i = 0; i < 20 && !stop.stop_requested() && socket.send(bytes()); ++i) {
      wait(stop, stay);
    }
  }
}

/// Sends a request again and again on one connection and reads what comes.
void ask_on(std::uint16_t port, const std::stop_token& stop, const Bytes& request) {
  while (!stop.stop_requested()) {
    const ClientSocket socket(port, milliseconds(700));
    while (!stop.stop_requested() && socket.send(request) && socket.receive_frame().size() > 6) {
    }
  }
}

/// A write of 0xDEAD into the pattern, in a frame that is none: its header is changed by the caller.
Bytes forbidden_write() {
  return framed(7, {6, 0, 5, 0xDE, 0xAD});
}

void idle(std::uint16_t port, const std::stop_token& stop) {
  std::vector<std::unique_ptr<ClientSocket>> sockets;
  for (int i = 0; i < 30; ++i) {
    sockets.push_back(std::make_unique<ClientSocket>(port, milliseconds(500)));
  }
  while (!stop.stop_requested()) {
    wait(stop, milliseconds(50));
  }
}

void slow_sender(std::uint16_t port, const std::stop_token& stop) {
  const Bytes request = framed(1, {3, 0, 0, 0, 16});
  while (!stop.stop_requested()) {
    const ClientSocket socket(port, milliseconds(500));
    for (std::size_t i = 0; i < request.size() && !stop.stop_requested(); ++i) {
      if (!socket.send(std::span(request).subspan(i, 1))) {
        break;
      }
      wait(stop, milliseconds(400));
    }
  }
}

void never_reads(std::uint16_t port, const std::stop_token& stop) {
  const Bytes request = framed(1, {3, 0, 0, 0, 32});
  Bytes many;
  for (int i = 0; i < 100; ++i) {
    many.insert(many.end(), request.begin(), request.end());
  }
  while (!stop.stop_requested()) {
    const ClientSocket socket(port, milliseconds(500));
    socket.keep_little();
    while (!stop.stop_requested() && socket.send_without_waiting(many)) {
      std::this_thread::sleep_for(milliseconds(1));
    }
  }
}

void reset_mid_transaction(std::uint16_t port, const std::stop_token& stop) {
  const Bytes request = framed(1, {3, 0, 0, 0, 16});
  for (int i = 0; !stop.stop_requested(); ++i) {
    ClientSocket socket(port, milliseconds(500));
    socket.send(std::span(request).first(i % 2 == 0 ? request.size() : 7));
    socket.reset();
  }
}

void many_connections(std::uint16_t port, const std::stop_token& stop, std::size_t count) {
  while (!stop.stop_requested()) {
    std::vector<std::unique_ptr<ClientSocket>> sockets;
    while (sockets.size() < count && !stop.stop_requested()) {
      sockets.push_back(std::make_unique<ClientSocket>(port, milliseconds(500)));
    }
    wait(stop, milliseconds(200));
  }
}

void random_bytes(std::uint16_t port, const std::stop_token& stop) {
  std::mt19937 random(11);
  repeat(
      port, stop,
      [&] {
        Bytes bytes(1 + random() % 300);
        for (auto& byte : bytes) {
          byte = static_cast<std::uint8_t>(random());
        }
        return bytes;
      },
      milliseconds(1));
}

/// A byte of the frame changed.
Bytes with(Bytes frame, std::size_t at, std::uint8_t value) {
  frame[at] = value;
  return frame;
}

struct Attack {
  std::string name;
  std::function<void(std::uint16_t, const std::stop_token&, const Hostile&)> run;
};

const std::vector<Attack>& attacks() {
  using Port = std::uint16_t;
  using Stop = const std::stop_token&;
  using How = const Hostile&;
  static const std::vector<Attack> list{
      {"none", [](Port, Stop, How) {}},
      {"30 idle", [](Port port, Stop stop, How) { idle(port, stop); }},
      {"slow sender", [](Port port, Stop stop, How) { slow_sender(port, stop); }},
      {"partial frame",
       [](Port port, Stop stop, How) {
         repeat(
             port, stop, [] { return Bytes{0, 1, 0, 0, 0, 6, 1, 3}; }, milliseconds(1000));
       }},
      {"FC 43",
       [](Port port, Stop stop, How) {
         ask_on(port, stop, framed(1, {43, 14, 1, 0}));
       }},
      {"quantity 126",
       [](Port port, Stop stop, How) {
         ask_on(port, stop, framed(1, {3, 0, 0, 0, 126}));
       }},
      {"random bytes", [](Port port, Stop stop, How) { random_bytes(port, stop); }},
      {"length 65535",
       [](Port port, Stop stop, How) {
         repeat(
             port, stop, [] { return with(with(forbidden_write(), 4, 0xFF), 5, 0xFF); }, milliseconds(5));
       }},
      {"wrong protocol id",
       [](Port port, Stop stop, How) {
         repeat(
             port, stop, [] { return with(forbidden_write(), 3, 1); }, milliseconds(5));
       }},
      {"lying length",
       [](Port port, Stop stop, How) {
         repeat(
             port, stop, [] { return with(forbidden_write(), 5, 9); }, milliseconds(5));
       }},
      {"reset mid-transaction", [](Port port, Stop stop, How) { reset_mid_transaction(port, stop); }},
      {"never reads", [](Port port, Stop stop, How) { never_reads(port, stop); }},
      {"1,100 connections", [](Port port, Stop stop, How how) { many_connections(port, stop, how.connections); }},
  };
  return list;
}

class Victim {
 public:
  Victim(std::uint16_t port, milliseconds patience) : port_(port), patience_(patience), socket_(connect()) {}

  void poll() {
    const bool writes = ++transaction_ % 4 == 0;
    const Bytes request = writes ? framed(transaction_, {6, 0, 20, transaction_ >> 8, transaction_ & 0xFF})
                                 : framed(transaction_, {3, 0, 0, 0, 21});
    ++result_.requests;
    const auto begin = Clock::now();
    const bool sent = socket_->send(request);
    const std::size_t expected = writes ? 12 : 9 + 2 * 21;
    const Bytes answer = sent ? socket_->receive(expected) : Bytes();
    if (answer.size() != expected) {
      ++result_.errors;
      socket_ = connect();
      return;
    }
    result_.latencies.push_back(std::chrono::duration<double>(Clock::now() - begin).count());
    if (writes) {
      written_ = transaction_;
      result_.wrong += answer == request ? 0 : 1;
    } else {
      result_.wrong += is_right(answer) ? 0 : 1;
    }
  }

  [[nodiscard]] const VictimResult& result() const { return result_; }

 private:
  [[nodiscard]] std::unique_ptr<ClientSocket> connect() const {
    return std::make_unique<ClientSocket>(port_, patience_);
  }

  [[nodiscard]] bool is_right(const Bytes& answer) const {
    bool right = answer[0] == transaction_ >> 8 && answer[1] == (transaction_ & 0xFF) && answer[7] == 3;
    for (std::size_t i = 0; i < pattern_registers; ++i) {
      right = right && answer[9 + 2 * i] == pattern_of(i) >> 8U && answer[10 + 2 * i] == (pattern_of(i) & 0xFFU);
    }
    return right && answer[9 + 40] == written_ >> 8 && answer[10 + 40] == (written_ & 0xFF);
  }

  std::uint16_t port_;
  milliseconds patience_;
  std::unique_ptr<ClientSocket> socket_;
  VictimResult result_;
  std::uint16_t transaction_ = 0;
  std::uint16_t written_ = 0;
};

}  // namespace

std::vector<runtime::Point> registers_to_serve() {
  std::vector<runtime::Point> points;
  for (std::size_t i = 0; i < served_registers; ++i) {
    points.push_back({.name = "W" + std::to_string(i),
                      .kind = runtime::PointKind::parameter,
                      .type = runtime::PointType::uint16,
                      .unit = "1",
                      .low = 0,
                      .high = 65535,
                      .writable = true});
  }
  return points;
}

const std::vector<std::string>& attack_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> list;
    for (const Attack& attack : attacks()) {
      list.push_back(attack.name);
    }
    return list;
  }();
  return names;
}

VictimResult victim_beside(const std::string& attack, std::uint16_t port, milliseconds time, milliseconds patience,
                           const Hostile& hostile) {
  const auto found = std::ranges::find(attacks(), attack, &Attack::name);
  Victim victim(port, patience);
  const std::jthread attacker([&](const std::stop_token& stop) { found->run(port, stop, hostile); });
  const auto end = Clock::now() + time;
  for (auto next = Clock::now(); next < end; next = std::max(next + milliseconds(5), Clock::now())) {
    std::this_thread::sleep_until(next);
    victim.poll();
  }
  return victim.result();
}

}  // namespace hysteron::test
