// A folder of its own below another, removed with everything in it.
#pragma once

#include <filesystem>

namespace hysteron {

class TemporaryFolder {
 public:
  /// Throws InputError HY700 where no folder can be made.
  explicit TemporaryFolder(const std::filesystem::path& below);
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  TemporaryFolder(TemporaryFolder&&) = delete;
  TemporaryFolder& operator=(TemporaryFolder&&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace hysteron
