// What a run file says of TLS: the files of certificates, and what each role may do.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "runtime/config/run_config.hpp"
#include "runtime/config/toml_reader.hpp"

namespace hysteron::runtime {

class TlsReader {
 public:
  /// The name of the file is not copied.
  TlsReader(const std::string& file, RunConfig& config, Diagnostics& found)
      : file_(&file), config_(&config), found_(&found) {}
  TlsReader(const std::string&& file, RunConfig&, Diagnostics&) = delete;

  /// The tables [tls] and [roles], after [modbus]; null where the file has none.
  void read(const toml::table* tls, const toml::table* roles);

 private:
  void read_files(TomlReader table, modbus::TlsOptions& tls);
  void read_role(const std::string& name, const toml::node& node, modbus::TlsOptions& tls);
  modbus::Rights rights_in(const std::vector<std::string>& words, const Place& place);

  const std::string* file_;
  RunConfig* config_;
  Diagnostics* found_;
};

}  // namespace hysteron::runtime
