// The serial line that a server serves beside its connections: the station on it (rtu_station.hpp), and the line
// itself, which is opened again, after growing waits, for as long as it is not there. Nothing here waits.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "runtime/modbus/client_link.hpp"
#include "runtime/modbus/rtu_station.hpp"
#include "support/descriptor.hpp"

namespace hysteron::runtime::modbus {

struct RtuOptions {
  SerialLink line{};
  std::uint8_t unit = 1;
  std::chrono::nanoseconds longest_gap{0};  ///< 0: 3.5 characters, 20 ms at the least
  bool read_only = false;
};

class RtuLine {
 public:
  /// `tell` is called where the line is lost or cannot be opened, once until it is there, and when it is there again.
  RtuLine(const RtuOptions& options, std::function<void(const std::string& line)> tell);

  /// Opens the line where it is due. True where it was opened now.
  bool open_when_due(Instant now);
  [[nodiscard]] bool is_open() const { return line_.is_open(); }
  [[nodiscard]] const Descriptor& descriptor() const { return line_; }
  [[nodiscard]] bool read_only() const { return options_.read_only; }

  /// Reads what came, answers, and sends what is due. The line may be lost afterwards.
  Served serve(bool is_readable, Instant now, Responder& responder, const Caller& caller);
  /// Whether the line is waited for until it takes bytes.
  [[nodiscard]] bool is_blocked() const { return is_blocked_; }
  [[nodiscard]] std::optional<Instant> next_deadline() const;
  [[nodiscard]] const RtuCounts& counts() const { return station_.counts(); }

 private:
  void lose(const std::string& problem, Instant now);

  RtuOptions options_;
  std::function<void(const std::string& line)> tell_;
  RtuStation station_;
  Descriptor line_{};
  Instant open_at_{};  ///< of the next attempt
  std::chrono::milliseconds wait_;
  bool is_blocked_ = false;
  bool is_told_ = false;
};

}  // namespace hysteron::runtime::modbus
