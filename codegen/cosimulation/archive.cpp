#include "codegen/cosimulation/archive.hpp"

#include <fmt/format.h>
#include <zip.h>

#include <array>
#include <fstream>
#include <stdexcept>

namespace hysteron::cosimulation {
namespace {

namespace fs = std::filesystem;

/// Above it an archive is taken for one that is to fill the disk.
constexpr std::uint64_t most_unpacked = std::uint64_t{4} << 30U;

struct CloseFile {
  void operator()(zip_file_t* file) const { zip_fclose(file); }
};

zip_stat_t stat_of(zip_t* archive, std::uint64_t index, std::string_view name) {
  zip_stat_t about;
  constexpr zip_uint64_t needed = ZIP_STAT_SIZE;
  if (zip_stat_index(archive, index, 0, &about) != 0 || (about.valid & needed) == 0) {
    throw std::runtime_error(fmt::format("{} cannot be found in the archive", name));
  }
  return about;
}

/// Gives the bytes of a file in pieces.
template <class Take>
void read_pieces(zip_t* archive, std::uint64_t index, std::string_view name, std::uint64_t most, const Take& take) {
  const std::unique_ptr<zip_file_t, CloseFile> file(zip_fopen_index(archive, index, 0));
  if (!file) {
    throw std::runtime_error(fmt::format("{} cannot be unpacked: {}", name, zip_strerror(archive)));
  }
  std::array<char, 65536> piece{};
  std::uint64_t total = 0;
  while (true) {
    const zip_int64_t count = zip_fread(file.get(), piece.data(), piece.size());
    if (count < 0) {
      throw std::runtime_error(fmt::format("{} cannot be unpacked: the archive is damaged", name));
    }
    if (count == 0) {
      return;
    }
    total += static_cast<std::uint64_t>(count);
    if (total > most) {
      throw std::runtime_error(fmt::format("{} is larger than {} bytes", name, most));
    }
    take(std::string_view(piece.data(), static_cast<std::size_t>(count)));
  }
}

/// Whether a name stays below the folder that it is unpacked to.
bool stays_inside(std::string_view name) {
  if (name.find('\\') != std::string_view::npos || name.find('\0') != std::string_view::npos ||
      fs::path(name).is_absolute()) {
    return false;
  }
  for (const fs::path& part : fs::path(name)) {
    if (part == "..") {
      return false;
    }
  }
  return true;
}

}  // namespace

void Archive::Close::operator()(zip* archive) const {
  zip_discard(archive);
}

Archive::Archive(const std::string& path) {
  int problem = 0;
  archive_.reset(zip_open(path.c_str(), ZIP_RDONLY, &problem));
  if (!archive_) {
    zip_error_t error;
    zip_error_init_with_code(&error, problem);
    const std::string reason = zip_error_strerror(&error);
    zip_error_fini(&error);
    throw std::runtime_error(reason);
  }
  const zip_int64_t count = zip_get_num_entries(archive_.get(), 0);
  for (zip_int64_t i = 0; i < count; ++i) {
    const char* const name = zip_get_name(archive_.get(), static_cast<zip_uint64_t>(i), 0);
    if (name != nullptr) {
      entries_.emplace(name, static_cast<std::uint64_t>(i));
    }
  }
}

bool Archive::has_folder(std::string_view folder) const {
  const auto first = entries_.lower_bound(folder);
  return first != entries_.end() && first->first.starts_with(folder);
}

std::string Archive::read(std::string_view name, std::uint64_t most) const {
  const auto found = entries_.find(name);
  if (found == entries_.end()) {
    throw std::runtime_error(fmt::format("there is no {} in the archive", name));
  }
  std::string text;
  read_pieces(archive_.get(), found->second, name, most, [&](std::string_view piece) { text += piece; });
  return text;
}

void Archive::unpack(std::string_view folder, const fs::path& target) const {
  std::uint64_t left = most_unpacked;
  for (auto entry = entries_.lower_bound(folder); entry != entries_.end() && entry->first.starts_with(folder);
       ++entry) {
    const auto& [name, index] = *entry;
    if (name.ends_with('/')) {
      continue;
    }
    if (!stays_inside(name)) {
      throw std::runtime_error(fmt::format("the name {} leads out of the folder that it is unpacked to", name));
    }
    const fs::path path = target / name;
    fs::create_directories(path.parent_path());
    const std::uint64_t size = stat_of(archive_.get(), index, name).size;
    if (size > left) {
      throw std::runtime_error(fmt::format("it unpacks to more than {} bytes", most_unpacked));
    }
    left -= size;
    std::ofstream file(path, std::ios::binary);
    read_pieces(archive_.get(), index, name, size, [&](std::string_view piece) { file << piece; });
    file.close();
    if (!file) {
      throw std::runtime_error(fmt::format("{} cannot be written", path.string()));
    }
  }
}

}  // namespace hysteron::cosimulation
