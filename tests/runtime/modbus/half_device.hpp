// A device that keeps what is written to its holding registers, and leaves some requests without an answer.
#pragma once

#include <sys/socket.h>

#include <array>
#include <atomic>
#include <bitset>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <span>
#include <stop_token>
#include <thread>
#include <vector>

#include "runtime/modbus/frame.hpp"
#include "runtime/modbus/listen.hpp"
#include "support/descriptor.hpp"
#include "tests/runtime/modbus/client_socket.hpp"
#include "tests/runtime/modbus/readable.hpp"

namespace hysteron::test {

class HalfDevice {
 public:
  enum class Flaw : std::uint8_t { none, silent, one_byte_more, close_after };

  HalfDevice()
      : listening_(runtime::modbus::listen_on("127.0.0.1", 0, {})),
        thread_([this](const std::stop_token& stop) { run(stop); }) {}

  [[nodiscard]] std::uint16_t port() const { return runtime::modbus::port_of(listening_); }
  /// Of all that is read.
  void flaw_of_reads(Flaw flaw) { reads_ = flaw; }
  /// Requests that begin at this register, to read or to write, are carried out and not answered.
  void silent_at(std::uint16_t address, bool silent = true) {
    const std::scoped_lock lock(mutex_);
    silent_.set(address, silent);
  }
  [[nodiscard]] std::uint16_t holds(std::uint16_t address) {
    const std::scoped_lock lock(mutex_);
    return registers_.at(address);
  }
  /// Requests to read or to write that began there.
  [[nodiscard]] std::uint64_t asked(std::uint16_t address) {
    const std::scoped_lock lock(mutex_);
    return asked_.at(address);
  }

 private:
  void run(const std::stop_token& stop) {
    while (!stop.stop_requested()) {
      if (!readable(listening_)) {
        continue;
      }
      const Descriptor client(::accept(listening_.number(), nullptr, nullptr));
      while (!stop.stop_requested() && (!readable(client) || serve(client))) {
      }
    }
  }

  /// False when the connection is at its end.
  bool serve(const Descriptor& client) {
    std::array<std::uint8_t, 260> request{};
    if (::recv(client.number(), request.data(), 7, MSG_WAITALL) != 7) {
      return false;
    }
    const std::size_t rest = request[5] - std::size_t{1};
    if (::recv(client.number(), request.data() + 7, rest, MSG_WAITALL) != static_cast<ssize_t>(rest)) {
      return false;
    }
    const auto word = [&](std::size_t at) {
      return static_cast<std::uint16_t>(request.at(at) << 8U | request.at(at + 1));
    };
    const std::uint16_t address = word(8);
    const std::uint16_t count = word(10);
    Bytes answer{request[7]};
    const bool reads = request[7] == 3;
    const std::scoped_lock lock(mutex_);
    ++asked_.at(address);
    if (reads) {
      answer.push_back(static_cast<std::uint8_t>(2 * count));
      for (std::size_t i = 0; i < count; ++i) {
        answer.push_back(static_cast<std::uint8_t>(registers_.at(address + i) >> 8U));
        answer.push_back(static_cast<std::uint8_t>(registers_.at(address + i) & 0xFFU));
      }
    } else {
      for (std::size_t i = 0; i < count; ++i) {
        registers_.at(address + i) = word(13 + 2 * i);
      }
      answer.insert(answer.end(), request.begin() + 8, request.begin() + 12);
    }
    if (silent_.test(address) || (reads && reads_ == Flaw::silent)) {
      return true;
    }
    const auto header = runtime::modbus::header_of({.transaction = word(0), .unit = request[6]}, answer.size());
    Bytes frame(header.begin(), header.end());
    frame.insert(frame.end(), answer.begin(), answer.end());
    if (reads && reads_ == Flaw::one_byte_more) {
      frame.push_back(0);
    }
    return ::send(client.number(), frame.data(), frame.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(frame.size()) &&
           !(reads && reads_ == Flaw::close_after);
  }

  std::atomic<Flaw> reads_{Flaw::none};
  std::mutex mutex_;
  std::bitset<100> silent_;
  std::array<std::uint16_t, 100> registers_{};
  std::array<std::uint64_t, 100> asked_{};
  Descriptor listening_;
  std::jthread thread_;
};

}  // namespace hysteron::test
