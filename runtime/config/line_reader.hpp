// What a run file says of a serial line, of a device or of the server: one set of keys for both.
#pragma once

#include "runtime/config/toml_reader.hpp"
#include "runtime/modbus/client_link.hpp"

namespace hysteron::runtime {

/// The key `serial`, and baud, parity, stop_bits and echo. An empty path where there is none; then the others are
/// errors.
[[nodiscard]] modbus::SerialLink read_line(TomlReader& table, Diagnostics& found);

}  // namespace hysteron::runtime
