// The main function of a generated host: its command line, its errors, and the run itself.
#pragma once

#include <functional>
#include <string>

#include "runtime/config/run_config.hpp"
#include "runtime/host/host.hpp"
#include "runtime/task/step_program.hpp"

namespace hysteron::runtime {

struct HostProgram {
  std::string name{};  ///< of the program, for its help
  /// Where the run file names a lock file that is not there yet, the addresses are those of this one.
  std::string addresses{};
  /// Gives what serves the live page. None where the host was generated without one.
  std::function<BesideTask(const RunConfig& config, const ProgramShape& shape)> page{};
};

/// Gives the exit code: 0 it ran and ended as asked; 1 a fault ended it or was there at its end; 2 an error in the
/// command line, the run file, or what the run file names.
[[nodiscard]] int host_program(StepProgram& program, const HostProgram& host, int argc, const char* const* argv);

}  // namespace hysteron::runtime
