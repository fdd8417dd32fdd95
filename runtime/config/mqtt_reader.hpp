// The tables [mqtt] and [dead_bands] of a run file.
#pragma once

#include <cstddef>
#include <set>
#include <string>
#include <string_view>

#include "runtime/config/run_config.hpp"
#include "runtime/config/toml_reader.hpp"
#include "support/diagnostic.hpp"

namespace hysteron::runtime {

class MqttReader {
 public:
  /// The name of the file is not copied.
  MqttReader(const std::string& file, const ProgramShape& shape, RunConfig& config, Diagnostics& found)
      : file_(&file), shape_(&shape), config_(&config), found_(&found) {}
  MqttReader(const std::string&& file, const ProgramShape&, RunConfig&, Diagnostics&) = delete;

  /// Null where the file has none.
  void read(const toml::table* mqtt, const toml::table* dead_bands);

 private:
  void read_broker(TomlReader& table, MqttConfig& mqtt);
  void read_payload(TomlReader& table, MqttConfig& mqtt);
  void read_rows(TomlReader& table, MqttConfig& mqtt);
  void read_dead_bands(const std::string& prefix, const toml::table& table, MqttConfig& mqtt);
  /// A key that does nothing beside the others is an error.
  void useless(const TomlReader& table, std::string_view key, const std::string& why, const std::string& mend);
  void check_name(const TomlReader& table, std::string_view key, const std::string& name, std::string_view levels);

  const std::string* file_;
  const ProgramShape* shape_;
  RunConfig* config_;
  Diagnostics* found_;
  std::set<std::size_t> banded_{};  ///< points whose dead band was read
};

}  // namespace hysteron::runtime
