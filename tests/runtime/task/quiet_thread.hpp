// How the thread that runs the cycles is watched: a filter of system calls, of which the first that is neither sleep
// nor clock kills, and a count of what its cycles allocate and of the pages they miss.
#pragma once

#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <string>

#include "tests/runtime/namespaces.hpp"
#include "tests/support/counted_new.hpp"

namespace hysteron::runtime::test {

/// From here on, the calling thread may sleep and ask for the time; anything else kills the process.
inline bool allow_only_sleep_and_clock() {
  const auto allow = [](std::uint32_t number) {
    return std::array<sock_filter, 2>{
        {BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, number, 0, 1), BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW)}};
  };
  const auto sleep = allow(SYS_clock_nanosleep);
  const auto clock = allow(SYS_clock_gettime);
  std::array<sock_filter, 6> filter{{BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr)), sleep[0], sleep[1],
                                     clock[0], clock[1], BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_KILL_PROCESS)}};
  const sock_fprog program{.len = static_cast<unsigned short>(filter.size()), .filter = filter.data()};
  return prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 && syscall(SYS_seccomp, SECCOMP_SET_MODE_FILTER, 0, &program) == 0;
}

/// Brings every page of the process in. A path that runs for the first time late, such as that of a missed period,
/// would else meet a page of the program that nobody has read yet; a task in use locks its memory, which a test may
/// lack the rights for.
inline void bring_pages_in() {
  (void)prctl(PR_SET_THP_DISABLE, 1UL, 0UL, 0UL, 0UL);  // joining pages takes them away for a moment
  (void)mlockall(MCL_CURRENT);                          // where the rights are there, they also stay
  constexpr std::uintptr_t largest = 64U << 20U;        // what is larger is a sanitizer's shadow
  std::ifstream maps("/proc/self/maps");
  for (std::string line; std::getline(maps, line);) {
    char* end = nullptr;
    const std::uintptr_t first = std::strtoull(line.c_str(), &end, 16);
    const std::uintptr_t last = std::strtoull(end + 1, &end, 16);
    if (last - first > largest) {
      continue;
    }
    const int populate = end[2] == 'w' ? MADV_POPULATE_WRITE : MADV_POPULATE_READ;
    // NOLINTNEXTLINE(performance-no-int-to-ptr): the kernel writes addresses as text
    (void)madvise(reinterpret_cast<void*>(first), last - first, populate);
  }
}

/// What the cycles of one thread cost after a warm-up. To be told of each, from within it.
class QuietMeter {
 public:
  explicit QuietMeter(std::uint64_t warm_up) : warm_up_(warm_up) {}
  void in_cycle(std::uint64_t cycle) noexcept {
    if (cycle < warm_up_) {
      return;
    }
    (void)getrusage(RUSAGE_THREAD, &after_);
    if (cycle == warm_up_) {
      before_ = after_;
      allocations_before_ = hysteron::test::allocations;
    }
    allocated_ = hysteron::test::allocations - allocations_before_;
  }
  [[nodiscard]] std::uint64_t allocated() const noexcept { return allocated_; }
  [[nodiscard]] long missing_pages() const noexcept {
    return after_.ru_majflt - before_.ru_majflt + after_.ru_minflt - before_.ru_minflt;
  }

 private:
  std::uint64_t warm_up_;
  rusage before_{};
  rusage after_{};
  std::uint64_t allocations_before_ = 0;
  std::uint64_t allocated_ = 0;
};

/// The kernel takes pages away for a moment when it moves memory: by chance, not in every run. A page that the cycles
/// themselves miss is missing in each.
constexpr int attempts_at_no_missing_page = 3;

}  // namespace hysteron::runtime::test
