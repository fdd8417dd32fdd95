#include "tool/writable.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "support/diagnostic.hpp"
#include "support/errors.hpp"

namespace hysteron::tool {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const std::string& output, std::string cause, std::string mend) {
  throw InputError(error::unwritable_file, {.file = output}, std::move(cause), std::move(mend));
}

void refuse_locked(const std::string& output, const fs::path& folder) {
  std::error_code unknown;
  if (!fs::is_directory(folder, unknown)) {
    refuse(output, fmt::format("{} is no folder.", folder.string()), "choose another place.");
  }
  // Permissions do not say it all: /proc lets root write and takes no file, a disk may be mounted to be read only.
  std::string trial = (folder / ".hysteron-XXXXXX").string();
  if (::mkdtemp(trial.data()) == nullptr) {
    refuse(output, fmt::format("Nothing can be written into {}: {}.", folder.string(), std::strerror(errno)),
           "choose a folder that can be written.");
  }
  ::rmdir(trial.c_str());
}

fs::path folder_of(const std::string& path) {
  const fs::path parent = fs::absolute(path).lexically_normal().parent_path();
  return parent.empty() ? fs::path("/") : parent;
}

}  // namespace

void refuse_unwritable(const std::string& file) {
  std::error_code unknown;
  if (fs::is_directory(file, unknown)) {
    refuse(file, fmt::format("{} is a folder.", file), "give the name of a file.");
  }
  if (fs::exists(file, unknown) && !fs::is_regular_file(file, unknown)) {
    return;  // a device or a pipe, written in place
  }
  const fs::path folder = folder_of(file);
  if (!fs::exists(folder, unknown)) {
    refuse(file, fmt::format("The folder {} does not exist.", fs::path(file).parent_path().string()),
           fmt::format("make it: mkdir -p {}", fs::path(file).parent_path().string()));
  }
  refuse_locked(file, folder);
}

void refuse_unwritable_folder(const std::string& folder) {
  std::error_code unknown;
  fs::path above = fs::absolute(folder).lexically_normal();
  while (!fs::exists(above, unknown) && above.has_relative_path()) {
    above = above.parent_path();
  }
  refuse_locked(folder, above);
}

}  // namespace hysteron::tool
