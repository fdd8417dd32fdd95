// Manual pages and completions of the shell, made from the descriptions that --help prints.
#pragma once

#include <string>
#include <string_view>

namespace CLI {  // NOLINT(readability-identifier-naming): the library is so named
class App;
}

namespace hysteron::tool {

/// hysteron(1), or hysteron-COMMAND(1), in the language of man.
[[nodiscard]] std::string manual_page(const CLI::App& command);

/// What completes commands, options and their words. `shell` is bash, zsh or fish.
[[nodiscard]] std::string completion(const CLI::App& program, std::string_view shell);

}  // namespace hysteron::tool
