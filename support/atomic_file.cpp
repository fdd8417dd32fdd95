#include "support/atomic_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <set>
#include <stdexcept>
#include <system_error>

#include "support/descriptor.hpp"
#include "support/diagnostic.hpp"
#include "support/errors.hpp"

namespace hysteron {

bool is_want_of_room(int reason) {
  return reason == ENOSPC || reason == EDQUOT || reason == EFBIG;
}

bool is_trouble_of_disk(int reason) {
  return is_want_of_room(reason) || reason == EROFS || reason == EIO || reason == ESTALE;
}

std::string mend_of_machine(int reason) {
  if (is_want_of_room(reason)) {
    return "make room on the disk";
  }
  if (reason == EMFILE || reason == ENFILE) {
    return "let more files be open: `ulimit -n` says how many, and LimitNOFILE= of a service";
  }
  return is_trouble_of_disk(reason) ? "see to the disk: one that could be written before and is read-only now has had "
                                      "an error, and dmesg names it"
                                    : "";
}

std::string way_out(int reason) {
  std::string way = mend_of_machine(reason);
  if (way.empty()) {
    way = reason == ENOENT                      ? "make the folder that is missing"
          : reason == EACCES || reason == EPERM ? "give this user the right to write there"
                                                : "clear what is in the way there";
  }
  way.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(way.front())));
  return way;
}

namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const fs::path& path, int reason) {
  std::string mend = "choose a folder that can be written to, with room on the disk.";
  if (reason == EISDIR) {
    mend = "give the name of a file, or remove the folder of that name.";
  } else if (reason == ENAMETOOLONG) {
    mend = "give it a shorter name; a generated file is named after its block.";
  } else if (const std::string of_machine = mend_of_machine(reason); !of_machine.empty()) {
    mend = of_machine + (is_trouble_of_disk(reason) ? "; or choose another one." : ".");
  }
  const Place place{.file = path.string()};
  const auto cause = fmt::format("The file {} cannot be written: {}.", path.string(), std::strerror(reason));
  if (is_trouble_of_disk(reason)) {
    throw DiskTroubleError(error::unwritable_file, place, cause, mend);
  }
  throw InputError(error::unwritable_file, place, cause, mend);
}

void write_in_place(const fs::path& path, std::string_view contents) {
  Descriptor file(::open(path.c_str(), O_WRONLY | O_CLOEXEC));
  if (file.number() < 0 || !write_all(file.number(), contents) || !file.close()) {
    refuse(path, errno);
  }
}

fs::path folder_of(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

/// A set of outputs on its way to the disk. What has not been committed is undone by the destructor.
class Staging {
 public:
  Staging() = default;
  Staging(const Staging&) = delete;
  Staging& operator=(const Staging&) = delete;
  Staging(Staging&&) = delete;
  Staging& operator=(Staging&&) = delete;
  ~Staging() {
    for (const Entry& entry : entries_) {
      if (!committed_ && entry.renamed) {
        if (entry.backup.empty()) {
          ::unlink(entry.target.c_str());
        } else {
          ::rename(entry.backup.c_str(), entry.target.c_str());
        }
      }
      if (!entry.renamed) {
        ::unlink(entry.temporary.c_str());
      }
      if (!entry.backup.empty()) {
        ::unlink(entry.backup.c_str());
      }
    }
    if (!committed_) {
      std::for_each(made_.rbegin(), made_.rend(), [](const fs::path& folder) { ::rmdir(folder.c_str()); });
    }
  }

  void add(const fs::path& path, std::string_view contents) {
    std::error_code unknown;
    const bool link = fs::is_symlink(path, unknown);
    const fs::path target = link ? fs::weakly_canonical(path, unknown) : path;
    struct stat status {};
    const bool exists = ::stat(target.c_str(), &status) == 0;
    if (exists && S_ISDIR(status.st_mode)) {
      refuse(path, EISDIR);
    }
    if (exists && !S_ISREG(status.st_mode)) {
      write_in_place(target, contents);
      return;
    }
    make_folder(path, folder_of(target));
    entries_.push_back({.target = target, .temporary = fresh_name(target), .backup = {}, .renamed = false});
    const auto& temporary = entries_.back().temporary;
    Descriptor file(::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
    if (file.number() < 0 || !write_all(file.number(), contents) ||
        (exists && ::fchmod(file.number(), status.st_mode & 07777U) != 0) || ::fsync(file.number()) != 0 ||
        !file.close()) {
      refuse(path, errno);
    }
  }

  void commit() {
    std::set<fs::path> folders;
    for (Entry& entry : entries_) {
      // A second name keeps the old file until all are in place. A file system without hard links has to do without.
      const fs::path backup = fresh_name(entry.target);
      if (entries_.size() > 1 && ::link(entry.target.c_str(), backup.c_str()) == 0) {
        entry.backup = backup;
      }
      if (::rename(entry.temporary.c_str(), entry.target.c_str()) != 0) {
        refuse(entry.target, errno);
      }
      entry.renamed = true;
      folders.insert(folder_of(entry.target));
    }
    committed_ = true;
    for (const fs::path& folder : folders) {
      // The names are in place already; a folder that cannot be flushed is no reason to report a failure.
      (void)flush_folder(folder);
    }
  }

 private:
  struct Entry {
    fs::path target{};
    fs::path temporary{};
    fs::path backup{};
    bool renamed = false;
  };

  /// A name in the folder of the target that no other process and no other file of this set uses.
  fs::path fresh_name(const fs::path& target) {
    fs::path name;
    std::error_code unknown;
    do {
      name = folder_of(target) / fmt::format(".hysteron-{}-{}.tmp", ::getpid(), counter_++);
    } while (fs::exists(fs::symlink_status(name, unknown)));
    return name;
  }

  void make_folder(const fs::path& path, const fs::path& folder) {
    std::vector<fs::path> missing;
    std::error_code unknown;
    for (fs::path at = folder; !at.empty() && !fs::exists(at, unknown); at = at.parent_path()) {
      missing.push_back(at);
      if (at == at.parent_path()) {
        break;
      }
    }
    std::reverse(missing.begin(), missing.end());
    for (const fs::path& at : missing) {
      if (::mkdir(at.c_str(), 0777) == 0) {
        made_.push_back(at);
      } else if (errno != EEXIST) {
        refuse(path, errno);
      }
    }
  }

  std::vector<Entry> entries_;
  std::vector<fs::path> made_;
  unsigned counter_ = 0;
  bool committed_ = false;
};

}  // namespace

bool write_all(int descriptor, std::string_view contents) noexcept {
  while (!contents.empty()) {
    const ssize_t written = ::write(descriptor, contents.data(), contents.size());
    if (written < 0) {
      if (errno == EINTR) {
        continue;
      }
      return false;
    }
    contents.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

bool flush_folder(const fs::path& folder) noexcept {
  const Descriptor opened(::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  return opened.number() >= 0 && ::fsync(opened.number()) == 0;
}

void write_file_atomically(const fs::path& path, std::string_view contents) {
  Staging staging;
  staging.add(path, contents);
  staging.commit();
}

void write_files_atomically(const std::vector<OutputFile>& files) {
  std::set<fs::path> paths;
  for (const OutputFile& file : files) {
    if (!paths.insert(file.path.lexically_normal()).second) {
      throw std::invalid_argument("two output files have the path " + file.path.string());
    }
  }
  Staging staging;
  for (const OutputFile& file : files) {
    staging.add(file.path, file.contents);
  }
  staging.commit();
}

}  // namespace hysteron
