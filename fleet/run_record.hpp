// What was asked of a fleet: a file for each manifest that was worked, so that its folder explains itself.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "fleet/manifest.hpp"

namespace hysteron::fleet {

struct Run {
  std::string id{};  ///< of all that follows but `last`
  std::string manifest{};
  std::string version{};
  std::vector<std::string> options{};  ///< of `diagnose`
  std::string last{};                  ///< when it was begun last, 2026-05-02T06:30:00.000000Z
  std::vector<Unit> units{};           ///< with their lines
  std::vector<std::string> keys{};     ///< of the units
};

/// As `runs/ID.json`; id and last are set here. A run of the same units takes the place of the one before. Throws
/// InputError HY700.
void write_run(const std::filesystem::path& output, Run run);

/// All that are whole, the last one at the end.
[[nodiscard]] std::vector<Run> read_runs(const std::filesystem::path& output);

}  // namespace hysteron::fleet
