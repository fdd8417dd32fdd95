// Running another program, with its streams in files.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace hysteron::tool {

struct Streams {
  std::filesystem::path input = "/dev/null";
  std::filesystem::path output = "/dev/null";
  std::filesystem::path errors = "/dev/null";
};

/// Runs a program to its end. Its exit code; 128 and the number of the signal where it was killed, as shells say; 127
/// where it cannot be started.
[[nodiscard]] int run_program(const std::vector<std::string>& command, const Streams& streams);

/// Where PATH has a program; nothing where it has none. A name with a slash is taken as it is.
[[nodiscard]] std::optional<std::filesystem::path> find_program(const std::string& name);

}  // namespace hysteron::tool
