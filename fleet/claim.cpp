#include "fleet/claim.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace hysteron::fleet {
namespace {

/// A descriptor that no process which is started later inherits.
int opened(const std::filesystem::path& file) {
  const int descriptor = open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  if (descriptor < 0) {
    throw std::system_error(errno, std::generic_category(), file.string());
  }
  return descriptor;
}

}  // namespace

std::optional<Claim> Claim::on(const std::filesystem::path& file) {
  Claim claim(opened(file));
  if (flock(claim.descriptor_, LOCK_EX | LOCK_NB) == 0) {
    return claim;
  }
  if (errno != EWOULDBLOCK && errno != EINTR) {
    throw std::system_error(errno, std::generic_category(), file.string());
  }
  return std::nullopt;
}

Claim Claim::waited_for(const std::filesystem::path& file) {
  Claim claim(opened(file));
  while (flock(claim.descriptor_, LOCK_EX) != 0) {
    if (errno != EINTR) {
      throw std::system_error(errno, std::generic_category(), file.string());
    }
  }
  return claim;
}

Claim::~Claim() {
  if (descriptor_ >= 0) {
    close(descriptor_);
  }
}

}  // namespace hysteron::fleet
