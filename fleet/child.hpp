// A process with limits: of time, by the clock, and of memory.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace hysteron::fleet {

using Clock = std::chrono::steady_clock;

/// A process that runs. It dies with the thread that started it, however that one ends: nobody would read its result.
class Child {
 public:
  static constexpr int killed = 128;  ///< and the number of the signal, as shells say

  /// Starts a program whose two outputs go to these files. `megabytes` bounds its address space. Throws
  /// std::system_error where there is no further process.
  Child(const std::vector<std::string>& command, const std::filesystem::path& output,
        const std::filesystem::path& errors, std::uint64_t megabytes);
  ~Child();  ///< kills what still runs
  Child(Child&& other) noexcept;
  Child& operator=(Child&& other) noexcept;
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  [[nodiscard]] int descriptor() const { return descriptor_; }  ///< readable once it has ended, for poll
  [[nodiscard]] double seconds() const;                         ///< since its start

  /// Kills it and what it has started.
  void kill() const;

  /// Waits for its end. Its exit code; `killed` and the number of the signal that ended it.
  int wait();

 private:
  pid_t pid_ = -1;
  int descriptor_ = -1;
  Clock::time_point begun_ = Clock::now();
};

}  // namespace hysteron::fleet
