#include "runtime/host/new_places.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <system_error>
#include <vector>

namespace hysteron::runtime {

namespace {

struct NamedPath {
  std::string path{};
  const char* named_by = "";
};

bool is_relative(const NamedPath& one) {
  return !one.path.empty() && std::filesystem::path(one.path).is_relative();
}

/// What the next start goes on from.
std::vector<NamedPath> kept_paths(const RunConfig& config) {
  return {{config.retain ? config.retain->folder : "", "[retain] folder"},
          {config.modbus ? config.modbus->lock_file : "", "[modbus] lock_file"},
          {config.history ? config.history->file : "", "[history] file"},
          {config.mqtt ? config.mqtt->file : "", "[mqtt] file"}};
}

}  // namespace

bool names_relative_paths(const RunConfig& config) {
  auto paths = kept_paths(config);
  paths.push_back({config.trace ? config.trace->file.string() : "", "[trace] file"});
  paths.push_back({config.online_change ? config.online_change->socket : "", "[online_change] socket"});
  return std::ranges::any_of(paths, is_relative);
}

std::string new_places(const RunConfig& config) {
  std::vector<std::string> found;
  std::error_code unknown;
  for (const NamedPath& one : kept_paths(config)) {
    if (is_relative(one) && !std::filesystem::exists(one.path, unknown)) {
      found.push_back(fmt::format("{} ({})", one.path, one.named_by));
    }
  }
  return found.empty() ? ""
                       : fmt::format(
                             "nothing is there yet of {} in {}, the folder in which the task was started. If it "
                             "ran before, start it in the same folder, or write absolute paths.",
                             fmt::join(found, ", "), std::filesystem::current_path(unknown).string());
}

}  // namespace hysteron::runtime
