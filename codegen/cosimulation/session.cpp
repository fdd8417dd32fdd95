#include "codegen/cosimulation/session.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sched.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstring>
#include <new>
#include <string_view>
#include <system_error>
#include <utility>

#include "support/errors.hpp"
#include "support/failed_writes.hpp"
#include "support/numbers.hpp"

namespace hysteron::cosimulation {
namespace {

/// How long the end of a worker may go unnoticed.
constexpr std::chrono::milliseconds watch_period{20};

void copy_text(char (&target)[longest_path], const std::string& text) {
  std::strncpy(target, text.c_str(), longest_path - 1);
}

bool several_processors() {
  cpu_set_t set;
  CPU_ZERO(&set);
  return sched_getaffinity(0, sizeof(set), &set) != 0 || CPU_COUNT(&set) > 1;
}

[[noreturn]] void refuse_system(const std::string& path, std::string_view what) {
  throw InputError(error::fmu_does_not_start, {.file = path},
                   fmt::format("The process of {} cannot be started: {}: {}.", path, what, std::strerror(errno)),
                   "end other programs, or raise the limits that `ulimit -a` shows.");
}

}  // namespace

Session::Session(const Fmu& fmu, std::string instance, std::size_t most_lanes, double step)
    : fmu_(fmu), instance_(std::move(instance)), patience_(several_processors()) {
  const Description& about = fmu.description();
  if (const double ratio = step / about.internal_step;
      about.internal_step > 0.0 && (ratio < 0.5 || std::abs(ratio - std::round(ratio)) > 1e-9 * ratio)) {
    throw InputError(error::fmu_does_not_start, {.file = fmu.path()},
                     fmt::format("{} steps every {} s, which is no multiple of the {} s with which {} computes "
                                 "(fixedInternalStepSize).",
                                 instance_, number_text(step), number_text(about.internal_step), fmu.path()),
                     fmt::format("state @ts {} s or a multiple of it, or export the model with another step.",
                                 number_text(about.internal_step)));
  }
  const Fmu::Files& files = fmu.files();
  const auto variables = about.inputs.size() + about.parameters.size() + about.outputs.size();
  size_ = ChannelView::size(variables, most_lanes);
  memory_file_ = memfd_create("hysteron-fmu", MFD_CLOEXEC);
  if (memory_file_ < 0 || ftruncate(memory_file_, static_cast<off_t>(size_)) != 0) {
    refuse_system(fmu.path(), "shared memory");
  }
  memory_ = mmap(nullptr, size_, PROT_READ | PROT_WRITE, MAP_SHARED, memory_file_, 0);
  if (memory_ == MAP_FAILED) {  // NOLINT(performance-no-int-to-ptr): the system's own
    memory_ = nullptr;
    refuse_system(fmu.path(), "shared memory");
  }
  new (memory_) ChannelHead{};
  view_ = ChannelView(memory_);
  ChannelHead& head = view_.head();
  head.version = about.version;
  head.most_lanes = static_cast<std::uint32_t>(most_lanes);
  head.inputs = static_cast<std::uint32_t>(about.inputs.size());
  head.parameters = static_cast<std::uint32_t>(about.parameters.size());
  head.outputs = static_cast<std::uint32_t>(about.outputs.size());
  head.step = step;
  copy_text(head.library, files.library);
  copy_text(head.resources, files.resources);
  copy_text(head.token, about.token);
  ChannelVariable* variable = view_.variables();
  for (const auto* const list : {&about.inputs, &about.parameters, &about.outputs}) {
    for (const ModelVariable& one : *list) {
      *variable++ = {.reference = one.reference, .access = one.access, .goes_on = one.goes_on};
    }
  }
  spawn();
}

Session::~Session() {
  end_worker();
  if (memory_ != nullptr) {
    munmap(memory_, size_);
  }
  if (memory_file_ >= 0) {
    close(memory_file_);
  }
}

void Session::spawn() {
  std::array<int, 2> pipe{};
  if (pipe2(pipe.data(), O_CLOEXEC) != 0) {
    refuse_system(fmu_.path(), "pipe");
  }
  lifeline_ = pipe[1];
  // What an FMU prints must not get among our own output.
  posix_spawn_file_actions_t actions;
  posix_spawnattr_t attributes;
  posix_spawn_file_actions_init(&actions);
  posix_spawnattr_init(&attributes);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, STDERR_FILENO, STDOUT_FILENO);
  // Through numbers above both, so that neither is overwritten before it is copied.
  const int memory = fcntl(memory_file_, F_DUPFD_CLOEXEC, 16);
  const int lifeline = fcntl(pipe[0], F_DUPFD_CLOEXEC, 16);
  close(pipe[0]);
  posix_spawn_file_actions_adddup2(&actions, memory, memory_descriptor);
  posix_spawn_file_actions_adddup2(&actions, lifeline, lifeline_descriptor);
  sigset_t defaults;
  sigemptyset(&defaults);
  for (const int signal : signals_of_failed_writes) {
    sigaddset(&defaults, signal);
  }
  posix_spawnattr_setsigdefault(&attributes, &defaults);
  // A group of its own: an interrupt of the keyboard is the tool's to answer.
  posix_spawnattr_setpgroup(&attributes, 0);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETPGROUP);
  std::string program = worker_program().string();
  std::array<char*, 2> arguments{program.data(), nullptr};
  const int problem = posix_spawn(&worker_, program.c_str(), &actions, &attributes, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  posix_spawnattr_destroy(&attributes);
  close(memory);
  close(lifeline);
  if (problem != 0) {
    worker_ = -1;
    throw InputError(error::fmu_does_not_start, {.file = fmu_.path()},
                     fmt::format("The program {} that opens FMUs cannot be started: {}.", program,
                                 std::generic_category().message(problem)),
                     "install Hysteron anew; the program belongs to it.");
  }
}

void Session::end_worker() noexcept {
  if (worker_ > 0) {
    kill(worker_, SIGKILL);
    while (waitpid(worker_, nullptr, 0) < 0 && errno == EINTR) {
    }
    worker_ = -1;
  }
  if (lifeline_ >= 0) {
    close(lifeline_);
    lifeline_ = -1;
  }
  posted_ = false;
}

void Session::settle() {
  try {
    wait();
  } catch (const InputError&) {  // of a run that nobody asks about any more
  }
}

void Session::begin(std::size_t lanes) {
  if (worker_ < 0) {
    view_.head().turn = static_cast<std::uint32_t>(Turn::Caller);
    spawn();
  }
  view_.head().lanes = static_cast<std::uint32_t>(lanes);
  steps_ = 0;
  fmu_.counts().instances += lanes;
  post(Command::Begin);
}

void Session::step() {
  fmu_.counts().steps += view_.head().lanes;
  post(Command::Step);
  ++steps_;
}

void Session::post(Command command) {
  ChannelHead& head = view_.head();
  head.command = command;
  head.refused = 0;
  head.message[0] = '\0';
  head.log[0] = '\0';
  posted_ = true;
  posted_at_ = std::chrono::steady_clock::now();
  give_turn(head.turn, Turn::Worker);
}

void Session::wait() {
  if (!posted_) {
    return;
  }
  const ChannelHead& head = view_.head();
  while (!wait_for_turn(head.turn, Turn::Worker, watch_period, patience_)) {
    int status = 0;
    if (waitpid(worker_, &status, WNOHANG) == worker_) {
      worker_ = -1;
      report_end(status);
    }
    const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - posted_at_;
    if (taken.count() > time_limit() * head.lanes) {
      report_time();
    }
  }
  posted_ = false;
  if (head.refused != 0) {
    report_refusal();
  }
}

std::string Session::doing() const {
  return view_.head().command == Command::Begin
             ? std::string("while it began")
             : fmt::format("in the step from t = {} s",
                           number_text(static_cast<double>(steps_ - 1) * view_.head().step));
}

std::string Session::with_log(const std::string& cause) const {
  const std::string log(view_.head().log, strnlen(view_.head().log, longest_path));
  return log.empty() ? cause : cause + " The FMU says: " + log;
}

void Session::report_end(int status) {
  end_worker();
  const std::string how = WIFSIGNALED(status) ? fmt::format("crashed ({})", strsignal(WTERMSIG(status)))
                                              : fmt::format("ended its process (exit code {})", WEXITSTATUS(status));
  throw InputError(error::fmu_crashed, {.file = fmu_.path()},
                   with_log(fmt::format("The FMU of {} {} {}.", instance_, how, doing())),
                   "run the FMU in the tool that made it with the same inputs and parameters, and export it anew.");
}

void Session::report_time() {
  end_worker();
  throw InputError(error::fmu_took_too_long, {.file = fmu_.path()},
                   with_log(fmt::format("The FMU of {} took longer than {} s {}, and was ended.", instance_,
                                        number_text(time_limit()), doing())),
                   "give it more time, in seconds, with --fmu-time-limit, or a step that its solver can do.");
}

void Session::report_refusal() const {
  const ChannelHead& head = view_.head();
  const bool beginning = head.command == Command::Begin;
  const std::string message(head.message, strnlen(head.message, longest_path));
  throw FmuRefusal(beginning ? error::fmu_does_not_start : error::fmu_refuses_step, {.file = fmu_.path()},
                   with_log(fmt::format("The FMU of {} refuses {}: {}.", instance_, doing(), message)),
                   beginning ? "give parameters and inputs with which the model can begin."
                             : "give inputs and parameters with which the model can go on, or a shorter step.");
}

}  // namespace hysteron::cosimulation
