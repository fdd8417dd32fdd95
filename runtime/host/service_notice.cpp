#include "runtime/host/service_notice.hpp"

#include <fmt/format.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstddef>
#include <cstdlib>
#include <cstring>

#include "support/numbers.hpp"

namespace hysteron::runtime {

void tell_service_manager(std::string_view message) {
  const char* const name = std::getenv("NOTIFY_SOCKET");
  sockaddr_un address{};
  const std::size_t length = name == nullptr ? 0 : std::strlen(name);
  if (length == 0 || length >= sizeof address.sun_path) {
    return;
  }
  address.sun_family = AF_UNIX;
  std::memcpy(address.sun_path, name, length);
  if (address.sun_path[0] == '@') {
    address.sun_path[0] = '\0';  // a name that is in no file system
  }
  const int socket = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (socket >= 0) {
    (void)::sendto(socket, message.data(), message.size(), MSG_NOSIGNAL | MSG_DONTWAIT,
                   reinterpret_cast<const sockaddr*>(&address),
                   static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + length));
    (void)::close(socket);
  }
}

std::chrono::microseconds service_watchdog() {
  const char* const text = std::getenv("WATCHDOG_USEC");
  const auto number = parse_number(text == nullptr ? "" : text);
  const bool usable = number.status == NumberStatus::Finite && number.value > 0.0 && number.value < 1e12;
  return std::chrono::microseconds(usable ? static_cast<std::int64_t>(number.value) : 0);
}

bool is_journal(int descriptor) {
  const char* const stream = std::getenv("JOURNAL_STREAM");
  struct stat found {};
  return stream != nullptr && ::fstat(descriptor, &found) == 0 &&
         fmt::format("{}:{}", found.st_dev, found.st_ino) == stream;
}

}  // namespace hysteron::runtime
