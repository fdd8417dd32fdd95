#include "runtime/task/trace_output.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <string>
#include <system_error>
#include <utility>

#include "runtime/task/trace_file.hpp"
#include "support/atomic_file.hpp"
#include "support/file_identity.hpp"

namespace hysteron::runtime {
namespace {

/// Opened and locked, and still the file of that name: whoever held the lock before may have moved it away.
int open_locked(const std::filesystem::path& file, struct stat& about) {
  for (;;) {
    // Without waiting: a pipe has no end for writing until somebody reads it.
    const int descriptor = ::open(file.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC | O_NONBLOCK, 0666);
    if (descriptor < 0 || ::fstat(descriptor, &about) != 0) {
      return descriptor;
    }
    if (!S_ISREG(about.st_mode)) {
      (void)::close(descriptor);  // a pipe or a device, which have no lock, and nothing to cut off a torn step from
      errno = ENXIO;
      return -1;
    }
    if (::flock(descriptor, LOCK_EX | LOCK_NB) != 0) {
      const int reason = errno;
      (void)::close(descriptor);
      errno = reason;
      return -1;
    }
    if (file_behind(file) == identity_of(about) && ::fstat(descriptor, &about) == 0) {
      return descriptor;
    }
    (void)::close(descriptor);
  }
}

bool is_file(const std::filesystem::path& path) {
  struct stat about {};
  return ::stat(path.c_str(), &about) == 0 && S_ISREG(about.st_mode);
}

/// Whether a trace has no step, as where its trigger did not fire: it is worth no place among those that are kept.
bool holds_no_step(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::string line(trace_first_line.size() + 1, '\0');
  in.read(line.data(), static_cast<std::streamsize>(line.size()));
  if (line != std::string(trace_first_line) + "\n") {
    return false;  // zeros that a power cut left
  }
  while (line != trace_last_line_of_head) {
    if (!std::getline(in, line) || in.eof()) {
      return false;  // a head that is torn: not known to be empty
    }
  }
  std::array<char, record_head> head{};
  while (in.read(head.data(), head.size())) {
    std::uint32_t length = 0;
    std::memcpy(&length, head.data(), sizeof(length));
    if (static_cast<TraceKind>(head[4]) == TraceKind::step) {
      return false;
    }
    in.seekg(length, std::ios::cur);
  }
  return in.eof();
}

/// What stands at the name cannot be a trace, or is that of another task. All else may pass, as a folder on a disk that
/// is not there yet.
bool stays(int reason) {
  return reason == EAGAIN || reason == ENXIO || reason == EISDIR || reason == ENOTDIR || reason == ELOOP ||
         reason == ENAMETOOLONG || reason == ENOTEMPTY || reason == EEXIST;
}

/// Renames FILE to FILE.1, FILE.1 to FILE.2, up to FILE.kept; what had that name is gone. False where FILE cannot be.
bool shift(const std::filesystem::path& file, std::size_t kept) {
  std::size_t last = 1;
  while (last < kept && is_file(previous_trace(file, last))) {
    ++last;
  }
  for (std::size_t number = last; number > 1; --number) {
    (void)::rename(previous_trace(file, number - 1).c_str(), previous_trace(file, number).c_str());
  }
  return ::rename(file.c_str(), previous_trace(file).c_str()) == 0;
}

}  // namespace

std::filesystem::path previous_trace(const std::filesystem::path& file, std::size_t number) {
  return std::filesystem::path(file).concat("." + std::to_string(number));
}

TraceOutput::TraceOutput(std::filesystem::path file, std::size_t kept)
    : file_(std::move(file)), kept_(std::max<std::size_t>(1, kept)) {
  try {
    open_next();
  } catch (const std::system_error& failed) {
    if (stays(failed.code().value())) {
      throw;
    }
    problem_ = failed.what();
    reason_ = failed.code().value();
  }
}

void TraceOutput::open_next() {
  const auto refuse = [](const std::filesystem::path& path) {
    throw std::system_error(errno, std::generic_category(), path.string());
  };
  struct stat about {};
  descriptor_ = open_locked(file_, about);
  if (descriptor_ >= 0 && about.st_size > 0 && holds_no_step(file_)) {
    if (::ftruncate(descriptor_, 0) != 0) {
      refuse(file_);
    }
  } else if (descriptor_ >= 0 && about.st_size > 0) {
    const int before = descriptor_;  // locked until the new file is
    const bool moved = shift(file_, kept_);
    descriptor_ = moved ? open_locked(file_, about) : -1;
    const int reason = errno;
    (void)::close(before);
    errno = reason;
    if (!moved) {
      refuse(previous_trace(file_));
    }
    has_moved_ = true;
  }
  if (descriptor_ < 0) {
    refuse(file_);
  }
  size_ = 0;
}

bool TraceOutput::begin_next() {
  const int before = std::exchange(descriptor_, -1);
  (void)::flock(before, LOCK_UN);  // nobody else writes it: whoever takes it now, keeps this one from its name alone
  try {
    open_next();
  } catch (const std::system_error& failed) {
    problem_ = failed.code() == std::errc::resource_unavailable_try_again
                   ? file_.string() + ": another task writes it by now"
                   : failed.what();
    reason_ = failed.code().value();
    descriptor_ = before;
    (void)::flock(before, LOCK_EX | LOCK_NB);
    return false;
  }
  if (before >= 0) {
    (void)::close(before);
  }
  return true;
}

bool TraceOutput::is_taken_away() const {
  struct stat mine {};
  return ::fstat(descriptor_, &mine) != 0 || file_behind(file_) != identity_of(mine) ||
         static_cast<std::uint64_t>(mine.st_size) < size_;
}

bool TraceOutput::is_deleted() const {
  struct stat mine {};
  return descriptor_ >= 0 && ::fstat(descriptor_, &mine) == 0 && mine.st_nlink == 0;
}

TraceOutput::~TraceOutput() {
  if (descriptor_ >= 0) {
    (void)::close(descriptor_);
  }
}

std::size_t TraceOutput::write(std::string_view bytes) {
  std::size_t done = 0;
  if (descriptor_ < 0) {
    errno = ENOSPC;  // it has not been begun, as on a disk without room
    return done;
  }
  while (done < bytes.size()) {
    const auto count = ::write(descriptor_, bytes.data() + done, bytes.size() - done);
    if (count < 0 && errno != EINTR) {
      const int reason = errno;
      problem_ = file_.string() + ": " + std::strerror(reason);
      reason_ = reason;
      errno = reason;
      break;
    }
    done += count < 0 ? 0 : static_cast<std::size_t>(count);
  }
  size_ += done;
  return done;
}

void TraceOutput::flush() const noexcept {
  (void)::fsync(descriptor_);
  (void)flush_folder(file_.parent_path());
}

void TraceOutput::give_back() noexcept {
  if (has_moved_) {
    (void)::rename(previous_trace(file_).c_str(), file_.c_str());
  }
}

void TraceOutput::take_back(std::size_t bytes) noexcept {
  if (::ftruncate(descriptor_, static_cast<off_t>(size_ - bytes)) == 0) {
    size_ -= bytes;
    (void)::lseek(descriptor_, static_cast<off_t>(size_), SEEK_SET);
  }
}

}  // namespace hysteron::runtime
