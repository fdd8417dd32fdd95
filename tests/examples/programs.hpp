// The programs of the examples, run as a user runs them.
#pragma once

#include <sys/wait.h>

#include <cstdlib>
#include <string>

namespace hysteron::examples {

/// The folder that they are in.
inline const std::string programs = HYSTERON_EXAMPLE_PROGRAMS;

/// The exit code of a command; -1 where a signal ended it.
inline int run(const std::string& command) {
  const int status = std::system(command.c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace hysteron::examples
