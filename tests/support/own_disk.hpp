// A disk of its own, in a process of its own, which a test may fill or make read-only.
#pragma once

#include <gtest/gtest.h>
#include <sched.h>
#include <sys/mount.h>
#include <sys/wait.h>
#include <unistd.h>

#include <string>

#include "tests/support/exit_code.hpp"

namespace hysteron::test {

/// The disk that was made at a folder, with options of tmpfs from now on.
inline void change_disk(const std::string& folder, const char* options, bool is_read_only = false) {
  EXPECT_EQ(::mount("none", folder.c_str(), "tmpfs", MS_REMOUNT | (is_read_only ? 0UL + MS_RDONLY : 0UL), options), 0);
}

/// Tries something with such a disk at that folder, where this machine lets a process have one.
template <class Trial>
void with_own_disk(const std::string& folder, const char* options, const Trial& trial) {
  constexpr int none = 77;
  const pid_t child = ::fork();
  if (child == 0) {
    if (::unshare(CLONE_NEWNS) != 0 && ::unshare(CLONE_NEWUSER | CLONE_NEWNS) != 0) {
      ::_exit(none);
    }
    (void)::mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr);
    if (::mount("none", folder.c_str(), "tmpfs", 0, options) != 0) {
      ::_exit(none);
    }
    trial();
    ::_exit(testing::Test::HasFailure() ? 1 : 0);  // what failed stands on standard output
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  if (exit_code(status) != none) {
    EXPECT_EQ(exit_code(status), 0);
  }
}

}  // namespace hysteron::test
