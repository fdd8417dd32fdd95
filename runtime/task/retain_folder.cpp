// The slots as files: written aside, flushed, renamed, and the folder flushed, so that the rename is on the disk too.
#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <string_view>
#include <system_error>
#include <utility>

#include "runtime/task/retain.hpp"
#include "support/atomic_file.hpp"

namespace hysteron::runtime {
namespace {

std::string problem(const std::filesystem::path& path) {
  return path.string() + ": " + std::strerror(errno);
}

/// Gives a file a second name, the first that is not taken. Empty, or why it failed.
std::string link_aside(const std::filesystem::path& path) {
  for (int number = 1;; ++number) {
    const auto aside = std::filesystem::path(path).concat(".aside" + std::to_string(number));
    // A link fails where the name is taken; a rename would overwrite what was put aside before.
    if (link(path.c_str(), aside.c_str()) == 0) {
      return {};
    }
    if (errno != EEXIST) {
      return problem(aside);
    }
  }
}

}  // namespace

std::filesystem::path RetainFolder::path_of(std::size_t slot) const {
  return folder_ / (slot == 0 ? "retain_a" : "retain_b");
}

void RetainFolder::open() {
  std::error_code problem;  // the next call says what is wrong
  std::filesystem::create_directories(folder_, problem);
  if (is_want_of_room(problem.value())) {
    return;  // nothing can have been retained there; each state that is written tries again
  }
  Descriptor held(::open(folder_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (!held.is_open() || faccessat(AT_FDCWD, folder_.c_str(), W_OK | X_OK, AT_EACCESS) != 0 ||
      flock(held.number(), LOCK_EX | LOCK_NB) != 0) {
    throw std::system_error(errno, std::generic_category(), folder_.string());
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

std::string RetainFolder::write(std::size_t slot, std::span<const std::byte> bytes) {
  std::error_code failed;
  std::filesystem::create_directories(folder_, failed);
  if (failed) {
    return folder_.string() + ": " + failed.message();
  }
  if (!held_.is_open()) {
    try {
      open();
    } catch (const std::system_error& refused) {
      return refused.what();
    }
  }
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
  std::string failed = link_aside(path_of(slot));
  if (failed.empty() && unlink(path_of(slot).c_str()) != 0) {
    failed = problem(path_of(slot));
  }
  return failed;
}

/// A slot is never written in place, so a second name keeps its bytes.
std::string RetainFolder::copy_aside(std::size_t slot) {
  return link_aside(path_of(slot));
}

}  // namespace hysteron::runtime
