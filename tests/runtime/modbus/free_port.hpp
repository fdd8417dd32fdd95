// A port that nobody listens on.
#pragma once

#include <cstdint>

#include "runtime/modbus/listen.hpp"

namespace hysteron::test {

/// Free a moment ago, at least.
inline std::uint16_t free_port() {
  return runtime::modbus::port_of(runtime::modbus::listen_on("127.0.0.1", 0, {}));
}

}  // namespace hysteron::test
