// The live page of a host: where it is served, for whom, and what of the task it shows. What `hysteron serve` and a
// generated host have in common.
#pragma once

#include <optional>
#include <string>

#include "runtime/config/run_config.hpp"
#include "runtime/host/host.hpp"
#include "runtime/task/step_program.hpp"
#include "runtime/web/server.hpp"

namespace hysteron::runtime::web {

/// What a command line says; empty where it does not, and then [web] in the run file counts.
struct PageOptions {
  std::string listen{};  ///< ADDRESS:PORT
  std::string token_file{};
  std::string read_token_file{};
};

/// Nothing where no address is named. Throws InputError HY842 to HY844. A service manager may hand the token files over
/// as the credentials `web-token` and `web-read-token`, which then count.
[[nodiscard]] std::optional<ServerOptions> page_server_options(const RunConfig& config, const PageOptions& options);

[[nodiscard]] BesideTask page_beside(const ServerOptions& options, const RunConfig& config, const ProgramShape& shape);

/// Both, of a host whose run file alone counts; empty where that names no address.
[[nodiscard]] BesideTask page_of_run_file(const RunConfig& config, const ProgramShape& shape);

}  // namespace hysteron::runtime::web
