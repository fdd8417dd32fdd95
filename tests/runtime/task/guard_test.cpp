// However a task goes wrong, its outputs become safe and stay so. The bound is wide: this may run on a busy machine.
#include <gtest/gtest.h>

#include "tests/runtime/task/dying_task.hpp"

namespace hysteron::runtime {
namespace {

class Mishaps : public testing::TestWithParam<test::Mishap> {};

TEST_P(Mishaps, EndInSafeOutputs) {
  for (int i = 0; i < 10; ++i) {
    const std::int64_t time = test::time_to_safety(GetParam());
    ASSERT_GE(time, 0) << "never safe, or not held";
    EXPECT_LT(time, 2'000'000'000);
  }
}

INSTANTIATE_TEST_SUITE_P(Guard, Mishaps,
                         testing::Values(test::Mishap::hang, test::Mishap::not_finite, test::Mishap::segmentation_fault,
                                         test::Mishap::killed, test::Mishap::stopped),
                         [](const auto& one) {
                           return std::string(test::mishap_names[static_cast<std::size_t>(one.param)]);
                         });

TEST(Guard, AHeartbeatIsJudgedByTimeAlone) {
  constexpr GuardSettings settings{.watchdog = {.time = 100, .sensitivity = 3}, .silence = 10'000};
  EXPECT_EQ(heartbeat_fault(settings, 1000, true, 1300), Fault::none);
  EXPECT_EQ(heartbeat_fault(settings, 1000, true, 1301), Fault::hang);
  EXPECT_EQ(heartbeat_fault(settings, 1000, false, 1301), Fault::none);  // it sleeps between two cycles
  EXPECT_EQ(heartbeat_fault(settings, 1000, false, 11'000), Fault::none);
  EXPECT_EQ(heartbeat_fault(settings, 1000, false, 11'001), Fault::hang);
  constexpr GuardSettings without{.watchdog = {}, .silence = 10'000};
  EXPECT_EQ(heartbeat_fault(without, 1000, true, 10'999), Fault::none);
}

TEST(Guard, EndsWithTheTaskThatSaysGoodbyeAndWritesNothing) {
  void* const memory =
      mmap(nullptr, sizeof(test::SharedDevice), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  auto& device = *new (memory) test::SharedDevice;
  test::SharedDeviceWriter writer(device);
  const SafeOutputs outputs({{}}, 0.001);
  pid_t process = 0;
  {
    Guard guard({}, outputs, writer);
    process = guard.process();
    EXPECT_EQ(kill(process, 0), 0);
    guard.cycle_begins(monotonic_now());
    guard.cycle_ends(outputs.values());
    EXPECT_TRUE(guard.goodbye());
    EXPECT_TRUE(guard.goodbye());
  }
  EXPECT_EQ(kill(process, 0), -1);  // waited for, and gone
  EXPECT_EQ(device.written.load(), 0);
}

}  // namespace
}  // namespace hysteron::runtime
