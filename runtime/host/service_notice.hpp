// What systemd is told by a service of Type=notify, over the socket that it names: that it is ready, that it lives,
// that it ends. Without that socket nothing is sent. The protocol is a datagram of text (sd_notify(3)).
#pragma once

#include <chrono>
#include <string_view>

namespace hysteron::runtime {

/// READY=1, WATCHDOG=1, STOPPING=1.
void tell_service_manager(std::string_view message);

/// How often the service manager wants to hear WATCHDOG=1 at the least; 0 where it does not watch.
[[nodiscard]] std::chrono::microseconds service_watchdog();

}  // namespace hysteron::runtime
