// The command line as a whole: which command is meant, help, version, and what is wrong with it.
#pragma once

#include <string>
#include <vector>

#include "tool/console.hpp"

namespace hysteron::tool {

/// Runs the tool with its arguments (without the name of the program); gives back the exit code.
[[nodiscard]] int run_command_line(std::vector<std::string> arguments, Console& console);

}  // namespace hysteron::tool
