#include "runtime/task/scheduling.hpp"

#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cfenv>
#include <cstddef>
#include <cstring>

namespace hysteron::runtime {
namespace {

constexpr int deadline_class = 6;  // SCHED_DEADLINE, which sched.h does not name

/// As the kernel's struct sched_attr, whose header cannot stand beside the C library's.
struct SchedulingAttributes {
  std::uint32_t size = sizeof(SchedulingAttributes);
  std::uint32_t policy = deadline_class;
  std::uint64_t flags = 0;
  std::int32_t nice = 0;
  std::uint32_t priority = 0;
  std::uint64_t runtime = 0;
  std::uint64_t deadline = 0;
  std::uint64_t period = 0;
};
static_assert(sizeof(SchedulingAttributes) == 48);

void refuse(SchedulingObtained& obtained, const std::string& what) {
  obtained.refused += (obtained.refused.empty() ? "" : "; ") + what + ": " + std::strerror(errno);
}

void ask_for_class(const SchedulingRequest& request, SchedulingObtained& obtained) {
  if (request.scheduling == Scheduling::fifo) {
    const sched_param parameter{.sched_priority = request.priority};
    if (sched_setscheduler(0, SCHED_FIFO, &parameter) != 0) {
      refuse(obtained, "FIFO " + std::to_string(request.priority));
    }
  } else if (request.scheduling == Scheduling::deadline) {
    const SchedulingAttributes attributes{.runtime = static_cast<std::uint64_t>(request.runtime),
                                          .deadline = static_cast<std::uint64_t>(request.period),
                                          .period = static_cast<std::uint64_t>(request.period)};
    if (syscall(SYS_sched_setattr, 0, &attributes, 0) != 0) {
      refuse(obtained, "DEADLINE");
    }
  }
}

void pin(int processor, SchedulingObtained& obtained) {
  cpu_set_t set;
  CPU_ZERO(&set);
  CPU_SET(static_cast<std::size_t>(processor), &set);
  if (sched_setaffinity(0, sizeof(set), &set) != 0) {
    refuse(obtained, "processor " + std::to_string(processor));
  } else {
    obtained.processor = processor;
  }
}

}  // namespace

SchedulingObtained obtain_scheduling(const SchedulingRequest& request) {
  SchedulingObtained obtained;
  if (request.processor >= 0 && request.scheduling != Scheduling::deadline) {
    pin(request.processor, obtained);
  }
  ask_for_class(request, obtained);
  const int now = sched_getscheduler(0);
  sched_param parameter{};
  (void)sched_getparam(0, &parameter);
  obtained.scheduling = now == SCHED_FIFO       ? Scheduling::fifo
                        : now == deadline_class ? Scheduling::deadline
                                                : Scheduling::other;
  obtained.priority = parameter.sched_priority;
  if (request.lock_memory) {
    obtained.memory_locked = mlockall(MCL_CURRENT | MCL_FUTURE) == 0;
    if (!obtained.memory_locked) {
      refuse(obtained, "locked memory");
    }
  }
  if (obtained.scheduling == Scheduling::other) {
    (void)prctl(PR_SET_TIMERSLACK, 1UL, 0UL, 0UL, 0UL);
  }
  obtained.timer_slack = prctl(PR_GET_TIMERSLACK, 0UL, 0UL, 0UL, 0UL);
  return obtained;
}

std::string description_of(const SchedulingObtained& obtained) {
  std::string text = obtained.scheduling == Scheduling::fifo       ? "FIFO " + std::to_string(obtained.priority)
                     : obtained.scheduling == Scheduling::deadline ? "DEADLINE"
                                                                   : "OTHER";
  if (obtained.scheduling == Scheduling::other) {
    text += ", timer slack " + std::to_string(obtained.timer_slack) + " ns";
  }
  if (obtained.processor >= 0) {
    text += ", processor " + std::to_string(obtained.processor);
  }
  return text + (obtained.memory_locked ? ", memory locked" : ", memory not locked");
}

void default_floating_point() noexcept {
  (void)std::fesetenv(FE_DFL_ENV);  // NOLINT(performance-no-int-to-ptr): the library's own
}

void touch_stack() noexcept {
  std::array<volatile std::byte, std::size_t{256} * 1024> stack;  // NOLINT(cppcoreguidelines-pro-type-member-init)
  for (std::size_t i = 0; i < stack.size(); i += 1024) {
    stack[i] = std::byte{0};
  }
}

}  // namespace hysteron::runtime
