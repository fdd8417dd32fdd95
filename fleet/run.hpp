// Works off the units of a manifest by processes with limits.
//
// What is true lies in the folders of the units alone. Each is renamed into its place once it is whole, so that a kill
// at any moment loses the work of that moment and nothing else. A unit is worked by the one who holds a lock on its
// file (flock): the system gives it back when its holder dies, so no claim outlives anyone.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "fleet/manifest.hpp"
#include "fleet/result.hpp"

namespace hysteron::fleet {

struct RunOptions {
  std::string program{};               ///< called as arguments_of a unit say
  std::string version{};               ///< of the program
  std::vector<std::string> options{};  ///< of `diagnose`; a part of each key
  NamingFiles named_files{};           ///< a part of each key, too
  std::filesystem::path output{};
  std::size_t workers = 1;         ///< processes at once
  double time_limit = 600.0;       ///< s, of each
  std::uint64_t megabytes = 4096;  ///< address space of each
  bool retry = false;              ///< units that had failed are done again
  std::size_t share = 1;           ///< of `shares`, from 1: works the units share - 1, share - 1 + shares, …
  std::size_t shares = 1;
  std::function<void(std::size_t done, std::size_t all, const Unit& last)> progress{};
};

struct Worked {
  std::vector<std::string> keys{};  ///< of all units of the manifest, in its order
  std::size_t ran = 0;              ///< units that were done now
  std::size_t found = 0;            ///< units of the share that were there already, or that another command did
};

/// Works off a share of the units. A unit that another command works on is waited for, and taken over where that one
/// dies. Throws InputError HY730 where two lines are the same unit, HY700 where the folder cannot be written.
[[nodiscard]] Worked work_off(const std::vector<Unit>& units, const std::string& manifest, const RunOptions& options);

}  // namespace hysteron::fleet
