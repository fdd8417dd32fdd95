// The table [history] of a run file.
#pragma once

#include <span>

#include "runtime/config/run_config.hpp"
#include "runtime/config/toml_reader.hpp"
#include "support/diagnostic.hpp"

namespace hysteron::runtime {

class HistoryReading {
 public:
  HistoryReading(const ProgramShape& shape, std::span<const Point> field_points, Diagnostics& found)
      : shape_(&shape), field_points_(field_points), found_(&found) {}

  [[nodiscard]] HistoryConfig read(TomlReader table);

 private:
  const ProgramShape* shape_;
  std::span<const Point> field_points_;
  Diagnostics* found_;
};

}  // namespace hysteron::runtime
