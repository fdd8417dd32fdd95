// Files within a ZIP archive, and unpacking folders of it: never outside of the folder that is given.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <string_view>

struct zip;  // of libzip

namespace hysteron::cosimulation {

class Archive {
 public:
  /// Throws std::runtime_error with the reason where the file cannot be read or is no ZIP archive.
  explicit Archive(const std::string& path);

  [[nodiscard]] bool has(std::string_view name) const { return entries_.contains(name); }
  /// Whether a file lies below the folder.
  [[nodiscard]] bool has_folder(std::string_view folder) const;
  /// The names of the files, sorted.
  [[nodiscard]] const std::map<std::string, std::uint64_t, std::less<>>& entries() const { return entries_; }
  /// The bytes of a file of at most `most` bytes. Throws std::runtime_error with the reason.
  [[nodiscard]] std::string read(std::string_view name, std::uint64_t most) const;
  /// Writes the files below a folder of the archive to the same place below `target`. A name that leads outside is
  /// refused, a link is written as a plain file. Throws std::runtime_error with the reason.
  void unpack(std::string_view folder, const std::filesystem::path& target) const;

 private:
  struct Close {
    void operator()(zip* archive) const;
  };
  std::unique_ptr<zip, Close> archive_;
  std::map<std::string, std::uint64_t, std::less<>> entries_;  ///< by name: the place in the archive
};

}  // namespace hysteron::cosimulation
