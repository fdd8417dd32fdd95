// The server's certificate in the course of years: read again where its files change, told of before it ends.
#pragma once

#include <chrono>
#include <cstdint>
#include <ctime>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "runtime/modbus/tls_context.hpp"

namespace hysteron::runtime::modbus {

/// Looks at the files of a TLS context as time goes by. Never throws, and never takes away what serves: new files that
/// cannot be used are told of once and tried again, for a wrong clock may be why; the certificate of before goes on.
class TlsRenewal {
 public:
  using Clock = std::chrono::steady_clock;

  /// How long the files must rest before they are read: certificate and key are written one after the other.
  static constexpr std::chrono::seconds interval{5};
  /// As many days as are told at the most.
  static constexpr std::time_t most_days = 65'534;
  /// From when on the end of the certificate is told of, once a day.
  static constexpr int days_before = 30;

  /// `serving` was made from these options.
  TlsRenewal(TlsOptions options, std::shared_ptr<const TlsContext> serving, Clock::time_point now);

  struct Found {
    std::shared_ptr<const TlsContext> renewed{};  ///< for connections from now on; none: as before
    std::optional<TlsFault> fault{};              ///< of what serves; none: it was not looked at
    std::uint16_t days = 0;                       ///< with `fault`: until its certificate ends
    std::vector<std::string> lines{};             ///< for a log
  };
  /// To be called as time goes by; looks once an interval. `today` by the wall clock, which may jump.
  [[nodiscard]] Found look(Clock::time_point now, std::time_t today);

 private:
  /// What changes with a file: which it is, its size, when it was written. Nothing where it is not there.
  struct Stamp {
    std::uint64_t device = 0;
    std::uint64_t node = 0;
    std::int64_t bytes = -1;
    std::int64_t seconds = 0;
    std::int64_t nanoseconds = 0;
    bool operator==(const Stamp&) const = default;
  };
  [[nodiscard]] std::vector<Stamp> stamps() const;
  void read_again(Found& found);
  /// What is to be said of dates; empty where all is well for long.
  [[nodiscard]] std::string line_on_dates(std::time_t today, TlsFault fault) const;

  TlsOptions options_;
  std::vector<Stamp> read_;  ///< of the files as they were taken last
  std::vector<Stamp> seen_;  ///< at the last look
  std::shared_ptr<const TlsContext> serving_;
  Clock::time_point next_;
  std::vector<Stamp> tried_{};         ///< when they were not taken last
  std::string refused_{};              ///< why the newest files were not taken; empty where they were
  std::optional<std::time_t> told_{};  ///< the day on which its end was told of
};

}  // namespace hysteron::runtime::modbus
