// A guard that reaches its device no more, and a start that comes after it.
#pragma once

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <csignal>
#include <string>
#include <string_view>

#include "runtime/config/output_claims.hpp"
#include "runtime/config/run_config.hpp"
#include "runtime/host/output_turn.hpp"
#include "tests/runtime/modbus/free_port.hpp"
#include "tests/runtime/namespaces.hpp"

namespace hysteron::runtime::test {

/// A process that is to its outputs what a guard is that reaches no device; it ends by a signal alone.
inline pid_t guard_for_ever(const RunConfig& config) {
  std::array<int, 2> ready{};
  (void)::pipe(ready.data());
  const pid_t guard = ::fork();
  if (guard == 0) {
    OutputClaims claims(config);
    (void)claims.claim();
    claims.guard_listens();
    [[maybe_unused]] const ssize_t written = ::write(ready[1], "r", 1);
    for (;;) {
      ::pause();
    }
  }
  char byte = 0;
  [[maybe_unused]] const ssize_t got = ::read(ready[0], &byte, 1);
  ::close(ready[0]);
  ::close(ready[1]);
  return guard;
}

/// Whether a start has its outputs after its wait, and the guard is gone.
inline bool starts_after_a_dead_guard() {
  const ProgramShape shape{.name = "PLANT", .period = 1'000'000, .outputs = {{.name = "Y"}}};
  const RunConfig config =
      parse_run_config("RUN.toml",
                       fmt::format("[watchdog]\nguard_wait = \"20ms\"\n[devices.stage]\nport = {}\n"
                                   "[outputs.Y]\nsafe = 0.0\ndevice = \"stage\"\n",
                                   free_port()),
                       shape);
  const pid_t guard = guard_for_ever(config);
  OutputClaims claims(config);
  const std::atomic<bool> stop{false};
  const bool has_them = claim_outputs(claims, config, "PLANT", stop, [](std::string_view) {});
  (void)::kill(guard, has_them ? 0 : SIGKILL);
  int status = 0;
  const bool is_gone = ::waitpid(guard, &status, 0) == guard && WIFSIGNALED(status);
  return has_them && is_gone;
}

}  // namespace hysteron::runtime::test
