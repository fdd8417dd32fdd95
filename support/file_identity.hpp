// Which file a name stands for: another one there is another, whatever it is called.
#pragma once

#include <sys/stat.h>
#include <sys/types.h>

#include <filesystem>
#include <optional>

namespace hysteron {

struct FileIdentity {
  dev_t device = 0;
  ino_t number = 0;

  bool operator==(const FileIdentity&) const = default;
};

[[nodiscard]] inline FileIdentity identity_of(const struct stat& status) {
  return {.device = status.st_dev, .number = status.st_ino};
}

/// Of the file behind the name, through links; nothing where there is none.
[[nodiscard]] inline std::optional<FileIdentity> file_behind(const std::filesystem::path& name) {
  struct stat status {};
  return ::stat(name.c_str(), &status) == 0 ? std::optional(identity_of(status)) : std::nullopt;
}

/// Of what has the name itself, which may be a link; nothing where the name is free.
[[nodiscard]] inline std::optional<FileIdentity> file_named(const std::filesystem::path& name) {
  struct stat status {};
  return ::lstat(name.c_str(), &status) == 0 ? std::optional(identity_of(status)) : std::nullopt;
}

}  // namespace hysteron
