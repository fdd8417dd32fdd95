// What systemd is told by a service of Type=notify, over the socket that it names: that it is ready, that it lives,
// that it ends. Without that socket nothing is sent. The protocol is a datagram of text (sd_notify(3)).
// And whether a line that is printed goes to its journal.
#pragma once

#include <chrono>
#include <string_view>

namespace hysteron::runtime {

/// READY=1, WATCHDOG=1, STOPPING=1.
void tell_service_manager(std::string_view message);

/// How often the service manager wants to hear WATCHDOG=1 at the least; 0 where it does not watch.
[[nodiscard]] std::chrono::microseconds service_watchdog();

/// Whether systemd has connected this descriptor to the journal (JOURNAL_STREAM in systemd.exec(5)): a line that begins
/// with <3> has the priority 3 there, and begins behind it (sd-daemon(3)).
[[nodiscard]] bool is_journal(int descriptor);

}  // namespace hysteron::runtime
