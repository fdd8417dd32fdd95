// Whether a server of the tests has something to do.
#pragma once

#include <poll.h>

#include "support/descriptor.hpp"

namespace hysteron::test {

/// Within a moment that is short enough to see in between that the server is to stop.
inline bool readable(const Descriptor& socket) {
  pollfd one{socket.number(), POLLIN, 0};
  return ::poll(&one, 1, 5) > 0;
}

}  // namespace hysteron::test
