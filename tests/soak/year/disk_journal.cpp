#include "tests/soak/year/disk_journal.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>
#include <optional>

#include "tests/support/scratch_folder.hpp"

namespace hysteron::soak {
namespace {

constexpr std::size_t page = 4096;

void append(std::string& text, std::uint64_t number) {
  std::array<char, sizeof number> bytes{};
  std::memcpy(bytes.data(), &number, sizeof number);
  text.append(bytes.data(), bytes.size());
}

void append(std::string& text, std::string_view bytes) {
  append(text, bytes.size());
  text.append(bytes);
}

class Cursor {
 public:
  explicit Cursor(std::string_view rest) : rest_(rest) {}
  [[nodiscard]] std::optional<std::uint64_t> number() {
    std::uint64_t value = 0;
    if (rest_.size() < sizeof value) {
      return std::nullopt;
    }
    std::memcpy(&value, rest_.data(), sizeof value);
    rest_.remove_prefix(sizeof value);
    return value;
  }
  [[nodiscard]] std::optional<std::string> text() {
    const auto size = number();
    if (!size || rest_.size() < *size) {
      return std::nullopt;
    }
    std::string result(rest_.substr(0, *size));
    rest_.remove_prefix(*size);
    return result;
  }

 private:
  std::string_view rest_;
};

bool changes_names(DiskDeed deed) {
  return deed == DiskDeed::Make || deed == DiskDeed::Rename || deed == DiskDeed::Link || deed == DiskDeed::Remove;
}

bool changes_bytes(DiskDeed deed) {
  return deed == DiskDeed::Write || deed == DiskDeed::Truncate;
}

void apply_bytes(std::string& bytes, const DiskEntry& entry, std::size_t part) {
  if (entry.deed == DiskDeed::Truncate) {
    bytes.resize(entry.at);
    return;
  }
  if (part > 0) {
    bytes.resize(std::max(bytes.size(), entry.at + part));
    bytes.replace(entry.at, part, entry.other, 0, part);
  }
}

/// A file's changes that need not be on the disk: up to a byte of one of them, or any pages of all.
void apply_some(std::string& bytes, const std::vector<const DiskEntry*>& open, std::mt19937_64& random,
                std::uint64_t& lost) {
  const bool by_pages = random() % 2 == 0;
  const std::size_t whole = open.empty() ? 0 : random() % (open.size() + 1);
  for (std::size_t i = 0; i < open.size(); ++i) {
    const DiskEntry& entry = *open[i];
    const std::size_t size = entry.other.size();
    if (by_pages && entry.deed == DiskDeed::Write) {
      for (std::size_t begin = 0; begin < size; begin += page) {
        const std::size_t length = std::min(page, size - begin);
        if (random() % 2 == 0) {
          apply_bytes(bytes,
                      {.deed = DiskDeed::Write, .at = entry.at + begin, .other = entry.other.substr(begin, length)},
                      length);
        } else {
          lost += length;
        }
      }
      continue;
    }
    const std::size_t part = i < whole ? size : i == whole && size > 0 ? random() % size : 0;
    if (entry.deed == DiskDeed::Write || i < whole) {
      apply_bytes(bytes, entry, part);
    }
    lost += size - part;
  }
}

}  // namespace

std::string encode(const DiskEntry& entry) {
  std::string text;
  append(text, static_cast<std::uint64_t>(entry.deed));
  append(text, entry.file);
  append(text, entry.at);
  append(text, std::string_view(entry.name));
  append(text, std::string_view(entry.other));
  return text;
}

std::vector<DiskEntry> decode_journal(std::string_view bytes) {
  std::vector<DiskEntry> entries;
  Cursor cursor(bytes);
  for (;;) {
    const auto deed = cursor.number();
    const auto file = cursor.number();
    const auto at = cursor.number();
    auto name = cursor.text();
    auto other = cursor.text();
    if (!deed || !file || !at || !name || !other) {
      return entries;
    }
    entries.push_back({.deed = static_cast<DiskDeed>(*deed),
                       .file = *file,
                       .at = *at,
                       .name = std::move(*name),
                       .other = std::move(*other)});
  }
}

DiskImage image_of(const std::filesystem::path& folder) {
  DiskImage image;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) {
      image[entry.path().lexically_relative(folder).string()] = test::contents_of(entry.path());
    }
  }
  return image;
}

void restore(const std::filesystem::path& folder, const DiskImage& image) {
  for (const auto& [name, bytes] : image_of(folder)) {
    if (!image.contains(name)) {
      std::filesystem::remove(folder / name);
    }
  }
  for (const auto& [name, bytes] : image) {
    std::filesystem::remove(folder / name);  // another name of the same file would change with it
    std::filesystem::create_directories((folder / name).parent_path());
    std::ofstream(folder / name, std::ios::binary) << bytes;
  }
}

PowerCut cut_power(const DiskImage& before, const std::vector<DiskEntry>& journal, std::mt19937_64& random) {
  // Files that were there have numbers by the order of their names; DiskWatch counts them so.
  std::map<std::string, std::uint64_t> names;
  std::vector<std::string> contents;
  for (const auto& [name, bytes] : before) {
    names[name] = contents.size();
    contents.push_back(bytes);
  }
  std::vector<std::vector<const DiskEntry*>> open(contents.size());
  std::size_t named = 0;  // entries whose names are on the disk
  for (std::size_t i = 0; i < journal.size(); ++i) {
    const DiskEntry& entry = journal[i];
    contents.resize(std::max<std::size_t>(contents.size(), entry.file + 1));
    open.resize(contents.size());
    if (changes_bytes(entry.deed)) {
      open[entry.file].push_back(&entry);
    } else if (entry.deed == DiskDeed::Flush) {
      for (const DiskEntry* const one : open[entry.file]) {
        apply_bytes(contents[entry.file], *one, one->other.size());
      }
      open[entry.file].clear();
    } else if (entry.deed == DiskDeed::FlushFolder) {
      named = i;
    }
  }
  PowerCut cut;
  std::vector<const DiskEntry*> changes;
  std::size_t certain = 0;
  for (std::size_t i = 0; i < journal.size(); ++i) {
    if (changes_names(journal[i].deed)) {
      changes.push_back(&journal[i]);
      certain += i < named ? 1 : 0;
    }
  }
  const std::size_t kept = certain + random() % (changes.size() - certain + 1);
  cut.lost_names = changes.size() - kept;
  for (std::size_t i = 0; i < kept; ++i) {
    const DiskEntry& entry = *changes[i];
    if (entry.deed == DiskDeed::Make) {
      names[entry.name] = entry.file;
    } else if (entry.deed == DiskDeed::Remove) {
      names.erase(entry.name);
    } else if (const auto from = names.find(entry.name); from != names.end()) {
      const std::uint64_t file = from->second;
      if (entry.deed == DiskDeed::Rename) {
        names.erase(from);
      }
      names[entry.other] = file;
    }
  }
  for (std::size_t file = 0; file < contents.size(); ++file) {
    apply_some(contents[file], open[file], random, cut.lost_bytes);
  }
  for (const auto& [name, file] : names) {
    cut.image[name] = contents[file];
  }
  return cut;
}

}  // namespace hysteron::soak
