#include "runtime/config/line_reader.hpp"

#include <array>
#include <string>
#include <string_view>

#include "runtime/modbus/serial_line.hpp"
#include "support/errors.hpp"

namespace hysteron::runtime {

modbus::SerialLink read_line(TomlReader& table, Diagnostics& found) {
  modbus::SerialLink line;
  table.read("serial", line.path);
  table.read_whole("baud", line.baud);
  constexpr std::array<char, 3> parities{'E', 'O', 'N'};
  std::size_t parity = 0;
  table.read_choice("parity", parity);
  line.parity = parities.at(parity);
  table.read_whole("stop_bits", line.stop_bits);
  table.read("echo", line.has_echo);
  if (line.path.empty()) {
    for (const std::string_view key : {"baud", "parity", "stop_bits", "echo"}) {
      if (table.has(key)) {
        found.error(error::wrong_run_value, table.place(key),
                    std::string(key) + " is of a serial line, and none is named.",
                    "name it: serial = \"/dev/ttyUSB0\", or remove the key.");
      }
    }
  } else if (!modbus::is_baud_rate(line.baud)) {
    found.error(error::run_value_out_of_range, table.place("baud"),
                std::to_string(line.baud) + " baud is no rate of a serial line.",
                "choose one of 300, 600, 1200, 2400, 4800, 9600, 19200, 38400, 57600, 115200, 230400, 460800, 500000, "
                "576000, 921600, 1000000 and more, as the device has it.");
  }
  return line;
}

}  // namespace hysteron::runtime
