#include "fleet/child.hpp"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <system_error>
#include <utility>

#include "support/failed_writes.hpp"

namespace hysteron::fleet {
namespace {

constexpr int cannot_start = 127;

/// Between fork and exec: only what may be called there.
[[noreturn]] void become(char* const* arguments, int nowhere, int output, int errors, pid_t parent, rlim_t bytes) {
  setpgid(0, 0);
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() != parent) {
    _exit(cannot_start);  // it died before it could be watched
  }
  const rlimit memory{.rlim_cur = bytes, .rlim_max = bytes};
  const rlimit no_core{.rlim_cur = 0, .rlim_max = 0};
  for (const int signal : signals_of_failed_writes) {
    ::signal(signal, SIG_DFL);
  }
  if (setrlimit(RLIMIT_AS, &memory) == 0 && setrlimit(RLIMIT_CORE, &no_core) == 0 && dup2(nowhere, STDIN_FILENO) >= 0 &&
      dup2(output, STDOUT_FILENO) >= 0 && dup2(errors, STDERR_FILENO) >= 0) {
    execv(arguments[0], arguments);
  }
  _exit(cannot_start);
}

}  // namespace

Child::Child(const std::vector<std::string>& command, const std::filesystem::path& output,
             const std::filesystem::path& errors, std::uint64_t megabytes) {
  auto words = command;
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (std::string& word : words) {
    arguments.push_back(word.data());
  }
  arguments.push_back(nullptr);
  const int nowhere = open("/dev/null", O_RDONLY | O_CLOEXEC);
  const int results = open(output.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  const int complaints = open(errors.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  const pid_t parent = getpid();
  pid_ = fork();  // NOLINT(cppcoreguidelines-prefer-member-initializer): once its files are open
  if (pid_ == 0) {
    become(arguments.data(), nowhere, results, complaints, parent, static_cast<rlim_t>(megabytes) << 20U);
  }
  const int problem = errno;
  close(nowhere);
  close(results);
  close(complaints);
  if (pid_ < 0) {
    throw std::system_error(problem, std::generic_category(), "no further process");
  }
  setpgid(pid_, pid_);
  descriptor_ = static_cast<int>(syscall(SYS_pidfd_open, pid_, 0));  // that of glibc 2.36 is declared for C alone
  if (descriptor_ < 0) {
    const int refused = errno;
    kill();
    wait();
    throw std::system_error(refused, std::generic_category(), "no descriptor of a process");
  }
}

Child::~Child() {
  if (pid_ > 0) {
    kill();
    wait();
  }
}

Child::Child(Child&& other) noexcept
    : pid_(std::exchange(other.pid_, -1)), descriptor_(std::exchange(other.descriptor_, -1)), begun_(other.begun_) {}

Child& Child::operator=(Child&& other) noexcept {
  std::swap(pid_, other.pid_);
  std::swap(descriptor_, other.descriptor_);
  std::swap(begun_, other.begun_);
  return *this;
}

double Child::seconds() const {
  return std::chrono::duration<double>(Clock::now() - begun_).count();
}

void Child::kill() const {
  if (pid_ > 0) {
    ::kill(-pid_, SIGKILL);
    ::kill(pid_, SIGKILL);
  }
}

int Child::wait() {
  int status = 0;
  while (waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
  }
  if (descriptor_ >= 0) {
    close(descriptor_);
  }
  pid_ = -1;
  descriptor_ = -1;
  return WIFEXITED(status) ? WEXITSTATUS(status) : killed + WTERMSIG(status);
}

}  // namespace hysteron::fleet
