// What a thread beside the task has to say: lines, each once, and the problem that holds. Taken by another thread.
#pragma once

#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace hysteron::runtime {

class Remarks {
 public:
  void say(std::string line) {
    const std::scoped_lock lock(mutex_);
    lines_.push_back(std::move(line));
  }
  /// A problem holds from now on. The line is said where none held before.
  void failed(std::string problem, std::string line) {
    const std::scoped_lock lock(mutex_);
    if (problem_.empty()) {
      lines_.push_back(std::move(line));
    }
    problem_ = std::move(problem);
  }
  /// No problem holds. The line is said where one held before.
  void is_well(std::string line) {
    const std::scoped_lock lock(mutex_);
    if (!problem_.empty()) {
      problem_.clear();
      lines_.push_back(std::move(line));
    }
  }
  /// Each line is given once.
  [[nodiscard]] std::vector<std::string> lines() {
    const std::scoped_lock lock(mutex_);
    return std::exchange(lines_, {});
  }
  /// Empty where none holds.
  [[nodiscard]] std::string problem() const {
    const std::scoped_lock lock(mutex_);
    return problem_;
  }

 private:
  mutable std::mutex mutex_;
  std::vector<std::string> lines_{};
  std::string problem_{};
};

}  // namespace hysteron::runtime
