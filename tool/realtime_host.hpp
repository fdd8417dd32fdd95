// What of a machine makes a cyclic task late, as far as its files tell: kernel, power saving, interrupts, rights.
//
// Everything is read below a root folder, as /proc and /sys show it, and nothing is changed. No right is needed; what
// cannot be read without one is said to be unknown.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace hysteron::tool {

enum class Rating : std::uint8_t { good, unknown, improvable, bad };
[[nodiscard]] std::string_view name_of(Rating rating);

struct HostFinding {
  std::string name{};   ///< what was looked at: governor
  std::string found{};  ///< powersave on 0-3
  Rating rating = Rating::good;
  std::string why{};      ///< what it does to a task; empty where it is good
  std::string command{};  ///< what to type, as root; empty where nothing helps or nothing has to
};

struct HostQuestion {
  std::filesystem::path root = "/";
  std::optional<unsigned> processor{};  ///< of the task; else the first one that is isolated, else any
  int priority = 80;                    ///< of SCHED_FIFO, that the task wants
};

/// In the order in which it is best mended.
[[nodiscard]] std::vector<HostFinding> look_at_host(const HostQuestion& question);

/// Those that are online, sorted; empty where /sys below the root does not tell.
[[nodiscard]] std::vector<unsigned> processors_of(const std::filesystem::path& root);

}  // namespace hysteron::tool
