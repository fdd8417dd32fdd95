#include "support/text_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <vector>

#include "support/atomic_file.hpp"
#include "support/diagnostic.hpp"
#include "support/errors.hpp"
#include "support/names.hpp"

namespace hysteron {
namespace {

/// What stands in the same folder, for the mend: a file of nearly the same name, else those of the same kind, where
/// they are few.
std::string neighbours(const std::filesystem::path& path) {
  constexpr std::size_t most = 10000;
  constexpr std::size_t few = 3;
  std::error_code ignored;
  const auto folder = path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
  std::vector<std::string> names;
  std::vector<std::string> of_kind;
  auto entries = std::filesystem::directory_iterator(folder, ignored);
  for (; entries != std::filesystem::directory_iterator() && names.size() < most; entries.increment(ignored)) {
    const std::filesystem::path name = entries->path().filename();
    names.push_back(name.string());
    if (path.has_extension() && name.extension() == path.extension()) {
      of_kind.push_back((path.parent_path() / name).string());
    }
  }
  const std::string near(nearest_name(path.filename().string(), names));
  if (!near.empty()) {
    return (path.parent_path() / near).string();
  }
  std::ranges::sort(of_kind);
  return of_kind.size() > few ? std::string() : fmt::format("{}", fmt::join(of_kind, " or "));
}

[[noreturn]] void refuse(const std::string& path, int reason) {
  const auto shown = path.empty() ? std::string("(no name)") : path;
  std::string mend = "give the path of an existing file, as seen from the current folder.";
  if (reason == ENOENT) {
    if (const auto near = neighbours(path); !near.empty()) {
      mend = fmt::format("did you mean {}?", near);
    }
  } else if (reason == EISDIR) {
    mend = "give the path of a file inside it.";
  } else if (const std::string of_machine = mend_of_machine(reason); !of_machine.empty()) {
    mend = of_machine + ".";
  } else if (reason == EACCES) {
    mend = "ask for permission to read it (chmod, chown).";
  }
  throw InputError(error::unreadable_file, Place{.file = path},
                   fmt::format("The file {} cannot be read: {}.", shown, std::strerror(reason)), mend);
}

}  // namespace

std::string read_text_file(const std::string& path) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), std::fclose);
  if (!file) {
    refuse(path, errno);
  }
  std::string text;
  struct stat status {};
  if (fstat(fileno(file.get()), &status) == 0 && S_ISREG(status.st_mode)) {
    text.reserve(static_cast<std::size_t>(status.st_size) + 1);
  }
  std::array<char, 1U << 16U> buffer{};
  while (const std::size_t count = std::fread(buffer.data(), 1, buffer.size(), file.get())) {
    text.append(buffer.data(), count);
  }
  if (std::ferror(file.get()) != 0) {
    refuse(path, errno);
  }
  return text;
}

}  // namespace hysteron
