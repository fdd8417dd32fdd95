// The slots as files: written aside, flushed, renamed, and the folder flushed, so that the rename is on the disk too.
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "runtime/task/retain.hpp"
#include "support/atomic_file.hpp"
#include "support/file_identity.hpp"

namespace hysteron::runtime {
namespace {

bool write_copy(const std::filesystem::path& from, const std::filesystem::path& to) {
  std::ifstream in(from, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(in), {}};
  Descriptor file(::open(to.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600));
  if (!file.is_open()) {
    return false;
  }
  const bool is_whole = !in.bad() && write_all(file.number(), bytes) && fsync(file.number()) == 0;
  if (!is_whole) {
    const int reason = errno;
    (void)unlink(to.c_str());
    errno = reason;
  }
  return is_whole;
}

/// A slot is never written in place, so a second name keeps its bytes. File systems of memory cards have none.
bool link_or_copy(const std::filesystem::path& from, const std::filesystem::path& to) {
  return link(from.c_str(), to.c_str()) == 0 ||
         ((errno == EPERM || errno == EOPNOTSUPP || errno == EMLINK) && write_copy(from, to));
}

}  // namespace

std::string RetainFolder::problem(const std::filesystem::path& path) {
  reason_ = errno;
  return path.string() + ": " + std::strerror(reason_);
}

std::string RetainFolder::mend() const {
  return way_out(reason_);
}

std::filesystem::path RetainFolder::path_of(std::size_t slot) const {
  return folder_ / (slot == 0 ? "retain_a" : "retain_b");
}

void RetainFolder::open() {
  std::error_code missing;
  std::filesystem::create_directories(folder_, missing);
  if (is_want_of_room(missing.value()) || missing == std::errc::read_only_file_system) {
    return;  // nothing can have been retained there; each state that is written tries again
  }
  Descriptor held(::open(folder_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  // What a disk that is read-only since an error holds, is gone on from.
  const auto is_writable = [&] {
    return faccessat(AT_FDCWD, folder_.c_str(), W_OK | X_OK, AT_EACCESS) == 0 || errno == EROFS;
  };
  if (!held.is_open() || !is_writable() || flock(held.number(), LOCK_EX | LOCK_NB) != 0) {
    throw std::system_error(missing ? missing.value() : errno, std::generic_category(), folder_.string());
  }
  held_ = std::move(held);
}

std::optional<std::vector<std::byte>> RetainFolder::read(std::size_t slot) {
  const auto refuse = [&] { throw std::system_error(errno, std::generic_category(), path_of(slot).string()); };
  const Descriptor file(::open(path_of(slot).c_str(), O_RDONLY | O_CLOEXEC));
  if (file.number() < 0) {
    if (errno != ENOENT) {
      refuse();
    }
    return std::nullopt;
  }
  std::vector<std::byte> bytes;
  std::array<std::byte, 4096> part{};
  for (;;) {
    const auto count = ::read(file.number(), part.data(), part.size());
    if (count < 0 && errno != EINTR) {
      refuse();
    }
    if (count == 0) {
      return bytes;
    }
    bytes.insert(bytes.end(), part.begin(), part.begin() + std::max<std::ptrdiff_t>(count, 0));
  }
}

bool RetainFolder::is_taken_away() const {
  struct stat mine {};
  return held_.is_open() && (::fstat(held_.number(), &mine) != 0 || file_behind(folder_) != identity_of(mine));
}

std::string RetainFolder::write(std::size_t slot, std::span<const std::byte> bytes) {
  if (is_taken_away()) {
    held_ = {};
    was_taken_away_ = true;
  }
  if (!held_.is_open()) {
    std::error_code failed;
    std::filesystem::create_directories(folder_, failed);
    if (failed) {
      reason_ = failed.value();
      return folder_.string() + ": " + failed.message();
    }
    try {
      open();
    } catch (const std::system_error& refused) {
      reason_ = refused.code().value();
      return refused.code() == std::errc::resource_unavailable_try_again
                 ? folder_.string() + ": another task retains its values there by now"
                 : refused.what();
    }
  }
  std::string problem = write_slot(slot, bytes);
  if (problem.empty() && std::exchange(was_taken_away_, false)) {
    remark_ = folder_.string() + " was deleted or moved. It is there again, with the newest state.";
  }
  return problem;
}

std::string RetainFolder::write_slot(std::size_t slot, std::span<const std::byte> bytes) {
  const auto path = path_of(slot);
  const auto fresh = std::filesystem::path(path).concat(".new");
  {
    const Descriptor file(::open(fresh.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600));
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (file.number() < 0 || !write_all(file.number(), text) || fsync(file.number()) != 0) {
      return problem(fresh);
    }
  }
  if (rename(fresh.c_str(), path.c_str()) != 0) {
    return problem(path);
  }
  return flush_folder(folder_) ? std::string() : problem(folder_);
}

std::string RetainFolder::put_aside(std::size_t slot) {
  std::string failed = copy_aside(slot);
  if (failed.empty() && unlink(path_of(slot).c_str()) != 0) {
    failed = problem(path_of(slot));
  }
  return failed;
}

std::string RetainFolder::copy_aside(std::size_t slot) {
  for (int number = 1;; ++number) {
    const auto aside = std::filesystem::path(path_of(slot)).concat(".aside" + std::to_string(number));
    // Both fail where the name is taken; a rename would overwrite what was put aside before.
    if (link_or_copy(path_of(slot), aside)) {
      return {};
    }
    if (errno != EEXIST) {
      return problem(aside);
    }
  }
}

}  // namespace hysteron::runtime
