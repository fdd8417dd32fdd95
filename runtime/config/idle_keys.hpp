// Keys of a run file that do nothing beside what else it says: a file that is right otherwise, and of which somebody
// expects more than it does.
#pragma once

#include <string>

#include "runtime/config/run_config.hpp"
#include "support/toml_text.hpp"

namespace hysteron::runtime {

/// A warning for each, at its place, with why it does nothing and what to write. `root`: the file that `config` is of.
void warn_of_idle_keys(const std::string& file, const toml::table& root, const RunConfig& config, Diagnostics& found);

}  // namespace hysteron::runtime
