// The system's compilers: which command, and what one says.
#pragma once

#include <filesystem>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace hysteron::tool {

[[nodiscard]] std::vector<std::string> words_of(std::string_view text);

/// The command that an environment variable names, else the first of some names on the path. Nothing where the named
/// one cannot be run, or the path has none.
[[nodiscard]] std::optional<std::vector<std::string>> find_compiler(const char* variable,
                                                                    std::initializer_list<const char*> names);

/// The beginning of what a compiler wrote to a file, as lines of a message.
[[nodiscard]] std::string first_lines(const std::filesystem::path& path);

}  // namespace hysteron::tool
