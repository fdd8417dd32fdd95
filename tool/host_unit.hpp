// The systemd unit of a generated host, with the rights that its run file needs and no other.
#pragma once

#include <string>

#include "runtime/config/run_config.hpp"

namespace hysteron::tool {

struct HostNames {
  std::string title{};  ///< of the diagram
  std::string name{};   ///< the same as an identifier
  std::string unit{};   ///< of systemd, without its ending
};

/// Text for CMake's configure_file, which puts in where the program and its run file are installed.
[[nodiscard]] std::string service_unit(const HostNames& names, const runtime::RunConfig& config);

}  // namespace hysteron::tool
