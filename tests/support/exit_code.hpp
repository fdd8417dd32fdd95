// How a process ended.
#pragma once

#include <sys/wait.h>

namespace hysteron::test {

/// Its exit code, or 128 and the signal that ended it, as a shell says it.
inline int exit_code(int status) {
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace hysteron::test
