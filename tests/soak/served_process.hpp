// A Modbus server in a process of its own, so that it may die without the measurement.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <string>

#include "runtime/modbus/tls_context.hpp"

namespace hysteron::soak {

enum class ServerKind : std::uint8_t {
  ours,
  plain,  ///< libmodbus as its documentation shows it: select, modbus_receive, modbus_reply
};

class ServedProcess {
 public:
  /// Forks; no thread may be running. Ours is behind TLS where options are given.
  explicit ServedProcess(ServerKind kind, const runtime::modbus::TlsOptions* tls = nullptr);
  ServedProcess(const ServedProcess&) = delete;
  ServedProcess& operator=(const ServedProcess&) = delete;
  ServedProcess(ServedProcess&&) = delete;
  ServedProcess& operator=(ServedProcess&&) = delete;
  ~ServedProcess();

  [[nodiscard]] std::uint16_t port() const { return port_; }
  /// False after it died by itself.
  [[nodiscard]] bool is_alive() const;
  [[nodiscard]] long open_descriptors() const;

 private:
  pid_t process_ = -1;
  std::uint16_t port_ = 0;
};

}  // namespace hysteron::soak
