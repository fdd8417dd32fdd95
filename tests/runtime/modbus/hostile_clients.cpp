#include "tests/runtime/modbus/hostile_clients.hpp"

#include <algorithm>
#include <functional>
#include <memory>
#include <random>
#include <stop_token>
#include <thread>

#include "tests/runtime/modbus/client_socket.hpp"

namespace hysteron::test {

using std::chrono::milliseconds;
using Clock = std::chrono::steady_clock;

void wait(const std::stop_token& stop, milliseconds time) {
  const auto until = Clock::now() + time;
  while (!stop.stop_requested() && Clock::now() < until) {
    std::this_thread::sleep_for(std::min(time, milliseconds(20)));
  }
}

namespace {

/// Where the server is, and what a client brings along.
struct Way {
  std::uint16_t port = 0;
  ssl_ctx_st* tls = nullptr;
};

/// Sends the bytes on a new connection, again and again; waits a little where asked, so that the answer can come.
void repeat(const Way& way, const std::stop_token& stop, const std::function<Bytes()>& bytes, milliseconds stay) {
  while (!stop.stop_requested()) {
    const ClientSocket socket(way.port, milliseconds(200), way.tls);
    for (int i = 0; i < 20 && !stop.stop_requested() && socket.send(bytes()); ++i) {
      wait(stop, stay);
    }
  }
}

/// Sends a request again and again on one connection and reads what comes.
void ask_on(const Way& way, const std::stop_token& stop, const Bytes& request) {
  while (!stop.stop_requested()) {
    const ClientSocket socket(way.port, milliseconds(700), way.tls);
    while (!stop.stop_requested() && socket.send(request) && socket.receive_frame().size() > 6) {
    }
  }
}

/// A write of 0xDEAD into the pattern, in a frame that is none: its header is changed by the caller.
Bytes forbidden_write() {
  return framed(7, {6, 0, 5, 0xDE, 0xAD});
}

void idle(const Way& way, const std::stop_token& stop) {
  std::vector<std::unique_ptr<ClientSocket>> sockets;
  for (int i = 0; i < 30; ++i) {
    sockets.push_back(std::make_unique<ClientSocket>(way.port, milliseconds(500), way.tls));
  }
  while (!stop.stop_requested()) {
    wait(stop, milliseconds(50));
  }
}

void slow_sender(const Way& way, const std::stop_token& stop) {
  const Bytes request = framed(1, {3, 0, 0, 0, 16});
  while (!stop.stop_requested()) {
    const ClientSocket socket(way.port, milliseconds(500), way.tls);
    for (std::size_t i = 0; i < request.size() && !stop.stop_requested(); ++i) {
      if (!socket.send(std::span(request).subspan(i, 1))) {
        break;
      }
      wait(stop, milliseconds(400));
    }
  }
}

void never_reads(const Way& way, const std::stop_token& stop) {
  const Bytes request = framed(1, {3, 0, 0, 0, 32});
  Bytes many;
  for (int i = 0; i < 100; ++i) {
    many.insert(many.end(), request.begin(), request.end());
  }
  while (!stop.stop_requested()) {
    const ClientSocket socket(way.port, milliseconds(500), way.tls);
    socket.keep_little();
    while (!stop.stop_requested() && socket.send_without_waiting(many)) {
      std::this_thread::sleep_for(milliseconds(1));
    }
  }
}

void reset_mid_transaction(const Way& way, const std::stop_token& stop) {
  const Bytes request = framed(1, {3, 0, 0, 0, 16});
  for (int i = 0; !stop.stop_requested(); ++i) {
    ClientSocket socket(way.port, milliseconds(500), way.tls);
    socket.send(std::span(request).first(i % 2 == 0 ? request.size() : 7));
    socket.reset();
  }
}

void many_connections(const Way& way, const std::stop_token& stop, std::size_t count) {
  while (!stop.stop_requested()) {
    std::vector<std::unique_ptr<ClientSocket>> sockets;
    while (sockets.size() < count && !stop.stop_requested()) {
      sockets.push_back(std::make_unique<ClientSocket>(way.port, milliseconds(500), way.tls));
    }
    wait(stop, milliseconds(200));
  }
}

void random_bytes(const Way& way, const std::stop_token& stop) {
  std::mt19937 random(11);
  repeat(
      way, stop,
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

Way way_of(std::uint16_t port, const Hostile& how) {
  return {port, how.tls};
}

class Victim {
 public:
  Victim(const Way& way, milliseconds patience) : way_(way), patience_(patience), socket_(connect()) {}

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
    return std::make_unique<ClientSocket>(way_.port, patience_, way_.tls);
  }

  [[nodiscard]] bool is_right(const Bytes& answer) const {
    bool right = answer[0] == transaction_ >> 8 && answer[1] == (transaction_ & 0xFF) && answer[7] == 3;
    for (std::size_t i = 0; i < pattern_registers; ++i) {
      right = right && answer[9 + 2 * i] == pattern_of(i) >> 8U && answer[10 + 2 * i] == (pattern_of(i) & 0xFFU);
    }
    return right && answer[9 + 40] == written_ >> 8 && answer[10 + 40] == (written_ & 0xFF);
  }

  Way way_;
  milliseconds patience_;
  std::unique_ptr<ClientSocket> socket_;
  VictimResult result_;
  std::uint16_t transaction_ = 0;
  std::uint16_t written_ = 0;
};

}  // namespace

const std::vector<Attack>& attacks() {
  using Port = std::uint16_t;
  using Stop = const std::stop_token&;
  using How = const Hostile&;
  static const std::vector<Attack> list{
      {"none", [](Port, Stop, How) {}},
      {"30 idle", [](Port port, Stop stop, How how) { idle(way_of(port, how), stop); }},
      {"slow sender", [](Port port, Stop stop, How how) { slow_sender(way_of(port, how), stop); }},
      {"partial frame",
       [](Port port, Stop stop, How how) {
         repeat(
             way_of(port, how), stop, [] { return Bytes{0, 1, 0, 0, 0, 6, 1, 3}; }, milliseconds(1000));
       }},
      {"FC 43",
       [](Port port, Stop stop, How how) {
         ask_on(way_of(port, how), stop, framed(1, {43, 14, 1, 0}));
       }},
      {"quantity 126",
       [](Port port, Stop stop, How how) {
         ask_on(way_of(port, how), stop, framed(1, {3, 0, 0, 0, 126}));
       }},
      {"random bytes", [](Port port, Stop stop, How how) { random_bytes(way_of(port, how), stop); }},
      {"length 65535",
       [](Port port, Stop stop, How how) {
         repeat(
             way_of(port, how), stop, [] { return with(with(forbidden_write(), 4, 0xFF), 5, 0xFF); }, milliseconds(5));
       }},
      {"wrong protocol id",
       [](Port port, Stop stop, How how) {
         repeat(
             way_of(port, how), stop, [] { return with(forbidden_write(), 3, 1); }, milliseconds(5));
       }},
      {"lying length",
       [](Port port, Stop stop, How how) {
         repeat(
             way_of(port, how), stop, [] { return with(forbidden_write(), 5, 9); }, milliseconds(5));
       }},
      {"reset mid-transaction", [](Port port, Stop stop, How how) { reset_mid_transaction(way_of(port, how), stop); }},
      {"never reads", [](Port port, Stop stop, How how) { never_reads(way_of(port, how), stop); }},
      {"1,100 connections",
       [](Port port, Stop stop, How how) { many_connections(way_of(port, how), stop, how.connections); }},
  };
  return list;
}

std::vector<std::string> names_of(const std::vector<Attack>& attacks) {
  std::vector<std::string> names;
  for (const Attack& attack : attacks) {
    names.push_back(attack.name);
  }
  return names;
}

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

VictimResult victim_beside(const std::string& attack, std::uint16_t port, milliseconds time, milliseconds patience,
                           const Hostile& hostile) {
  const auto plain = std::ranges::find(attacks(), attack, &Attack::name);
  const auto found = plain != attacks().end() ? plain : std::ranges::find(tls_attacks(), attack, &Attack::name);
  Victim victim({port, hostile.tls}, patience);
  const std::jthread attacker([&](const std::stop_token& stop) { found->run(port, stop, hostile); });
  const auto end = Clock::now() + time;
  for (auto next = Clock::now(); next < end; next = std::max(next + milliseconds(5), Clock::now())) {
    std::this_thread::sleep_until(next);
    victim.poll();
  }
  return victim.result();
}

}  // namespace hysteron::test
