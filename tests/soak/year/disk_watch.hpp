// Watches what this process does to the files below one folder, and is the disk below it: it fills, and the power goes
// at any byte.
//
// As with the time, functions of the C library are replaced: open, write, fsync, rename and their like go on to the
// system, and are written into a journal (disk_journal.hpp) besides. A flush costs no disk.
#pragma once

#include <cstdint>
#include <filesystem>

namespace hysteron::soak {

class DiskWatch {
 public:
  /// From now on. The journal goes to the end of an open file.
  static void begin(const std::filesystem::path& folder, int journal);
  /// The power goes with this byte of those written from now on, counted from 1; 0: with none. Files with `-shm` do not
  /// count.
  static void cut_at_byte(std::uint64_t byte) noexcept;
  /// The power goes now: SIGKILL.
  [[noreturn]] static void cut() noexcept;
  /// From now on no byte is taken, and no new name; or all again.
  static void set_full(bool is_full) noexcept;
  /// A disk that says that it has flushed and has not, to see that losses are found.
  static void never_flush() noexcept;
};

}  // namespace hysteron::soak
