// A start that is refused leaves devices and files as they are, and one that is not waits for the guard before it.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <csignal>
#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "runtime/host/output_turn.hpp"
#include "runtime/modbus/listen.hpp"
#include "support/text_file.hpp"
#include "tests/runtime/host/dead_guard.hpp"
#include "tests/runtime/host/host_process.hpp"
#include "tests/runtime/host/setpoint_kills.hpp"
#include "tests/support/error_page.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/support/soon.hpp"

namespace hysteron::runtime {
namespace {

using test::HostProcess;
using test::run_file;
using test::Stage;
using test::x_on_stage;

/// With its port taken, and whatever else it names free.
TEST(RefusedStart, TouchesNoDeviceAndNoFile) {
  Stage stage;
  stage.start();
  const hysteron::test::ScratchFolder folder;
  const std::string trace = folder.write("run.trace", "hysteron trace 1 of before");
  const std::string kept = folder.write("retain_a", "of another diagram");
  const auto taken = modbus::listen_on("127.0.0.1", 0, {});
  const std::string files =
      fmt::format("lock_file = \"{}\"\n[trace]\nfile = \"{}\"\n[retain]\nfolder = \"{}\"\nmismatch = \"cold\"\n",
                  folder / "a.lock", trace, folder.path().string());
  const auto names = folder.names();
  auto text = run_file(stage.port, files);
  text.replace(text.find("port = 0"), 8, fmt::format("port = {}", modbus::port_of(taken)));
  HostProcess host(text);
  EXPECT_TRUE(host.said_before().starts_with("HY827 RUN.toml:14: ")) << host.said_before();
  EXPECT_EQ(host.ended().first, 2);
  // Whoever would still write holds the claims of the outputs.
  const test::Twice program;
  OutputClaims claims(parse_run_config("RUN.toml", text, program.shape()));
  EXPECT_TRUE(test::soon([&] { return !claims.claim(); }));
  EXPECT_EQ(stage.door.writes(), 0U);
  EXPECT_EQ(read_text_file(trace), "hysteron trace 1 of before");
  EXPECT_EQ(read_text_file(kept), "of another diagram");
  EXPECT_EQ(folder.names(), names);
}

TEST(RefusedStart, OfATaskThatRunsAlready) {
  Stage stage;
  stage.give(0.25);
  stage.start();
  HostProcess first(run_file(stage.port, x_on_stage));
  EXPECT_TRUE(test::soon([&] { return stage.taken() == 0.5; }));
  const auto before = stage.door.history(1).size();
  HostProcess second(run_file(stage.port, x_on_stage));
  EXPECT_TRUE(second.said_before().starts_with(
      "HY814 RUN.toml:12: Another task that runs on this machine writes holding register 0 of stage."))
      << second.said_before();
  EXPECT_EQ(second.ended().first, 2);
  EXPECT_TRUE(test::soon([&] { return stage.door.history(1).size() > before + 20; }));
  const auto taken = stage.door.history(1);
  EXPECT_TRUE(std::all_of(taken.begin() + static_cast<std::ptrdiff_t>(before), taken.end(),
                          [](double value) { return value == 0.5; }));
  EXPECT_EQ(first.end().first, 0);
}

TEST(RefusedStart, ItsPageKeepsItsWord) {
  const auto page = hysteron::test::read_error_page("HY814");
  const test::Twice program;
  const auto config_of = [&](const std::string& text) { return parse_run_config("RUN.toml", text, program.shape()); };
  OutputClaims runs(config_of(page.fails.text));
  ASSERT_FALSE(runs.claim());
  HostProcess host(page.fails.text);
  EXPECT_TRUE(host.said_before().starts_with("HY814 ")) << host.said_before();
  EXPECT_FALSE(OutputClaims(config_of(page.mended.text)).claim());
}

TEST(RefusedStart, OnceTheTaskIsGoneTheNextOneWaitsForItsGuard) {
  Stage stage;
  stage.give(0.25);
  stage.start();
  auto text = run_file(stage.port, x_on_stage);
  text.replace(text.find("safe = -1.0"), 11, "safe = -1.0\non_fault = \"ramp\"\nramp = 3.0");
  HostProcess first(text);
  EXPECT_TRUE(test::soon([&] { return stage.taken() == 0.5; }));
  first.kill();
  const auto before = stage.door.history(1).size();
  HostProcess second(text);
  EXPECT_TRUE(second.said_before().starts_with("TWICE: waits for the guard of an earlier run, process "))
      << second.said_before();
  EXPECT_TRUE(test::soon([&] { return stage.taken() == 0.5; }));
  // Down to the safe value without a step up, and only then up again.
  const auto all = stage.door.history(1);
  const std::vector<double> taken(all.begin() + static_cast<std::ptrdiff_t>(before), all.end());
  const auto safe = std::find(taken.begin(), taken.end(), -1.0);
  ASSERT_NE(safe, taken.end());
  EXPECT_TRUE(std::is_sorted(taken.begin(), safe, std::greater<>()));
  EXPECT_TRUE(std::is_sorted(safe, taken.end()));
  EXPECT_EQ(second.end().first, 0);
}

/// The device is gone for good, and its guard with it: the task starts after its wait, and says so.
TEST(RefusedStart, AGuardThatReachesItsDeviceNoMoreKeepsNoTaskDown) {
  const auto port = hysteron::test::free_port();
  auto text = run_file(port, "");
  text.replace(text.find("silence = \"5s\""), 14, "silence = \"5s\"\nguard_wait = \"200ms\"");
  const test::Twice program;
  const pid_t guard = test::guard_for_ever(parse_run_config("RUN.toml", text, program.shape()));
  HostProcess host(text);
  int status = 0;
  EXPECT_EQ(::waitpid(guard, &status, 0), guard);
  EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL);
  EXPECT_NE(
      host.said_before().find(fmt::format("process {}, which brings outputs on stage to their safe values, 200ms at "
                                          "the most\nTWICE: that guard has not reached stage and is ended; the "
                                          "task starts, and goes on trying\n",
                                          guard)),
      std::string::npos)
      << host.said_before();
  // It is the task that brings the outputs to where they belong, as soon as the device is there.
  Stage stage;
  stage.port = port;
  stage.start();
  EXPECT_TRUE(test::soon([&] { return stage.door.writes() > 50; }));
  EXPECT_EQ(host.end().first, 0);
}

/// What a client wrote is what the next start begins with, whenever the task is killed.
TEST(RetainedSetpoint, IsNeverOlderThanWhatWasOnTheDisk) {
  const hysteron::test::ScratchFolder folder;
  double before = 0.0;
  for (int kills = 0; kills < 10; ++kills) {
    const auto result = test::kill_while_setpoints_come(folder.path() / "kept", 2'000'000 + kills * 7'000'000);
    EXPECT_TRUE(result.holds()) << result.confirmed << " to " << result.written << ", and " << result.begun_with;
    EXPECT_GE(result.begun_with, before) << "each run goes on from the one before";
    before = result.begun_with;
  }
  EXPECT_GT(before, 0.0);
}

/// Whoever takes the name by which an output is claimed, and may not be trusted, keeps nobody from starting.
TEST(RefusedStart, AnotherUserKeepsNoTaskDown) {
  Stage stage;
  const auto text = run_file(stage.port, "");
  // Another user cannot be played by who is none but himself; one who does not say whose he is, by anybody.
  const std::vector<bool> ways = ::geteuid() == 0 ? std::vector{true, false} : std::vector{false};
  for (const bool listens : ways) {
    stage.server.reset();  // before a fork there are no threads
    std::array<int, 2> ready{};
    ASSERT_EQ(::pipe(ready.data()), 0);
    const pid_t other = ::fork();
    if (other == 0) {
      const test::Twice program;
      OutputClaims claims(parse_run_config("RUN.toml", text, program.shape()));
      const bool held = (::geteuid() != 0 || ::setuid(65534) == 0) && !claims.claim();
      if (!listens) {
        for (int number = 3; number < 4096; ++number) {  // its claims: who connects is refused from now on
          (void)::shutdown(number, SHUT_RDWR);
        }
      }
      [[maybe_unused]] const ssize_t written = ::write(ready[1], held ? "r" : "x", 1);
      ::pause();
      ::_exit(0);
    }
    char byte = 0;
    ASSERT_EQ(::read(ready[0], &byte, 1), 1);
    EXPECT_EQ(byte, 'r');
    HostProcess host(text);
    stage.start();
    const auto before = stage.door.writes();
    EXPECT_TRUE(test::soon([&] { return stage.door.writes() > before + 50; }));
    EXPECT_NE(
        host.said_before().find("the name by which holding register 0 of stage is claimed is held by another user"),
        std::string::npos)
        << host.said_before();
    EXPECT_EQ(host.end().first, 0);
    ::kill(other, SIGKILL);
    ::waitpid(other, nullptr, 0);
  }
}

TEST(RefusedStart, AWaitForAGuardEndsWhenAsked) {
  Stage stage;
  stage.give(0.25);
  stage.start();
  auto text = run_file(stage.port, x_on_stage);
  text.replace(text.find("safe = -1.0"), 11, "safe = -1.0\non_fault = \"ramp\"\nramp = 0.01");
  HostProcess first(text);
  EXPECT_TRUE(test::soon([&] { return stage.taken() == 0.5; }));
  first.kill();
  const test::Twice program;
  OutputClaims claims(parse_run_config("RUN.toml", text, program.shape()));
  ASSERT_TRUE(test::soon([&] { return claims.claim().value_or(OutputClaims::Holder{}).guard.has_value(); }));
  const auto guard = claims.claim()->guard;
  std::string said;
  std::atomic<bool> stop{false};
  EXPECT_FALSE(claim_outputs(claims, parse_run_config("RUN.toml", text, program.shape()), "TWICE", stop,
                             [&](std::string_view line) {
                               said += line;
                               stop = true;
                             }));
  EXPECT_NE(said.find(fmt::format("process {}, which brings outputs on stage to their safe values, 60s at the most\n",
                                  *guard)),
            std::string::npos)
      << said;
  ::kill(*guard, SIGKILL);
  EXPECT_TRUE(test::soon([&] { return !claims.claim(); }));
}

}  // namespace
}  // namespace hysteron::runtime
