// Output files that are there whole or not at all.
//
// Each is written to a temporary in its own folder, flushed to the disk, and renamed. On any failure the temporaries
// and the folders made for them are removed, and files that had been there before are as they were.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "support/diagnostic.hpp"

namespace hysteron {

/// Whether a write failed for a reason, as errno says it, that goes where somebody makes room: the disk, the user's
/// part of it, or the largest size of a file.
[[nodiscard]] bool is_want_of_room(int reason);

/// Whether it failed for the state that the disk is in, which may pass: for want of room, or since the disk has an
/// error, for which the system may have made it read-only.
[[nodiscard]] bool is_trouble_of_disk(int reason);

/// What mends it where a file cannot be used for a reason that has nothing to do with its name, a clause without an
/// end: "make room on the disk". Empty where the name or its rights are the reason.
[[nodiscard]] std::string mend_of_machine(int reason);

/// For a line of a program that runs on: what somebody can do who reads that a write failed for this reason, begun with
/// a capital and without an end.
[[nodiscard]] std::string way_out(int reason);

/// HY700 for a trouble of the disk: what passes without an edit.
class DiskTroubleError : public InputError {
 public:
  using InputError::InputError;
};

struct OutputFile {
  std::filesystem::path path{};
  std::string contents{};
};

/// Writes one file. Missing folders are made; permissions of an existing file are kept; a symbolic link is followed;
/// a device or pipe (/dev/stdout) is written in place. Throws InputError HY700, among them
/// DiskTroubleError.
void write_file_atomically(const std::filesystem::path& path, std::string_view contents);

/// Writes a set of files, all or none. All are on the disk before the first is renamed, so that only a failing rename
/// or a power cut between two can separate them; after a failing rename the earlier ones are put back. Throws
/// InputError HY700; std::invalid_argument where two have the same path.
void write_files_atomically(const std::vector<OutputFile>& files);

/// Writes all of it to an open file, however many calls that takes. Where it cannot be, false, and errno says why.
[[nodiscard]] bool write_all(int descriptor, std::string_view contents) noexcept;

/// Brings the names in a folder to the disk, so that a power cut leaves them; "" is the folder of the process. Where it
/// cannot be, false, and errno says why.
bool flush_folder(const std::filesystem::path& folder) noexcept;

}  // namespace hysteron
