// Faults are said once each, with what they are of, and no faster than a reader can follow.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>

#include "runtime/host/notices.hpp"

namespace hysteron::runtime {
namespace {

using std::chrono::milliseconds;

class FaultLines : public testing::Test {
 protected:
  std::string line(const FaultReport& report, int at) {
    return notices.line(report, FaultNotices::Clock::time_point(milliseconds(10'000 + at)));
  }

  const ProgramShape shape{.name = "AXIS",
                           .period = 1'000'000,
                           .inputs = {{.name = "X"}, {.name = "X_AGE"}},
                           .outputs = {{.name = "Y"}, {.name = "Z"}}};
  const RunConfig config = parse_run_config("RUN.toml",
                                            "[outputs.Y]\nsafe = 0.0\ndevice = \"bus\"\n[outputs.Z]\nsafe = 0.0\n"
                                            "[devices.bus]\nserial = \"/dev/ttyS0\"\n[devices.stage]\nport = 1503\n"
                                            "[inputs.X]\ndevice = \"stage\"\n[inputs.X_AGE]\nage_of = \"X\"\n",
                                            shape);
  FaultNotices notices{config, shape};
};

TEST_F(FaultLines, NameTheDeviceItsAddressAndTheCause) {
  const auto of = [&](Fault fault, std::size_t port) {
    return notices.last_of({.fault = fault, .last = fault, .port = port, .count = 1});
  };
  EXPECT_EQ(of(Fault::lost_link, 0), "lost link, X on stage (127.0.0.1:1503)");
  EXPECT_EQ(of(Fault::stale_input, 1), "stale input, X_AGE");
  EXPECT_EQ(of(Fault::lost_link, 2), "lost link, Y on bus (/dev/ttyS0)");
  EXPECT_EQ(of(Fault::not_finite, 3), "not finite, Z");
  EXPECT_EQ(of(Fault::hang, no_port), "hang");
  for (const Fault fault : {Fault::hang, Fault::not_finite, Fault::stale_input, Fault::lost_link, Fault::missed_cycle,
                            Fault::lost_client, Fault::not_safe}) {
    FaultNotices fresh{config, shape};
    const auto said = fresh.line({.fault = fault, .last = fault, .count = 1}, FaultNotices::Clock::now());
    EXPECT_TRUE(said.starts_with(std::string(name_of(fault)) + ": ")) << said;
    EXPECT_TRUE(said.ends_with("; 1 since the start.")) << said;
  }
}

TEST_F(FaultLines, ComeOnceForEachChangeAndOnceASecondAtTheMost) {
  EXPECT_EQ(line({}, 0), "");
  const FaultReport lost{.fault = Fault::lost_link, .last = Fault::lost_link, .port = 0, .count = 1};
  const std::string of_x = "lost link, X on stage (127.0.0.1:1503)";
  EXPECT_EQ(line(lost, 5),
            of_x + ": the device has not answered for as long as the value may be old; 1 since the start.");
  EXPECT_EQ(line(lost, 2000), "");
  const FaultReport over{.last = Fault::lost_link, .port = 0, .count = 1};
  EXPECT_EQ(line(over, 2005), "none any more; 1 since the start, the last: " + of_x + ".");
  EXPECT_EQ(line(lost, 2010), "") << "too soon";
  const FaultReport again{.last = Fault::lost_link, .port = 0, .count = 700};
  EXPECT_EQ(line(again, 3004), "") << "too soon";
  EXPECT_EQ(line(again, 3005), "none any more; 700 since the start, the last: " + of_x + ".");
  EXPECT_EQ(line(again, 9000), "");
}

TEST(AbsenceNotices, AreSaidOnceAndWhenTheDeviceAnswers) {
  const AbsenceNotices::Clock::time_point start{};
  AbsenceNotices notices(start);
  using std::chrono::seconds;
  EXPECT_TRUE(notices.lines({"stage", "pump"}, start + milliseconds(999)).empty()) << "it has some time to answer";
  const auto first = notices.lines({"stage"}, start + seconds(1));
  ASSERT_EQ(first.size(), 1U);
  EXPECT_EQ(first[0].find("stage has not answered since the start: the task goes on without it"), 0U) << first[0];
  EXPECT_TRUE(notices.lines({"stage"}, start + seconds(6)).empty());
  EXPECT_EQ(notices.lines({}, start + seconds(7)), std::vector<std::string>{"stage answers, and counts from now on."});
  EXPECT_TRUE(notices.lines({}, start + seconds(8)).empty());
}

/// What is connected to the journal has its priority before it; another stream of the same process has not.
TEST(Notices, ALineInTheJournalHasItsPriority) {
  const auto told = [](bool is_in_journal) {
    testing::internal::CaptureStderr();
    struct stat error {};
    EXPECT_EQ(::fstat(STDERR_FILENO, &error), 0);
    ::setenv("JOURNAL_STREAM", fmt::format("{}:{}", error.st_dev, error.st_ino + (is_in_journal ? 0 : 1)).c_str(), 1);
    tell("Modbus", "one");
    tell("Fault", "two", Weight::error);
    tell("Fault", "none any more", Weight::notice);
    (void)std::fputs(weighted("error: a\n\nmend: b", Weight::error).c_str(), stderr);
    ::unsetenv("JOURNAL_STREAM");
    return testing::internal::GetCapturedStderr();
  };
  EXPECT_EQ(weighted("HY803 error: one\nmend: two", Weight::error), "HY803 error: one\nmend: two");
  EXPECT_EQ(told(true), "<4>Modbus: one\n<3>Fault: two\n<5>Fault: none any more\n<3>error: a\n<3>\n<3>mend: b");
  EXPECT_EQ(told(false), "Modbus: one\nFault: two\nFault: none any more\nerror: a\n\nmend: b");
}

TEST(ForceNotices, AreALineWhereTheSetChangedAndOneASecondAtTheMost) {
  ForceNotices notices;
  const ForceNotices::Clock::time_point start{};
  const auto at = [&](int milliseconds) { return start + std::chrono::milliseconds(milliseconds); };
  EXPECT_EQ(notices.line({}, at(0)), "") << "nothing is forced, and nothing was";
  EXPECT_EQ(notices.line({"X = 1.5", "ON = 1"}, at(1)),
            "X = 1.5, ON = 1 from the live page, until that page is closed or ends it.");
  EXPECT_EQ(notices.line({"X = 1.5", "ON = 1"}, at(5000)), "") << "it is said once";
  EXPECT_EQ(notices.line({"X = 2"}, at(5001)), "X = 2 from the live page, until that page is closed or ends it.");
  EXPECT_EQ(notices.line({}, at(5002)), "");
  EXPECT_EQ(notices.line({}, at(6002)), "no input is forced any more.");
}

}  // namespace
}  // namespace hysteron::runtime
