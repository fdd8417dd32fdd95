// A write that fails says so, instead of ending the process.
#pragma once

#include <array>
#include <csignal>

namespace hysteron {

/// The reader of a pipe went away; a file is at the limit of its size. A program that is started from here may know
/// nothing of it: it gets the system's own way back.
inline constexpr std::array signals_of_failed_writes{SIGPIPE, SIGXFSZ};

/// At the start of a program: between two files, or in the middle of a cycle, is no place to end.
inline void let_writes_fail() {
  for (const int signal : signals_of_failed_writes) {
    (void)std::signal(signal, SIG_IGN);
  }
}

}  // namespace hysteron
