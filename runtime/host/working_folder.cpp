#include "runtime/host/working_folder.hpp"

#include <fmt/format.h>

#include <system_error>

namespace hysteron::runtime {

WorkingFolder::WorkingFolder(bool names_files) : names_files_(names_files) {
  std::error_code deleted;
  path_ = std::filesystem::current_path(deleted);
}

std::string WorkingFolder::look() {
  std::error_code problem;
  (void)std::filesystem::current_path(problem);
  // One that has only another name now is the same folder still.
  if (path_.empty() || problem != std::errc::no_such_file_or_directory) {
    return {};
  }
  problem.clear();
  std::filesystem::current_path(path_, problem);
  const bool is_back = !problem;
  const bool is_news = is_back || !is_told_;
  is_told_ = !is_back;
  if (!names_files_ || !is_news) {
    return {};
  }
  return is_back ? fmt::format(
                       "{}, the folder in which the task was started, was deleted, and is there again: what the "
                       "run file names by relative paths is written there.",
                       path_.string())
                 : fmt::format(
                       "{}, the folder in which the task was started, was deleted: what the run file names by "
                       "relative paths is nowhere until that folder is made again.",
                       path_.string());
}

}  // namespace hysteron::runtime
