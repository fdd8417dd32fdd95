// A task that is started in another folder than last time finds nothing of what it kept, where its paths are relative.
#pragma once

#include <string>

#include "runtime/config/run_config.hpp"

namespace hysteron::runtime {

/// What the run file names by a relative path, and nothing is there yet, as one sentence with its mend; empty where all
/// is there. Before anything of it is made.
[[nodiscard]] std::string new_places(const RunConfig& config);

/// Whether it names anything that is written by a relative path.
[[nodiscard]] bool names_relative_paths(const RunConfig& config);

}  // namespace hysteron::runtime
