#include "tests/soak/year/disk_watch.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdarg>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

#include "tests/soak/year/disk_journal.hpp"

namespace hysteron::soak {
namespace {

constexpr std::uint64_t folder_itself = ~std::uint64_t{0};

/// One for the process, as the functions that it replaces.
struct Watch {
  std::mutex mutex{};
  std::string folder{};  ///< with a slash at its end
  int journal = -1;
  std::map<std::string, std::uint64_t> names{};
  std::map<int, std::uint64_t> open{};  ///< by descriptor
  std::uint64_t files = 0;
  std::optional<std::uint64_t> bytes_left{};
  bool is_full = false;
  bool flushes = true;
  std::atomic<bool> is_on{false};
};

Watch& watch() noexcept {
  static Watch one;
  return one;
}

void note(Watch& one, const DiskEntry& entry) {
  const std::string text = encode(entry);
  (void)::syscall(SYS_write, one.journal, text.data(), text.size());
}

/// The name below the folder; nothing for others, and for what readers of SQLite share, which no start reads again.
std::optional<std::string> name_of(const Watch& one, const char* path) {
  const std::string_view text(path);
  if (!one.is_on.load(std::memory_order_relaxed) || !text.starts_with(one.folder) || text.ends_with("-shm")) {
    return std::nullopt;
  }
  return std::string(text.substr(one.folder.size()));
}

/// The folder itself; what lies below it has a name.
bool is_folder(const Watch& one, const char* path) {
  const std::string_view text(path);
  return one.is_on.load(std::memory_order_relaxed) && text.size() + 1 == one.folder.size() &&
         one.folder.starts_with(text);
}

int open_watched(int at, const char* path, int flags, mode_t mode) {
  Watch& one = watch();
  const auto plain = [&] { return static_cast<int>(::syscall(SYS_openat, at, path, flags, mode)); };
  const auto name = name_of(one, path);
  if (!name && !is_folder(one, path)) {
    return plain();
  }
  const std::scoped_lock lock(one.mutex);
  const auto known = one.names.find(name.value_or(""));
  if (known == one.names.end() && (flags & O_CREAT) != 0 && one.is_full) {
    errno = ENOSPC;
    return -1;
  }
  const int file = plain();
  if (file < 0) {
    return file;
  }
  struct stat about {};
  if (::fstat(file, &about) == 0 && S_ISDIR(about.st_mode)) {
    one.open[file] = folder_itself;
    return file;
  }
  if (!S_ISREG(about.st_mode)) {
    return file;
  }
  if (known == one.names.end()) {
    one.names[*name] = one.files;
    note(one, {.deed = DiskDeed::Make, .file = one.files, .name = *name});
    ++one.files;
  } else if ((flags & O_TRUNC) != 0) {
    note(one, {.deed = DiskDeed::Truncate, .file = known->second});
  }
  one.open[file] = one.names[*name];
  return file;
}

/// `at` below 0: where the file stands.
ssize_t write_watched(int file, const void* bytes, std::size_t size, off_t at) {
  Watch& one = watch();
  const auto plain = [&](std::size_t count) {
    return static_cast<ssize_t>(at < 0 ? ::syscall(SYS_write, file, bytes, count)
                                       : ::syscall(SYS_pwrite64, file, bytes, count, at));
  };
  if (!one.is_on.load(std::memory_order_relaxed)) {
    return plain(size);
  }
  const std::scoped_lock lock(one.mutex);
  const auto known = one.open.find(file);
  if (known == one.open.end() || size == 0) {
    return plain(size);
  }
  if (one.is_full) {
    errno = ENOSPC;
    return -1;
  }
  const std::size_t count = one.bytes_left ? std::min<std::size_t>(size, *one.bytes_left) : size;
  const bool is_appended = (::fcntl(file, F_GETFL) & O_APPEND) != 0;
  const off_t begin = at >= 0 ? at : ::lseek(file, 0, is_appended ? SEEK_END : SEEK_CUR);
  const ssize_t written = plain(count);
  if (written > 0) {
    note(one, {.deed = DiskDeed::Write,
               .file = known->second,
               .at = static_cast<std::uint64_t>(begin),
               .other = std::string(static_cast<const char*>(bytes), static_cast<std::size_t>(written))});
  }
  if (one.bytes_left) {
    *one.bytes_left -= count;
    if (*one.bytes_left == 0) {
      DiskWatch::cut();
    }
  }
  return written;
}

int flush_watched(int file, long call) {
  Watch& one = watch();
  if (!one.is_on.load(std::memory_order_relaxed)) {
    return static_cast<int>(::syscall(call, file));
  }
  const std::scoped_lock lock(one.mutex);
  const auto known = one.open.find(file);
  if (known == one.open.end()) {
    return static_cast<int>(::syscall(call, file));
  }
  if (one.flushes) {
    note(one, known->second == folder_itself ? DiskEntry{.deed = DiskDeed::FlushFolder}
                                             : DiskEntry{.deed = DiskDeed::Flush, .file = known->second});
  }
  return 0;
}

int truncate_watched(int file, off_t size) {
  Watch& one = watch();
  const int result = static_cast<int>(::syscall(SYS_ftruncate, file, size));
  if (result == 0 && one.is_on.load(std::memory_order_relaxed)) {
    const std::scoped_lock lock(one.mutex);
    if (const auto known = one.open.find(file); known != one.open.end()) {
      note(one, {.deed = DiskDeed::Truncate, .file = known->second, .at = static_cast<std::uint64_t>(size)});
    }
  }
  return result;
}

int name_watched(DiskDeed deed, const char* from, const char* to) {
  Watch& one = watch();
  const auto old_name = name_of(one, from);
  const auto new_name = to == nullptr ? std::nullopt : name_of(one, to);
  const auto plain = [&] {
    return static_cast<int>(deed == DiskDeed::Rename ? ::syscall(SYS_rename, from, to)
                            : deed == DiskDeed::Link ? ::syscall(SYS_link, from, to)
                                                     : ::syscall(SYS_unlink, from));
  };
  if (!old_name) {
    return plain();
  }
  const std::scoped_lock lock(one.mutex);
  const int result = plain();
  if (result != 0) {
    return result;
  }
  const auto known = one.names.find(*old_name);
  if (known != one.names.end()) {
    const std::uint64_t file = known->second;
    note(one, {.deed = deed, .file = file, .name = *old_name, .other = new_name.value_or("")});
    if (deed != DiskDeed::Link) {
      one.names.erase(known);
    }
    if (new_name) {
      one.names[*new_name] = file;
    }
  }
  return result;
}

mode_t mode_of(int flags, va_list& arguments) {
  return (flags & (O_CREAT | O_TMPFILE)) != 0 ? static_cast<mode_t>(va_arg(arguments, unsigned)) : 0;
}

}  // namespace

void DiskWatch::begin(const std::filesystem::path& folder, int journal) {
  Watch& one = watch();
  one.folder = folder.string() + "/";
  one.journal = journal;
  // In the order of names, as cut_power() counts them.
  for (const auto& [name, bytes] : image_of(folder)) {
    one.names[name] = one.files;
    ++one.files;
  }
  one.is_on = true;
}

void DiskWatch::cut_at_byte(std::uint64_t byte) noexcept {
  const std::scoped_lock lock(watch().mutex);
  watch().bytes_left = byte == 0 ? std::nullopt : std::optional(byte);
}

void DiskWatch::cut() noexcept {
  for (;;) {
    (void)::kill(::getpid(), SIGKILL);
  }
}

void DiskWatch::set_full(bool is_full) noexcept {
  const std::scoped_lock lock(watch().mutex);
  watch().is_full = is_full;
}

void DiskWatch::never_flush() noexcept {
  watch().flushes = false;
}

}  // namespace hysteron::soak

// What is replaced. Names and parameters are those of the C library.
extern "C" {

int open(const char* path, int flags, ...) {
  va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = hysteron::soak::mode_of(flags, arguments);
  va_end(arguments);
  return hysteron::soak::open_watched(AT_FDCWD, path, flags, mode);
}

int open64(const char* path, int flags, ...) {
  va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = hysteron::soak::mode_of(flags, arguments);
  va_end(arguments);
  return hysteron::soak::open_watched(AT_FDCWD, path, flags, mode);
}

int close(int file) {
  hysteron::soak::Watch& one = hysteron::soak::watch();
  if (one.is_on.load(std::memory_order_relaxed)) {
    const std::scoped_lock lock(one.mutex);
    one.open.erase(file);
  }
  return static_cast<int>(::syscall(SYS_close, file));
}

ssize_t write(int file, const void* bytes, size_t size) {
  return hysteron::soak::write_watched(file, bytes, size, -1);
}

ssize_t pwrite(int file, const void* bytes, size_t size, off_t at) {
  return hysteron::soak::write_watched(file, bytes, size, at);
}

ssize_t pwrite64(int file, const void* bytes, size_t size, off64_t at) {
  return hysteron::soak::write_watched(file, bytes, size, at);
}

int fsync(int file) {
  return hysteron::soak::flush_watched(file, SYS_fsync);
}

int fdatasync(int file) {
  return hysteron::soak::flush_watched(file, SYS_fdatasync);
}

int ftruncate(int file, off_t size) noexcept {
  return hysteron::soak::truncate_watched(file, size);
}

int ftruncate64(int file, off64_t size) noexcept {
  return hysteron::soak::truncate_watched(file, size);
}

int rename(const char* from, const char* to) noexcept {
  return hysteron::soak::name_watched(hysteron::soak::DiskDeed::Rename, from, to);
}

int link(const char* from, const char* to) noexcept {
  return hysteron::soak::name_watched(hysteron::soak::DiskDeed::Link, from, to);
}

int unlink(const char* path) noexcept {
  return hysteron::soak::name_watched(hysteron::soak::DiskDeed::Remove, path, nullptr);
}

int remove(const char* path) noexcept {
  const int result = hysteron::soak::name_watched(hysteron::soak::DiskDeed::Remove, path, nullptr);
  return result != 0 && errno == EISDIR ? static_cast<int>(::syscall(SYS_rmdir, path)) : result;
}
}
