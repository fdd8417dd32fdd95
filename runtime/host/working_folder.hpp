// The folder from which relative paths count, for as long as a task runs. Who deletes it and makes it again means the
// same folder; a process that stays in the deleted one could write nothing there any more.
#pragma once

#include <filesystem>
#include <string>

namespace hysteron::runtime {

class WorkingFolder {
 public:
  /// That of the process. `names_files`: whether the run file names anything by a relative path.
  explicit WorkingFolder(bool names_files);

  /// To be called as time goes by. Where the folder was deleted, the process goes into the one of that name, once there
  /// is one. What is to be said; mostly empty.
  [[nodiscard]] std::string look();

 private:
  std::filesystem::path path_{};
  bool names_files_;
  bool is_told_ = false;
};

}  // namespace hysteron::runtime
