#include "support/temporary_folder.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <system_error>

#include "support/diagnostic.hpp"
#include "support/errors.hpp"

namespace hysteron {

TemporaryFolder::TemporaryFolder(const std::filesystem::path& below) {
  auto pattern = (below / "run-XXXXXX").string();
  if (::mkdtemp(pattern.data()) == nullptr) {
    throw InputError(error::unwritable_file, {.file = below.string()},
                     fmt::format("No folder can be made in {}: {}.", below.string(), std::strerror(errno)),
                     "make room there, or set TMPDIR to a folder that can be written to.");
  }
  path_ = pattern;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace hysteron
