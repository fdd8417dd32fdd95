// What a run file says of the Modbus server: where it listens, which points it has, and where and how each lies.
#pragma once

#include <string>

#include "runtime/config/run_config.hpp"
#include "runtime/config/toml_reader.hpp"

namespace hysteron::runtime {

class ModbusReader {
 public:
  /// The name of the file is not copied.
  ModbusReader(const std::string& file, RunConfig& config, Diagnostics& found)
      : file_(&file), config_(&config), found_(&found) {}
  ModbusReader(const std::string&& file, RunConfig&, Diagnostics&) = delete;

  /// The table [modbus]; null where there is none.
  void read(const toml::table* modbus, bool over_tls);
  /// The table [modbus_rtu], after [modbus].
  void read_line_of(const toml::table* rtu);
  /// The tables [addresses] and [registers], after [modbus].
  void read_points(const toml::table* addresses, const toml::table* registers);

 private:
  void read_server(TomlReader table, bool over_tls);
  void refuse_open_to_all(const TomlReader& table, const ModbusConfig& modbus, bool over_tls);
  void read_heartbeat(TomlReader& table, ModbusConfig& modbus);
  /// `prefix` is what stands before each name, as HYST. in [addresses.HYST].
  void read_addresses(const std::string& prefix, const toml::table& table);
  void read_registers(const std::string& prefix, const toml::table& table);
  void read_register(const std::string& name, TomlReader table);

  const std::string* file_;
  RunConfig* config_;
  Diagnostics* found_;
};

}  // namespace hysteron::runtime
