// With ten pages open, and clients that ask, stage and commit, a cycle allocates nothing, meets no missing page and
// calls nothing of the system but sleep and clock: so there is nothing by which a client could hold it up.
#include <gtest/gtest.h>
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
#include "tests/support/exit_code.hpp"
#include "tests/web/web_client.hpp"

namespace hysteron::runtime::web {
namespace {

constexpr std::uint64_t warm_up = 500;
constexpr std::uint64_t cycles = 2000;
constexpr std::uint64_t longest = 60'000;  // cycles, on a machine that has no time for the clients
constexpr int pages = 10;

struct Traffic {
  std::atomic<std::uint64_t> frames{0};
  std::atomic<std::uint64_t> commits{0};

  /// There were pages, and somebody at the parameters.
  [[nodiscard]] bool enough() const { return frames > 10U * pages && commits > 10U; }
};

/// A task of 1 ms with its page, beside ten streams, and a client that stages and commits without a pause. Ends where
/// \p in_step says so.
LoopStatistics run_task(Traffic& traffic, const std::function<bool(std::uint64_t)>& in_step) {
  test::Accumulator program;
  program.mutable_shape().inner = {{.name = "SUM.XOUT"}};
  Task task(program, {.inputs = {{}}, .outputs = {{}, {}}}, {});
  std::uint64_t cycle = 0;
  std::atomic<bool> stop{false};
  program.during_step = [&](std::span<double> /*outputs*/) {
    if (!in_step(cycle++)) {
      stop.store(true);
    }
  };
  const Server server(task.door(), {.name = "ACCUMULATOR", .period = 1'000'000},
                      {.endpoint = parse_endpoint("127.0.0.1:0"),
                       .access = {.token = hysteron::test::token},
                       .limits = {.interval = milliseconds(1)}});
  std::atomic<bool> done{false};
  std::vector<std::thread> clients;
  for (int i = 0; i < pages; ++i) {
    clients.emplace_back([&] {
      const hysteron::test::WebClient page(server.port());
      EXPECT_EQ(page.open_stream(), 101);
      while (!done.load() && page.frame()) {
        ++traffic.frames;
      }
    });
  }
  clients.emplace_back([&] {
    const hysteron::test::WebClient hand(server.port());
    for (int value = 1; !done.load(); ++value) {
      const std::string set = "{\"G.A\": " + std::to_string(value) + ", \"G.B\": " + std::to_string(-value) + "}";
      if (hand.ask("POST", "/api/stage", test::authorized, set).status == 200 &&
          hand.ask("POST", "/api/commit", test::authorized).status == 200 &&
          hand.ask("GET", "/metrics").status == 200) {
        ++traffic.commits;
      }
    }
  });
  std::thread cyclic([&] {
    default_floating_point();
    touch_stack();
    test::bring_pages_in();
    MonotonicClock clock;
    (void)task.run(clock, stop);
    done.store(true);
  });
  cyclic.join();
  for (std::thread& client : clients) {
    client.join();
  }
  return task.statistics();
}

TEST(WebQuietStep, TenPagesLeaveNoTraceInACycle) {
  long missing_pages = 1;
  for (int attempt = 0; attempt < test::attempts_at_no_missing_page && missing_pages > 0; ++attempt) {
    test::QuietMeter meter(warm_up);
    Traffic traffic;
    const LoopStatistics statistics = run_task(traffic, [&](std::uint64_t cycle) {
      meter.in_cycle(cycle);
      return cycle < warm_up + cycles || (!traffic.enough() && cycle < longest);
    });
    EXPECT_EQ(meter.allocated(), 0U);
    EXPECT_EQ(statistics.run + statistics.skipped, statistics.elapsed);
    EXPECT_TRUE(traffic.enough()) << traffic.frames << " frames, " << traffic.commits << " commits";
    missing_pages = meter.missing_pages();
  }
  EXPECT_EQ(missing_pages, 0);
}

/// Runs in a process of its own; its end says whether the filter struck.
int end_of_filtered_run(bool with_a_forbidden_call) {
  const pid_t child = fork();
  if (child == 0) {
    std::atomic<bool> finished{false};
    std::thread runner([&] {
      Traffic traffic;
      (void)run_task(traffic, [&](std::uint64_t cycle) {
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
        return true;
      });
    });
    while (!finished.load()) {
      std::this_thread::sleep_for(milliseconds(1));
    }
    _exit(0);
  }
  int status = 0;
  (void)waitpid(child, &status, 0);
  return hysteron::test::exit_code(status);
}

TEST(WebQuietStep, TenPagesMakeACycleCallNothingOfTheSystem) {
  EXPECT_EQ(end_of_filtered_run(false), 0);
  EXPECT_EQ(end_of_filtered_run(true), 128 + SIGSYS);  // the filter strikes
}

}  // namespace
}  // namespace hysteron::runtime::web
