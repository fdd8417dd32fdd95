#include "runtime/host/new_places.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <system_error>
#include <vector>

namespace hysteron::runtime {

std::string new_places(const RunConfig& config) {
  std::vector<std::string> found;
  const auto look = [&](const std::string& path, const char* named_by) {
    std::error_code unknown;
    if (!path.empty() && std::filesystem::path(path).is_relative() && !std::filesystem::exists(path, unknown)) {
      found.push_back(fmt::format("{} ({})", path, named_by));
    }
  };
  look(config.retain ? config.retain->folder : "", "[retain] folder");
  look(config.modbus ? config.modbus->lock_file : "", "[modbus] lock_file");
  look(config.history ? config.history->file : "", "[history] file");
  look(config.mqtt ? config.mqtt->file : "", "[mqtt] file");
  std::error_code unknown;
  return found.empty() ? ""
                       : fmt::format(
                             "nothing is there yet of {} in {}, the folder in which the task was started. If it "
                             "ran before, start it in the same folder, or write absolute paths.",
                             fmt::join(found, ", "), std::filesystem::current_path(unknown).string());
}

}  // namespace hysteron::runtime
