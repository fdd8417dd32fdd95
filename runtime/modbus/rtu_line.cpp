#include "runtime/modbus/rtu_line.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <system_error>
#include <utility>

#include "runtime/modbus/serial_line.hpp"

namespace hysteron::runtime::modbus {
namespace {

constexpr std::chrono::milliseconds first_wait{50};
constexpr std::chrono::milliseconds longest_wait{2000};
constexpr std::chrono::nanoseconds shortest_gap = std::chrono::milliseconds(20);

RtuTiming timing_of(const RtuOptions& options) {
  const auto silence = rtu_silence(options.line.baud);
  const bool is_given = options.longest_gap.count() > 0;
  return {.silence = silence, .longest_gap = is_given ? options.longest_gap : std::max(silence, shortest_gap)};
}

}  // namespace

RtuLine::RtuLine(const RtuOptions& options, std::function<void(const std::string& line)> tell)
    : options_(options),
      tell_(std::move(tell)),
      station_(options.unit, timing_of(options), options.line.has_echo),
      wait_(first_wait) {}

bool RtuLine::open_when_due(Instant now) {
  if (line_.is_open() || now < open_at_) {
    return false;
  }
  OpenedLine opened = open_line(options_.line);
  if (!opened.line.is_open()) {
    lose(opened.problem, now);
    return false;
  }
  line_ = std::move(opened.line);
  station_.reset();
  if (std::exchange(is_told_, false) && tell_) {
    tell_(options_.line.path + " is there again.");
  }
  return true;
}

Served RtuLine::serve(bool is_readable, Instant now, Responder& responder, const Caller& caller) {
  Served served;
  std::array<std::uint8_t, 2 * longest_rtu_frame> bytes{};
  const ssize_t got = is_readable ? ::read(line_.number(), bytes.data(), bytes.size()) : -1;
  if (got > 0) {
    wait_ = first_wait;
    served = station_.received(std::span(bytes).first(static_cast<std::size_t>(got)), now, responder, caller);
  } else if (is_readable && (got == 0 || (errno != EAGAIN && errno != EINTR))) {
    lose(got == 0 ? "the line was hung up" : std::system_category().message(errno), now);
    return served;
  } else {
    served = station_.silent(now, responder, caller);
  }
  const auto output = station_.output(now);
  is_blocked_ = false;
  if (!output.empty()) {
    const ssize_t sent = ::write(line_.number(), output.data(), output.size());
    is_blocked_ = sent < static_cast<ssize_t>(output.size());
    if (sent >= 0) {
      station_.sent(static_cast<std::size_t>(sent), now);
    } else if (errno != EAGAIN && errno != EINTR) {
      lose(std::system_category().message(errno), now);
    }
  }
  return served;
}

std::optional<Instant> RtuLine::next_deadline() const {
  return !line_.is_open() ? std::optional(open_at_) : is_blocked_ ? std::nullopt : station_.next_deadline();
}

void RtuLine::lose(const std::string& problem, Instant now) {
  line_ = Descriptor();
  is_blocked_ = false;
  station_.reset();
  if (!std::exchange(is_told_, true) && tell_) {
    tell_("the serial line " + options_.line.path + " cannot be used: " + problem +
          ". It is tried again, every 2 s at last; see that it is there and may be opened.");
  }
  open_at_ = now + wait_;
  wait_ = std::min(2 * wait_, longest_wait);
}

}  // namespace hysteron::runtime::modbus
