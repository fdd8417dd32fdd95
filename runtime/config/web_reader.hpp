// The table [web] of a run file: where the live page is, and what it may do for who has its token.
#pragma once

#include "runtime/config/run_config.hpp"
#include "runtime/config/toml_reader.hpp"
#include "support/diagnostic.hpp"

namespace hysteron::runtime {

[[nodiscard]] WebConfig read_web(TomlReader table, Diagnostics& found);

}  // namespace hysteron::runtime
