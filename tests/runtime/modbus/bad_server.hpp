// A Modbus server that answers as a script says: well, late, wrong, not at all.
#pragma once

#include <sys/socket.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <stop_token>
#include <string>
#include <thread>

#include "runtime/modbus/listen.hpp"
#include "support/descriptor.hpp"
#include "tests/runtime/modbus/client_socket.hpp"
#include "tests/runtime/modbus/readable.hpp"

namespace hysteron::test {

enum class Fault : std::uint8_t {
  none,
  late,
  never,
  wrong_id,
  wrong_unit,
  wrong_function,
  wrong_protocol,
  too_short,
  too_long,
  lying_length,
  close,
  reset,
  black_hole,  ///< connections are made by the system and taken by nobody
  duplicate,
  drip,  ///< a byte at a time, each in time
  exception,
};

/// Right answers say so; what a client takes from any other is a mistake.
inline constexpr std::uint16_t right_value = 0x1234;
inline constexpr std::uint16_t wrong_value = 0x0BAD;

class BadServer {
 public:
  explicit BadServer(std::chrono::milliseconds response)
      : response_(response),
        listening_(runtime::modbus::listen_on("127.0.0.1", 0, {})),
        thread_([this](const std::stop_token& stop) { run(stop); }) {}

  [[nodiscard]] std::uint16_t port() const { return runtime::modbus::port_of(listening_); }
  void set(Fault fault, std::uint8_t exception = 4) {
    exception_ = exception;
    fault_ = fault;
  }
  /// Requests that met a fault.
  [[nodiscard]] std::uint64_t faults() const { return faults_; }

 private:
  void run(const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      if (fault_ == Fault::black_hole) {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
        ++faults_;
      } else if (readable(listening_)) {
        const Descriptor client(::accept(listening_.number(), nullptr, nullptr));
        while (!stop.stop_requested() && fault_ != Fault::black_hole && serve(client, stop)) {
        }
      }
    }
  }

  /// False when the connection is at its end.
  bool serve(const Descriptor& client, const std::stop_token& stop) {
    if (!readable(client)) {
      return true;
    }
    std::array<std::uint8_t, 12> request{};
    if (::recv(client.number(), request.data(), request.size(), MSG_WAITALL) != 12) {
      return false;
    }
    const Fault fault = fault_;
    const auto transaction = static_cast<std::uint16_t>(request[0] << 8U | request[1]);
    const Bytes right = framed(transaction, {3, 2, right_value >> 8, right_value & 0xFF});
    Bytes wrong = framed(transaction, {3, 2, wrong_value >> 8, wrong_value & 0xFF});
    faults_ += fault == Fault::none ? 0 : 1;
    switch (fault) {
      case Fault::none:
        return send(client, right);
      case Fault::late:
        pause(stop, 2 * response_);
        return send(client, wrong);
      case Fault::never:
      case Fault::black_hole:
        return true;
      case Fault::wrong_id:
        wrong[1] ^= 1U;
        break;
      case Fault::wrong_unit:
        wrong[6] = 9;
        break;
      case Fault::wrong_function:
        wrong[7] = 4;
        break;
      case Fault::wrong_protocol:
        wrong[3] = 1;
        break;
      case Fault::too_short:
        wrong = framed(transaction, {3, 1, 0x0B});
        break;
      case Fault::too_long:
        wrong = framed(transaction, {3, 4, wrong_value >> 8, wrong_value & 0xFF, 0, 0});
        break;
      case Fault::lying_length:
        wrong[5] = 9;
        break;
      case Fault::close:
        return false;
      case Fault::reset: {
        const linger now{1, 0};
        ::setsockopt(client.number(), SOL_SOCKET, SO_LINGER, &now, sizeof now);
        return false;
      }
      case Fault::duplicate:
        return send(client, right) && send(client, wrong);
      case Fault::drip:
        for (const std::uint8_t byte : wrong) {
          send(client, {byte});
          pause(stop, response_ / 2);
        }
        return true;
      case Fault::exception:
        return send(client, framed(transaction, {0x83, exception_}));
    }
    return send(client, wrong);
  }

  static bool send(const Descriptor& client, const Bytes& bytes) {
    return ::send(client.number(), bytes.data(), bytes.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(bytes.size());
  }

  static void pause(const std::stop_token& stop, std::chrono::milliseconds time) {
    const auto until = std::chrono::steady_clock::now() + time;
    while (!stop.stop_requested() && std::chrono::steady_clock::now() < until) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }

  std::chrono::milliseconds response_;
  std::atomic<Fault> fault_{Fault::none};
  std::atomic<std::uint8_t> exception_{4};
  std::atomic<std::uint64_t> faults_{0};
  Descriptor listening_;
  std::jthread thread_;
};

}  // namespace hysteron::test
