// A pseudo-terminal as a serial line, and a device at its other end, for tests of both roles.
#pragma once

#include <fcntl.h>
#include <poll.h>
#include <termios.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <stdexcept>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "runtime/modbus/responder.hpp"
#include "support/descriptor.hpp"

namespace hysteron::test {

/// CRC of a serial frame, bit by bit as in the specification.
inline std::uint16_t crc_of(std::span<const std::uint8_t> bytes) {
  std::uint16_t crc = 0xFFFF;
  for (const std::uint8_t byte : bytes) {
    crc ^= byte;
    for (int bit = 0; bit < 8; ++bit) {
      crc = static_cast<std::uint16_t>((crc & 1U) != 0 ? crc >> 1U ^ 0xA001U : crc >> 1U);
    }
  }
  return crc;
}

/// Appends it, the low byte first.
inline std::vector<std::uint8_t> with_crc(std::vector<std::uint8_t> frame) {
  const std::uint16_t crc = crc_of(frame);
  frame.push_back(static_cast<std::uint8_t>(crc & 0xFFU));
  frame.push_back(static_cast<std::uint8_t>(crc >> 8U));
  return frame;
}

/// Two ends: `path` is the line as a program opens it, `other` is what lies at its other end.
class PseudoLine {
 public:
  PseudoLine() : other_(::posix_openpt(O_RDWR | O_NOCTTY)) {
    if (!other_.is_open() || ::grantpt(other_.number()) != 0 || ::unlockpt(other_.number()) != 0) {
      throw std::runtime_error("no pseudo-terminal");
    }
    std::array<char, 128> name{};
    ::ptsname_r(other_.number(), name.data(), name.size());
    path_ = name.data();
    keep_open_ = Descriptor(::open(path_.c_str(), O_RDWR | O_NOCTTY));  // or it hangs up in between
    termios raw{};
    ::tcgetattr(keep_open_.number(), &raw);
    ::cfmakeraw(&raw);
    ::tcsetattr(keep_open_.number(), TCSANOW, &raw);
  }
  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] int other() const { return other_.number(); }

  bool send(std::span<const std::uint8_t> bytes) const {
    return ::write(other(), bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size());
  }
  /// What comes until `size` bytes are there or the time is over.
  [[nodiscard]] std::vector<std::uint8_t> take(std::size_t size, std::chrono::milliseconds patience) const {
    std::vector<std::uint8_t> all;
    const auto until = std::chrono::steady_clock::now() + patience;
    while (all.size() < size && std::chrono::steady_clock::now() < until) {
      pollfd one{other(), POLLIN, 0};
      if (::poll(&one, 1, 5) <= 0) {
        continue;
      }
      std::array<std::uint8_t, 256> bytes{};
      const ssize_t got = ::read(other(), bytes.data(), std::min(bytes.size(), size - all.size()));
      all.insert(all.end(), bytes.begin(), bytes.begin() + std::max<ssize_t>(got, 0));
    }
    return all;
  }

 private:
  Descriptor other_;
  Descriptor keep_open_;
  std::string path_;
};

/// How a SerialDevice fails.
struct LineTrouble {
  bool has_echo = false;  ///< gives back what it hears before it answers
  bool bad_echo = false;  ///< and damages it
  bool bad_checksum = false;
};

/// A serial device at the other end of a line, which answers whole requests by the server's own answers.
class SerialDevice {
 public:
  explicit SerialDevice(runtime::modbus::Responder& responder, LineTrouble trouble = {})
      : responder_(responder), trouble_(trouble), thread_([this](const std::stop_token& stop) { run(stop); }) {}
  [[nodiscard]] const std::string& path() const { return line_.path(); }

 private:
  void run(const std::stop_token& stop) {
    std::vector<std::uint8_t> frame;
    while (!stop.stop_requested()) {
      pollfd one{line_.other(), POLLIN, 0};
      if (::poll(&one, 1, 20) <= 0) {
        frame.clear();
        continue;
      }
      std::array<std::uint8_t, 256> bytes{};
      const ssize_t got = ::read(line_.other(), bytes.data(), bytes.size());
      frame.insert(frame.end(), bytes.begin(), bytes.begin() + std::max<ssize_t>(got, 0));
      const bool whole = frame.size() >= 4 && crc_of(frame) == 0;  // the CRC of a frame with its CRC
      if (!whole) {
        continue;
      }
      const auto reply = responder_.answer(std::span(frame).subspan(1, frame.size() - 3), {});
      std::vector<std::uint8_t> answer{frame[0]};
      answer.insert(answer.end(), reply.pdu().begin(), reply.pdu().end());
      answer = with_crc(std::move(answer));
      answer.back() ^= trouble_.bad_checksum ? 1U : 0U;
      if (trouble_.has_echo) {
        frame[2] ^= trouble_.bad_echo ? 1U : 0U;
        answer.insert(answer.begin(), frame.begin(), frame.end());
      }
      frame.clear();
      if (!line_.send(answer)) {
        return;
      }
    }
  }

  PseudoLine line_;
  runtime::modbus::Responder& responder_;
  LineTrouble trouble_;
  std::jthread thread_;
};

}  // namespace hysteron::test
