// A host for a target machine: the generated step, the runtime's sources, a build file, a systemd unit and a README.
#pragma once

#include <string>
#include <vector>

#include "codegen/backends/cpp/cpp.hpp"
#include "support/overwriting.hpp"

namespace hysteron::tool {

struct HostRequest {
  std::string run_file{};           ///< its path, for errors and for the head of its copy
  std::vector<InputFile> inputs{};  ///< over which the lock file must not be written
  bool float32 = false;
};

/// The files of the host; names are paths within its folder. The register map is that of `hysteron serve` with the same
/// run file; where that names a lock file, it is read, and written as `serve` does. Throws InputError as the run file
/// and the lock file do, and HY404 where the diagram states no sample time.
[[nodiscard]] std::vector<GeneratedFile> generate_host(const Program& program, const HostRequest& request);

}  // namespace hysteron::tool
