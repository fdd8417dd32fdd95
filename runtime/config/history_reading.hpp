// The table [history] of a run file.
#pragma once

#include "runtime/config/run_config.hpp"
#include "runtime/config/toml_reader.hpp"
#include "support/diagnostic.hpp"

namespace hysteron::runtime {

class HistoryReading {
 public:
  HistoryReading(const ProgramShape& shape, Diagnostics& found) : shape_(&shape), found_(&found) {}

  [[nodiscard]] HistoryConfig read(TomlReader table);

 private:
  const ProgramShape* shape_;
  Diagnostics* found_;
};

}  // namespace hysteron::runtime
