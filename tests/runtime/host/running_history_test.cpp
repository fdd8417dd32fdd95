// A task with a history: each row is there, what cannot be used is refused before anything is touched, and a disk that
// is gone stops no control.
#include "runtime/host/running_history.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "runtime/history/history_reader.hpp"
#include "runtime/host/host.hpp"
#include "support/diagnostic.hpp"
#include "tests/runtime/history/history_bench.hpp"
#include "tests/runtime/task/accumulator.hpp"
#include "tests/support/error_page.hpp"
#include "tests/support/scratch_folder.hpp"

namespace hysteron::runtime {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

class RunningHistories : public testing::Test {
 protected:
  struct Outcome {
    bool well = false;
    std::string out{};
    std::string err{};
  };

  Outcome run(const std::string& table) {
    test::Accumulator program;
    Outcome outcome;
    testing::internal::CaptureStderr();
    try {
      const auto config = parse_run_config("RUN.toml", "[outputs.Y]\nsafe = 0.0\n[outputs.TORN]\nsafe = 0.0\n" + table,
                                           program.shape());
      outcome.well = run_host(program, config, {.how = "linked", .cycles = 5000, .virtual_time = true},
                              [&](std::string_view text) { outcome.out += text; });
    } catch (const InputError& refused) {
      const Diagnostic& first = refused.diagnostics().all().front();
      outcome.out = fmt::format("HY{}:{}: {} {}", first.number, first.place.line, first.cause, first.mend);
    }
    outcome.err = testing::internal::GetCapturedStderr();
    return outcome;
  }
  [[nodiscard]] std::string table(const std::string& more = "") const {
    return fmt::format("[history]\nfile = \"{}\"\n{}", file().string(), more);
  }
  [[nodiscard]] std::filesystem::path file() const { return folder / "history.sqlite"; }

  hysteron::test::ScratchFolder folder{};
};

TEST_F(RunningHistories, EachCycleOfAVirtualRunIsThere) {
  EXPECT_TRUE(run(table("every = \"1ms\"\npoints = [\"y\", \"G.A\", \"task.cycles\"]\n")).well);
  HistoryReader reader(file());
  const auto runs = reader.runs();
  ASSERT_EQ(runs.size(), 1U);
  EXPECT_EQ(runs[0].title, "ACCUMULATOR");
  EXPECT_EQ(runs[0].points[0].name + runs[0].points[0].unit, "Yum");
  const auto found = reader.stretches({});
  ASSERT_EQ(found.stretches.size(), 1U);
  EXPECT_EQ(found.stretches[0].rows, 5000);
  const auto values = reader.values(found.stretches[0], runs[0].points);
  for (std::size_t i = 0; i < 5000; ++i) {
    ASSERT_EQ(values[0][i], static_cast<double>(i + 1));
    ASSERT_EQ(values[1][i], 1.0);
    ASSERT_EQ(values[2][i], static_cast<double>(i + 1));
  }
  EXPECT_TRUE(run(table("every = \"1ms\"\npoints = [\"y\"]\n")).well);
  EXPECT_EQ(HistoryReader(file()).runs().size(), 2U);
}

TEST_F(RunningHistories, WhatIsOfSomethingElseIsRefused) {
  folder.write("history.sqlite", "FUNCTION_BLOCK PRECIOUS");
  EXPECT_THAT(run(table()).out, StartsWith("HY817:6: " + file().string() + " is there already, and is no history."));
  EXPECT_EQ(hysteron::test::contents_of(file()), "FUNCTION_BLOCK PRECIOUS");
  EXPECT_EQ(folder.names(), (std::set<std::string>{"history.sqlite"}));
}

TEST_F(RunningHistories, ThePageOfForeignFilesKeepsItsWord) {
  const auto before = std::filesystem::current_path();
  std::filesystem::current_path(folder.path());
  folder.write("grafana.db", "Precious words that are no history.");
  const auto page = hysteron::test::read_error_page("HY817");
  const auto table_of = [](const std::string& text) { return text.substr(text.find("[history]")); };
  EXPECT_THAT(run(table_of(page.fails.text)).out, StartsWith("HY817:"));
  EXPECT_TRUE(run(table_of(page.mended.text)).well);
  std::filesystem::current_path(before);
}

TEST_F(RunningHistories, OfATaskThatRunsAreRefused) {
  const HistoryLock held(file());
  EXPECT_THAT(run(table()).out, StartsWith("HY815:6: Another task that runs writes its history to "));
}

TEST_F(RunningHistories, ADiskThatIsMissingStopsNoControl) {
  const auto outcome = run("[history]\nfile = \"/dev/null/history.sqlite\"\n");
  EXPECT_FALSE(outcome.well) << "the run says by its exit code that its rows are lost";
  EXPECT_THAT(outcome.out,
              testing::AllOf(HasSubstr("; 5000 cycles, 0 skipped; "),
                             HasSubstr("; the last rows of the history are lost: /dev/null/history.sqlite"),
                             HasSubstr("; fault: none")));
  EXPECT_THAT(outcome.err, StartsWith("History: nothing is written any more: /dev/null/history.sqlite"));
}

TEST_F(RunningHistories, NeverTakeThePlaceOfAnInput) {
  test::Accumulator program;
  const auto config =
      parse_run_config("RUN.toml", "[outputs.Y]\nsafe = 0.0\n[outputs.TORN]\nsafe = 0.0\n" + table(), program.shape());
  for (const char* const ending : {"", "-wal", "-shm", ".lock"}) {
    EXPECT_THROW(refuse_to_overwrite_inputs(config, {{.file = file().string() + ending}}), InputError) << ending;
  }
}

TEST(WaitingRows, AreThoseOfHalfAMinuteWithinReason) {
  EXPECT_EQ(waiting_rows(1'000'000, 1, 3), 30'000U);
  EXPECT_EQ(waiting_rows(1'000'000, 1000, 3), 64U);
  EXPECT_EQ(waiting_rows(1'000, 1, 8), 16'000'000U / 80U);
}

TEST(HistoryStatus, IsAmongThePointsOfTheTask) {
  test::Accumulator program;
  KeptCounter counter;
  counter.add_done(7);
  counter.add_lost(3);
  counter.set_fault(2);
  Task task(program, {.loop = {.cycles = 5}, .inputs = {{}}, .outputs = {{}, {}}}, {.history = &counter});
  VirtualClock clock;
  const std::atomic<bool> stop{false};
  (void)task.run(clock, stop);
  EXPECT_EQ(test::value(task.door(), "task.history_rows"), 7.0);
  EXPECT_EQ(test::value(task.door(), "task.history_lost"), 3.0);
  EXPECT_EQ(test::value(task.door(), "task.history_fault"), 2.0);
}

}  // namespace
}  // namespace hysteron::runtime
