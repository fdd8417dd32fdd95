#include "runtime/task/trace_output.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

namespace hysteron::runtime {
namespace {

/// Opened and locked, and still the file of that name: whoever held the lock before may have moved it away.
int open_locked(const std::filesystem::path& file, struct stat& about) {
  for (;;) {
    // Without waiting: a pipe has no end for writing until somebody reads it.
    const int descriptor = ::open(file.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC | O_NONBLOCK, 0666);
    struct stat now {};
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
    if (::stat(file.c_str(), &now) == 0 && now.st_ino == about.st_ino && now.st_dev == about.st_dev &&
        ::fstat(descriptor, &about) == 0) {
      return descriptor;
    }
    (void)::close(descriptor);
  }
}

}  // namespace

std::filesystem::path previous_trace(const std::filesystem::path& file) {
  return std::filesystem::path(file).concat(".1");
}

TraceOutput::TraceOutput(std::filesystem::path file) : file_(std::move(file)) {
  const auto refuse = [](const std::filesystem::path& path) {
    throw std::system_error(errno, std::generic_category(), path.string());
  };
  struct stat about {};
  descriptor_ = open_locked(file_, about);
  if (descriptor_ >= 0 && about.st_size > 0) {
    const int before = descriptor_;  // locked until the new file is
    const auto kept = previous_trace(file_);
    const bool moved = ::rename(file_.c_str(), kept.c_str()) == 0;
    descriptor_ = moved ? open_locked(file_, about) : -1;
    const int reason = errno;
    (void)::close(before);
    errno = reason;
    if (!moved) {
      refuse(kept);
    }
    has_moved_ = true;
  }
  if (descriptor_ < 0) {
    refuse(file_);
  }
}

TraceOutput::~TraceOutput() {
  (void)::close(descriptor_);
}

std::size_t TraceOutput::write(std::string_view bytes) {
  std::size_t done = 0;
  while (done < bytes.size()) {
    const auto count = ::write(descriptor_, bytes.data() + done, bytes.size() - done);
    if (count < 0 && errno != EINTR) {
      const int reason = errno;
      problem_ = file_.string() + ": " + std::strerror(reason);
      errno = reason;
      break;
    }
    done += count < 0 ? 0 : static_cast<std::size_t>(count);
  }
  size_ += done;
  return done;
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
