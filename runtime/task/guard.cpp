#include "runtime/task/guard.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <ctime>
#include <new>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "runtime/task/clock.hpp"

namespace hysteron::runtime {
namespace {

volatile std::sig_atomic_t asked_to_end = 0;

/// Waits until a time, or until the process behind the descriptor is gone; true where it is gone.
bool gone_by(int process, std::int64_t time) {
  const std::int64_t left = std::max<std::int64_t>(0, time - monotonic_now());
  const timespec wait{.tv_sec = static_cast<time_t>(left / 1'000'000'000),
                      .tv_nsec = static_cast<long>(left % 1'000'000'000)};
  pollfd descriptor{.fd = process, .events = POLLIN, .revents = 0};
  return ppoll(&descriptor, 1, &wait, nullptr) > 0;
}

/// Who reads what the task prints waits for the end of the last process that could still write there.
void leave_standard_streams() {
  const int nowhere = open("/dev/null", O_RDWR | O_CLOEXEC);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    (void)dup2(nowhere, stream);
  }
  if (nowhere > STDERR_FILENO) {
    (void)close(nowhere);
  }
}

/// The life of the guard's process. Gives back when its work is done.
void guard_life(const GuardSettings& settings, GuardPage& page, SafeOutputs outputs, OutputDevice& device, int task) {
  std::vector<double> last(outputs.values().begin(), outputs.values().end());
  bool gone = false;
  bool taken = false;
  std::int64_t next = monotonic_now();
  for (;;) {
    next = std::max(next + settings.period, monotonic_now());
    if (gone) {
      const timespec until{.tv_sec = static_cast<time_t>(next / 1'000'000'000),
                           .tv_nsec = static_cast<long>(next % 1'000'000'000)};
      (void)clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr);
    } else if (gone = gone_by(task, next); gone) {
      // A task that began no cycle has written nothing that would have to become safe.
      GuardWord word = GuardWord::starting;
      if (page.word.compare_exchange_strong(word, GuardWord::goodbye)) {
        return;
      }
      device.task_is_gone();
      leave_standard_streams();
    }
    if (page.word.load(std::memory_order_acquire) == GuardWord::goodbye) {
      return;
    }
    if (!taken) {
      const Fault fault = gone ? Fault::crash
                          : page.word.load() == GuardWord::starting
                              ? Fault::none
                              : heartbeat_fault(settings, page.began.load(std::memory_order_relaxed),
                                                page.in_step.load(std::memory_order_acquire), monotonic_now());
      GuardWord word = page.word.load();
      if (fault == Fault::none || word == GuardWord::goodbye ||
          !page.word.compare_exchange_strong(word, GuardWord::taken)) {
        continue;
      }
      taken = true;
      page.fault.store(fault);
      page.taken_at.store(monotonic_now());
      for (std::size_t i = 0; i < last.size(); ++i) {
        last[i] = page.outputs[i].load(std::memory_order_relaxed);
      }
      outputs.start_from(last);
    }
    outputs.step(last, page.fault.load());
    const bool written = device.write(outputs.values());
    if (written && (outputs.settled() || outputs.stuck()) && page.safe_at.load() == 0) {
      page.safe_at.store(monotonic_now());
    }
    // While the task's process lives it could come back and write: the guard stays.
    if (page.safe_at.load() != 0 && (gone || asked_to_end != 0)) {
      return;
    }
  }
}

}  // namespace

Fault heartbeat_fault(const GuardSettings& settings, std::int64_t began, bool in_step, std::int64_t now) noexcept {
  const std::int64_t longest = settings.watchdog.longest();
  const bool hangs = in_step && longest > 0 && now - began > longest;
  return hangs || now - began > settings.silence ? Fault::hang : Fault::none;
}

Guard::Guard(const GuardSettings& settings, const SafeOutputs& outputs, OutputDevice& device) {
  if (outputs.values().size() > GuardPage::most_outputs) {
    throw std::invalid_argument("a guard holds at most 256 outputs");
  }
  void* const memory = mmap(nullptr, sizeof(GuardPage), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) {  // NOLINT(performance-no-int-to-ptr): the system's own
    throw std::system_error(errno, std::generic_category(), "memory for the guard");
  }
  page_ = new (memory) GuardPage;
  for (std::size_t i = 0; i < outputs.values().size(); ++i) {
    page_->outputs[i].store(outputs.values()[i]);
  }
  // Where whoever started this ignores the ends of its children, the guard's end could not be seen.
  (void)std::signal(SIGCHLD, SIG_DFL);
  // Opened before the fork: the number of a process that is gone may be given to another.
  const auto task = static_cast<int>(syscall(SYS_pidfd_open, getpid(), 0));
  process_ = task < 0 ? -1 : fork();
  if (process_ == 0) {
    // Out of the task's session: the Ctrl-C that ends the task must not end its guard.
    (void)setsid();
    (void)prctl(PR_SET_NAME, "hysteron-guard");
    (void)std::signal(SIGINT, SIG_IGN);
    (void)std::signal(SIGHUP, SIG_IGN);
    (void)std::signal(SIGABRT, SIG_IGN);  // what systemd sends to all processes of a service that hangs
    (void)std::signal(SIGTERM, [](int) { asked_to_end = 1; });
    device.open();
    guard_life(settings, *page_, outputs, device, task);
    _exit(0);
  }
  const int problem = errno;
  if (task >= 0) {
    (void)close(task);
  }
  if (process_ < 0) {
    (void)munmap(page_, sizeof(GuardPage));
    throw std::system_error(problem, std::generic_category(), "the guard's process");
  }
}

Guard::~Guard() {
  GuardWord word = GuardWord::starting;
  (void)page_->word.compare_exchange_strong(word, GuardWord::goodbye);
  if (page_->word.load() == GuardWord::goodbye && !is_reaped_) {
    (void)waitpid(process_, nullptr, 0);
  }
  (void)munmap(page_, sizeof(GuardPage));
}

void Guard::cycle_ends(std::span<const double> outputs) noexcept {
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    page_->outputs[i].store(outputs[i], std::memory_order_relaxed);
  }
  page_->in_step.store(false, std::memory_order_release);
}

std::string Guard::death() {
  int status = 0;
  if (is_reaped_ || waitpid(process_, &status, WNOHANG) != process_) {
    return {};
  }
  is_reaped_ = true;
  if (WIFEXITED(status)) {
    return WEXITSTATUS(status) == 0 ? "" : "its exit code is " + std::to_string(WEXITSTATUS(status));
  }
  return "it was ended by signal " + std::to_string(WTERMSIG(status)) + ", " + strsignal(WTERMSIG(status));
}

bool Guard::goodbye() noexcept {
  GuardWord word = page_->word.load();
  while (word != GuardWord::taken && word != GuardWord::goodbye) {
    if (page_->word.compare_exchange_weak(word, GuardWord::goodbye)) {
      return true;
    }
  }
  return word == GuardWord::goodbye;
}

}  // namespace hysteron::runtime
