// A process that is killed while it writes, and what it told of before: that has to be on the disk.
#pragma once

#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <optional>
#include <system_error>
#include <thread>

namespace hysteron::test {

/// Does the work in a child, which tells of what is on the disk again and again, and ends where that fails. It is
/// killed some time after it has told so many times. Gives what it told last; nothing where it told nothing. To be
/// called while the process has one thread. Throws std::system_error where there is no child.
template <class Told, class Work>
std::optional<Told> told_before_kill(int times, std::chrono::nanoseconds later, const Work& work) {
  std::array<int, 2> ends{};
  if (::pipe(ends.data()) != 0) {
    throw std::system_error(errno, std::generic_category(), "pipe");
  }
  const pid_t child = ::fork();
  if (child < 0) {
    throw std::system_error(errno, std::generic_category(), "fork");
  }
  if (child == 0) {
    work([&](const Told& told) {
      if (::write(ends[1], &told, sizeof told) != sizeof told) {
        ::_exit(1);
      }
    });
    ::_exit(1);
  }
  ::close(ends[1]);
  std::optional<Told> last;
  const auto hear = [&] {
    Told told{};
    const bool is_told = ::read(ends[0], &told, sizeof told) == sizeof told;
    last = is_told ? std::optional(told) : last;
    return is_told;
  };
  while (times-- > 0 && hear()) {
  }
  std::this_thread::sleep_for(later);
  ::kill(child, SIGKILL);
  ::waitpid(child, nullptr, 0);
  while (hear()) {
  }
  ::close(ends[0]);
  return last;
}

}  // namespace hysteron::test
