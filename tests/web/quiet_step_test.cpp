// With ten pages open, and clients that ask, stage and commit, a cycle allocates nothing, meets no missing page and
// calls nothing of the system but sleep and clock: so there is nothing by which a client could hold it up.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <functional>
#include <memory>
#include <thread>

#include "runtime/task/scheduling.hpp"
#include "runtime/task/task.hpp"
#include "runtime/web/server.hpp"
#include "tests/runtime/task/accumulator.hpp"
#include "tests/runtime/task/quiet_thread.hpp"
#include "tests/support/counted_new.hpp"
#include "tests/web/web_client.hpp"

namespace hysteron::runtime::web {
namespace {

constexpr std::uint64_t warm_up = 500;
constexpr std::uint64_t cycles = 2000;
constexpr int pages = 10;
const std::string authorized = "Authorization: Bearer 0123456789abcdef\r\n";

struct Traffic {
  std::uint64_t frames = 0;
  std::uint64_t commits = 0;
  LoopStatistics statistics{};
};

/// A task of 1 ms with its page, beside ten streams, and a client that stages and commits without a pause.
Traffic run_task(const std::function<void(std::uint64_t)>& in_step) {
  test::Accumulator program;
  program.mutable_shape().inner = {{.name = "SUM.XOUT"}};
  Task task(program, {.loop = {.cycles = warm_up + cycles}, .inputs = {{}}, .outputs = {{}, {}}}, {});
  std::uint64_t cycle = 0;
  program.during_step = [&](std::span<double> /*outputs*/) { in_step(cycle++); };
  const Server server(task.door(), {.name = "ACCUMULATOR", .period = 1'000'000},
                      {.endpoint = parse_endpoint("127.0.0.1:0"),
                       .access = {.token = "0123456789abcdef"},
                       .limits = {.interval = milliseconds(1)}});
  std::atomic<bool> done{false};
  std::atomic<std::uint64_t> frames{0};
  std::vector<std::thread> clients;
  for (int i = 0; i < pages; ++i) {
    clients.emplace_back([&] {
      const hysteron::test::WebClient page(server.port());
      EXPECT_EQ(page.open_stream(), 101);
      while (!done.load() && page.frame()) {
        ++frames;
      }
    });
  }
  Traffic traffic;
  clients.emplace_back([&] {
    const hysteron::test::WebClient hand(server.port());
    for (int value = 1; !done.load(); ++value) {
      const std::string set = "{\"G.A\": " + std::to_string(value) + ", \"G.B\": " + std::to_string(-value) + "}";
      if (hand.ask("POST", "/api/stage", authorized, set).status == 200 &&
          hand.ask("POST", "/api/commit", authorized).status == 200) {
        ++traffic.commits;
      }
    }
  });
  const std::atomic<bool> stop{false};
  std::thread cyclic([&] {
    default_floating_point();
    touch_stack();
    MonotonicClock clock;
    (void)task.run(clock, stop);
    done.store(true);
  });
  cyclic.join();
  for (std::thread& client : clients) {
    client.join();
  }
  traffic.frames = frames;
  traffic.statistics = task.statistics();
  return traffic;
}

TEST(WebQuietStep, TenPagesLeaveNoTraceInACycle) {
  std::uint64_t allocated = 0;
  rusage before{};
  rusage after{};
  const Traffic traffic = run_task([&](std::uint64_t cycle) {
    if (cycle == warm_up) {
      (void)getrusage(RUSAGE_THREAD, &before);
      allocated = hysteron::test::allocations;
    } else if (cycle == warm_up + cycles - 1) {
      (void)getrusage(RUSAGE_THREAD, &after);
      allocated = hysteron::test::allocations - allocated;
    }
  });
  EXPECT_EQ(allocated, 0U);
  EXPECT_EQ(after.ru_majflt, before.ru_majflt);
  EXPECT_EQ(after.ru_minflt, before.ru_minflt);
  EXPECT_EQ(traffic.statistics.run + traffic.statistics.skipped, traffic.statistics.elapsed);
  EXPECT_GT(traffic.frames, 10U * pages) << "there were pages";
  EXPECT_GT(traffic.commits, 10U) << "there was somebody at the parameters";
}

/// Runs in a process of its own; its end says whether the filter struck.
int end_of_filtered_run(bool with_a_forbidden_call) {
  const pid_t child = fork();
  if (child == 0) {
    std::atomic<bool> finished{false};
    std::thread runner([&] {
      (void)run_task([&](std::uint64_t cycle) {
        if (cycle == warm_up && !test::allow_only_sleep_and_clock()) {
          _exit(2);
        }
        if (cycle == warm_up + 100 && with_a_forbidden_call) {
          (void)syscall(SYS_getppid);
        }
        if (cycle == warm_up + cycles - 2) {
          // The end of a thread needs other calls: the process ends from the thread beside, which this one signs off
          // to.
          finished.store(true);
          while (finished.load()) {
          }
        }
      });
    });
    while (!finished.load()) {
      std::this_thread::sleep_for(milliseconds(1));
    }
    _exit(0);
  }
  int status = 0;
  (void)waitpid(child, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

TEST(WebQuietStep, TenPagesMakeACycleCallNothingOfTheSystem) {
  EXPECT_EQ(end_of_filtered_run(false), 0);
  EXPECT_EQ(end_of_filtered_run(true), 128 + SIGSYS);  // the filter strikes
}

}  // namespace
}  // namespace hysteron::runtime::web
