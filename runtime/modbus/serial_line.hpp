// A serial line as the server has it: opened without waiting, raw, and for this program alone.
#pragma once

#include <string>

#include "runtime/modbus/client_link.hpp"
#include "support/descriptor.hpp"

namespace hysteron::runtime::modbus {

/// Whether a serial line can have this rate.
[[nodiscard]] bool is_baud_rate(int baud);

struct OpenedLine {
  Descriptor line{};
  std::string problem{};  ///< why it is not open
};

[[nodiscard]] OpenedLine open_line(const SerialLink& link);

}  // namespace hysteron::runtime::modbus
