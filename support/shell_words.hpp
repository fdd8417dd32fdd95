// Words of a command line, as a shell takes them.
#pragma once

#include <string>
#include <string_view>

namespace hysteron {

/// In single quotes of a shell.
[[nodiscard]] std::string shell_quoted(std::string_view text);

/// A word of a command line, in quotes where the shell would take it apart.
[[nodiscard]] std::string shell_word(std::string_view word);

}  // namespace hysteron
