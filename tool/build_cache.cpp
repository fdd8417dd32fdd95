#include "tool/build_cache.hpp"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <system_error>

#include "support/diagnostic.hpp"
#include "support/errors.hpp"
#include "support/temporary_folder.hpp"
#include "tool/process.hpp"

namespace hysteron::tool {
namespace {

namespace fs = std::filesystem;

constexpr auto kept_for = std::chrono::hours(24 * 7);

/// Whether a folder is the user's own, and closed to others: what lies in it is going to be run.
bool is_own_folder(const fs::path& folder) {
  struct stat status {};
  return ::lstat(folder.c_str(), &status) == 0 && S_ISDIR(status.st_mode) && status.st_uid == ::geteuid() &&
         (status.st_mode & 077U) == 0;
}

}  // namespace

BuildCache::BuildCache() {
  std::error_code unknown;
  const auto temporary = fs::temp_directory_path(unknown);
  folder_ = (unknown ? fs::path("/tmp") : temporary) / fmt::format("hysteron-{}", ::geteuid());
  (void)::mkdir(folder_.c_str(), 0700);
  for (int number = 2; !is_own_folder(folder_); ++number) {
    if (number > 100) {
      throw InputError(
          error::unwritable_file, {.file = folder_.string()},
          fmt::format("No folder for compiled programs can be made in {}.", folder_.parent_path().string()),
          "set TMPDIR to a folder that can be written to.");
    }
    folder_.replace_filename(fmt::format("hysteron-{}-{}", ::geteuid(), number));
    (void)::mkdir(folder_.c_str(), 0700);
  }
  forget_old();
}

fs::path BuildCache::find_or_build(const std::string& key, const std::function<void(const fs::path&)>& build) {
  auto program = folder_ / key;
  std::error_code ignored;
  if (fs::exists(program, ignored)) {
    fs::last_write_time(program, fs::file_time_type::clock::now(), ignored);
    return program;
  }
  const TemporaryFolder scratch(folder_);
  const auto fresh = scratch.path() / "program";
  build(fresh);
  fs::rename(fresh, program);  // at once: another run may be looking for the same program
  return program;
}

void BuildCache::forget_old() const {
  std::error_code ignored;
  const auto oldest = fs::file_time_type::clock::now() - kept_for;
  for (const auto& entry : fs::directory_iterator(folder_, ignored)) {
    if (entry.last_write_time(ignored) < oldest) {
      fs::remove_all(entry.path(), ignored);
    }
  }
}

}  // namespace hysteron::tool
