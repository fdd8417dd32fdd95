#include "records/data_folder.hpp"

#include <cstdlib>
#include <string>

#include "support/diagnostic.hpp"
#include "support/errors.hpp"

namespace hysteron::records {

namespace fs = std::filesystem;

std::optional<fs::path> data_folder(const fs::path& source_folder) {
  std::error_code unknown;
  if (const char* const named = std::getenv("HYSTERON_DATA"); named != nullptr && *named != '\0') {
    if (!fs::is_directory(named, unknown)) {
      throw InputError(error::unreadable_file, {.file = named},
                       "The environment variable HYSTERON_DATA names a folder that is not there.",
                       "correct the variable, or remove it.");
    }
    return fs::path(named);
  }
  for (const fs::path& from : {fs::current_path(unknown), source_folder}) {
    if (const auto folder = (from / "../shared/data").lexically_normal();
        !from.empty() && fs::is_directory(folder, unknown)) {
      return folder;
    }
  }
  return std::nullopt;
}

std::optional<fs::path> find_record(std::string_view name, const fs::path& source_folder) {
  const auto folder = data_folder(source_folder);
  std::error_code unknown;
  if (!folder || !fs::is_regular_file(*folder / name, unknown)) {
    return std::nullopt;
  }
  return *folder / name;
}

}  // namespace hysteron::records
