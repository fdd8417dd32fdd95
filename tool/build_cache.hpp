// Programs that were compiled before, kept by the hash of what they were compiled from.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

namespace hysteron::tool {

/// A folder of the user's own below the system's folder for temporary files (TMPDIR).
class BuildCache {
 public:
  /// Makes the folder, readable by its owner alone; one that belongs to someone else is not used, but a fresh one.
  /// Throws InputError HY700.
  BuildCache();

  /// Where temporary files may be put: on the same file system.
  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }

  /// The program of a key, made by `build` (which writes to the path that it is given) where there is none yet.
  [[nodiscard]] std::filesystem::path find_or_build(const std::string& key,
                                                    const std::function<void(const std::filesystem::path&)>& build);

 private:
  void forget_old() const;

  std::filesystem::path folder_;
};

}  // namespace hysteron::tool
