// A running cycle allocates nothing, meets no missing page after its warm-up, and calls nothing of the system but sleep
// and clock: held by the allocator's own count, the kernel's, and a filter of system calls that kills at the first
// other.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <functional>
#include <memory>
#include <thread>

#include "runtime/host/online_change.hpp"
#include "runtime/host/running_history.hpp"
#include "runtime/mqtt/json_dialect.hpp"
#include "runtime/mqtt/mqtt.hpp"
#include "runtime/task/scheduling.hpp"
#include "runtime/task/task.hpp"
#include "tests/runtime/modbus/free_port.hpp"
#include "tests/runtime/task/accumulator.hpp"
#include "tests/runtime/task/quiet_thread.hpp"
#include "tests/support/counted_new.hpp"
#include "tests/support/exit_code.hpp"
#include "tests/support/scratch_folder.hpp"

namespace hysteron::runtime {
namespace {

constexpr std::uint64_t warm_up = 200;
constexpr std::uint64_t cycles = 1000;

thread_local bool is_cyclic_thread = false;

/// A version that tells of its steps in the cyclic thread: it is tried beside it, too.
std::unique_ptr<StepProgram> telling(const std::function<void()>& in_step) {
  auto program = std::make_unique<test::Accumulator>();
  program->during_step = [&in_step](std::span<double> /*outputs*/) {
    if (is_cyclic_thread) {
      in_step();
    }
  };
  return program;
}

/// A task with everything attached that has a thread of its own, and whose version changes now and then.
void run_task(const std::string& folder, const std::function<void(std::uint64_t)>& in_cycle, bool orders) {
  std::uint64_t cycle = 0;
  const std::function<void()> in_step = [&] { in_cycle(cycle++); };
  ChangeableProgram program(telling(in_step));
  RetainFolder files(folder);
  Retainer retainer(files, program, {});
  Trace trace({.file = folder + ".trace"}, program);
  KeptCounter published;
  Task task(program, {.loop = {.cycles = warm_up + cycles}, .inputs = {{}}, .outputs = {{}, {}}, .retain_every = 10},
            {.retainer = &retainer, .trace = &trace, .mqtt = &published, .changes = &program});
  OnlineChange change(program, task, std::vector<OutputLimit>(2, {.limit = {.most = 1e300}}));
  change.begin(&retainer, &trace);
  // A broker that is not there: rows wait, and the oldest are lost.
  SampleTap tap({0, 1, test::point(task.door(), "task.fault")}, 1, 1000, published);
  MqttSettings settings{
      .rows = {.points = {{.name = "X", .is_port = true}, {.name = "Y", .is_port = true}}, .fault_column = 2},
      .period = program.shape().period,
      .bytes = 20'000,
      .keep = 1'000'000'000};
  settings.link.broker = "127.0.0.1";
  settings.link.port = test::free_port();
  Mqtt mqtt(settings, std::make_unique<JsonDialect>("quiet", 1, settings.rows.points), tap, published,
            clocks_beside(task.door()));
  task.door().attach({&tap});
  std::atomic<bool> stop{false};
  std::atomic<bool> done{false};
  std::thread cyclic([&] {
    is_cyclic_thread = true;
    default_floating_point();
    touch_stack();
    test::bring_pages_in();
    MonotonicClock clock;
    (void)task.run(clock, stop);
    change.end();
    done.store(true);
  });
  double value = 0.0;
  int changes = 0;
  while (!done.load()) {
    if (orders) {
      value += 1.0;
      const std::array<PointWrite, 3> set{{{test::point(task.door(), "G.A"), value},
                                           {test::point(task.door(), "X"), value},
                                           {test::point(task.door(), "task.commit"), 1.0}}};
      EXPECT_EQ(task.door().write(set), "");
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(3));
    try {
      changes += change.change_to(telling(in_step), {}).is_done ? 1 : 0;
    } catch (const InputError& refused) {
      EXPECT_THAT(refused.what(),
                  testing::AnyOf(testing::StartsWith("The task "), testing::HasSubstr("is not stepped")))
          << "it ends, or has not begun a step";
    }
  }
  cyclic.join();
  mqtt.finish();
  EXPECT_GT(changes, 0);
  EXPECT_EQ(published.read().lost, warm_up + cycles) << "each cycle was a row";
}

TEST(QuietStep, AllocatesNothingAndMeetsNoMissingPage) {
  // The ring of the trace is written for the first time as the run goes on; its pages are there already.
  long missing_pages = 1;
  for (int attempt = 0; attempt < test::attempts_at_no_missing_page && missing_pages > 0; ++attempt) {
    const hysteron::test::ScratchFolder scratch;
    test::QuietMeter meter(warm_up);
    run_task(
        scratch / "kept", [&](std::uint64_t cycle) { meter.in_cycle(cycle); }, true);
    EXPECT_EQ(meter.allocated(), 0U);
    missing_pages = meter.missing_pages();
  }
  EXPECT_EQ(missing_pages, 0);
}

TEST(QuietStep, TheAllocatorIsWatched) {
  const std::uint64_t before = hysteron::test::allocations;
  delete new volatile int(3);
  EXPECT_EQ(hysteron::test::allocations, before + 1);
}

/// Runs in a process of its own; its end says whether the filter struck.
int end_of_filtered_run(const std::string& folder, bool with_a_forbidden_call) {
  const pid_t child = fork();
  if (child == 0) {
    std::atomic<bool> finished{false};
    std::thread runner([&] {
      run_task(
          folder,
          [&](std::uint64_t cycle) {
            if (cycle == warm_up && !test::allow_only_sleep_and_clock()) {
              _exit(2);
            }
            if (cycle == warm_up + 100 && with_a_forbidden_call) {
              (void)syscall(SYS_getppid);
            }
            if (cycle == warm_up + cycles - 2) {
              finished.store(true);
              while (finished.load()) {
                // Until the process ends: the end of the run needs other calls, and may come before the process is
                // asked.
              }
            }
          },
          false);
    });
    // The end of a thread needs other calls; the process ends from here.
    while (!finished.load()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    _exit(0);
  }
  int status = 0;
  (void)waitpid(child, &status, 0);
  return hysteron::test::exit_code(status);
}

TEST(QuietStep, CallsNothingOfTheSystemButSleepAndClock) {
  const hysteron::test::ScratchFolder scratch;
  EXPECT_EQ(end_of_filtered_run(scratch / "kept", false), 0);
  EXPECT_EQ(end_of_filtered_run(scratch / "kept", true), 128 + SIGSYS);  // the filter strikes
}

}  // namespace
}  // namespace hysteron::runtime
