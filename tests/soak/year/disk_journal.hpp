// What a process did to the files below one folder, in order, and what of it is on the disk after a power cut.
//
// A write is on the disk once its file was flushed; a name that was made, moved or removed, once its folder was. Of the
// rest, a power cut leaves what it likes: names up to any of their changes, as a file system with a journal does, and
// of each file its writes up to any byte, or any of its pages.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <random>
#include <string>
#include <string_view>
#include <vector>

namespace hysteron::soak {

enum class DiskDeed : std::uint8_t { Make, Write, Truncate, Flush, Rename, Link, Remove, FlushFolder };

/// One entry of a journal.
struct DiskEntry {
  DiskDeed deed{};
  std::uint64_t file = 0;
  std::uint64_t at = 0;  ///< of a write: where; of a truncation: the size
  std::string name{};    ///< relative to the folder
  std::string other{};   ///< the new name; of a write: the bytes
};

[[nodiscard]] std::string encode(const DiskEntry& entry);
/// The entries of a journal, up to the last whole one.
[[nodiscard]] std::vector<DiskEntry> decode_journal(std::string_view bytes);

/// Files by name, with their contents.
using DiskImage = std::map<std::string, std::string>;
[[nodiscard]] DiskImage image_of(const std::filesystem::path& folder);
/// Makes the folder hold these files and no others.
void restore(const std::filesystem::path& folder, const DiskImage& image);

struct PowerCut {
  DiskImage image{};
  std::uint64_t lost_bytes = 0;  ///< that were written and are gone
  std::uint64_t lost_names = 0;  ///< changes of names that are undone
};

/// The disk after a power cut that followed this journal.
[[nodiscard]] PowerCut cut_power(const DiskImage& before, const std::vector<DiskEntry>& journal,
                                 std::mt19937_64& random);

}  // namespace hysteron::soak
