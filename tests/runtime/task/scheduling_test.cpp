// What is reported is what the system says, asked a second time here; without rights a task still runs.
#include "runtime/task/scheduling.hpp"

#include <gtest/gtest.h>
#include <sched.h>
#include <xmmintrin.h>

#include <limits>
#include <thread>

namespace hysteron::runtime {
namespace {

TEST(Scheduling, WhatIsReportedIsWhatTheThreadHas) {
  for (const Scheduling wanted : {Scheduling::other, Scheduling::fifo, Scheduling::deadline}) {
    std::thread([&] {
      const auto obtained = obtain_scheduling(
          {.scheduling = wanted, .priority = 10, .period = 1'000'000, .runtime = 100'000, .lock_memory = false});
      const int policy = sched_getscheduler(0);
      EXPECT_EQ(obtained.scheduling == Scheduling::fifo, policy == SCHED_FIFO);
      EXPECT_EQ(obtained.scheduling == Scheduling::other, policy == SCHED_OTHER);
      EXPECT_EQ(obtained.scheduling == wanted, obtained.refused.empty()) << obtained.refused;
      if (obtained.scheduling == Scheduling::other) {
        EXPECT_EQ(obtained.timer_slack, 1);
      }
    }).join();
  }
}

TEST(Scheduling, AProcessorThatIsNotThereIsRefusedWithAReason) {
  std::thread([] {
    const auto obtained = obtain_scheduling({.scheduling = Scheduling::other, .processor = 1000, .lock_memory = false});
    EXPECT_EQ(obtained.processor, -1);
    EXPECT_EQ(obtained.refused, "processor 1000: Invalid argument");
    EXPECT_EQ(description_of(obtained), "OTHER, timer slack 1 ns, memory not locked");
  }).join();
}

TEST(Scheduling, DescribesWhatWasObtained) {
  EXPECT_EQ(description_of({.scheduling = Scheduling::fifo, .priority = 80, .processor = 1, .memory_locked = true}),
            "FIFO 80, processor 1, memory locked");
  EXPECT_EQ(description_of({.scheduling = Scheduling::deadline}), "DEADLINE, memory not locked");
}

TEST(Scheduling, SmallNumbersAreNotFlushedToZero) {
  std::thread([] {
    _mm_setcsr(_mm_getcsr() | 0x8040);  // flush to zero, denormals are zero
    volatile double smallest = std::numeric_limits<double>::min();
    volatile double half = smallest * 0.5;
    EXPECT_EQ(half, 0.0);
    default_floating_point();
    half = smallest * 0.5;
    EXPECT_GT(half, 0.0);
    EXPECT_EQ(half * 2.0, std::numeric_limits<double>::min());
  }).join();
}

}  // namespace
}  // namespace hysteron::runtime
