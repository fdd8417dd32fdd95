// What the Modbus server counts: written by its thread, read by any.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

#include "runtime/modbus/connection.hpp"
#include "runtime/modbus/server.hpp"

namespace hysteron::runtime::modbus {

/// Written by the server's thread alone.
struct ServerCounters {
  using Count = std::atomic<std::uint64_t>;
  Count open{0}, accepted{0}, refused_full{0}, refused_share{0}, refused_address{0}, requests{0}, exceptions{0},
      writes{0}, closed_by_client{0}, client_lost{0}, evicted{0}, saturated{0};
  Count line_frames{0}, line_broken{0}, line_broadcasts{0}, line_echo_lost{0};
  std::array<Count, endings> ended{};
};

inline void add(std::atomic<std::uint64_t>& count, std::uint64_t more = 1) {
  count.store(count.load(std::memory_order_relaxed) + more, std::memory_order_relaxed);
}

inline ServerStatus status_of(const ServerCounters& now) {
  const auto ended = [&](Ending why) { return now.ended.at(static_cast<std::size_t>(why)).load(); };
  return {.open = now.open,
          .accepted = now.accepted,
          .refused_full = now.refused_full,
          .refused_share = now.refused_share,
          .refused_address = now.refused_address,
          .requests = now.requests,
          .exceptions = now.exceptions,
          .writes = now.writes,
          .closed_by_client = now.closed_by_client,
          .frame_late = ended(Ending::frame_late),
          .idle = ended(Ending::idle),
          .unread = ended(Ending::unread),
          .wrong_protocol = ended(Ending::wrong_protocol),
          .wrong_length = ended(Ending::wrong_length),
          .handshake_late = ended(Ending::handshake_late),
          .tls_failed = ended(Ending::tls_failed),
          .evicted = now.evicted,
          .saturated = now.saturated,
          .line = {.frames = now.line_frames,
                   .broken = now.line_broken,
                   .broadcasts = now.line_broadcasts,
                   .echo_lost = now.line_echo_lost},
          .client_lost = now.client_lost != 0};
}

}  // namespace hysteron::runtime::modbus
