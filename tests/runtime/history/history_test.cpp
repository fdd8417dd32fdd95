// The history of a task: each row is in it once, whole, in order, and its time is that of the grid; whatever becomes of
// the disk, the clock and the process.
#include "runtime/history/history.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <random>

#include "runtime/history/tables.hpp"
#include "tests/runtime/history/history_bench.hpp"
#include "tests/runtime/history/history_kill.hpp"
#include "tests/support/file_size_limit.hpp"
#include "tests/support/scratch_folder.hpp"

namespace hysteron::runtime {
namespace {

using hysteron::test::contents_of;
using hysteron::test::FileSizeLimit;
using test::HistoryBench;
using testing::ElementsAre;
using testing::HasSubstr;

class Histories : public testing::Test {
 protected:
  [[nodiscard]] std::filesystem::path file() const { return folder / "history.sqlite"; }
  [[nodiscard]] StretchList stretches() const { return HistoryReader(file()).stretches({}); }

  hysteron::test::ScratchFolder folder{};
};

TEST_F(Histories, GiveBackEachRowWithItsTimeNameAndUnit) {
  HistoryBench bench(file());
  bench.start();
  for (int second = 0; second < 5; ++second) {
    bench.second();
  }
  bench.stop();
  HistoryReader reader(file());
  const auto runs = reader.runs();
  ASSERT_EQ(runs.size(), 1U);
  EXPECT_EQ(runs[0].title, "STAGE");
  EXPECT_EQ(runs[0].sample_time(), 0.01);
  EXPECT_EQ(runs[0].points[1].name + runs[0].points[1].unit + runs[0].points[1].meaning, "Yumthe way");
  const auto found = reader.stretches({});
  ASSERT_EQ(found.stretches.size(), 1U);
  // The first cycle is 1, in slot 0; from then on each tenth.
  EXPECT_EQ(found.stretches[0].rows, 501);
  EXPECT_EQ(found.stretches[0].last_ms, bench.utc_ms());
  const auto values = reader.values(found.stretches[0], runs[0].points);
  EXPECT_EQ(values[0][0], 1.0);
  for (std::size_t i = 1; i < values[0].size(); ++i) {
    EXPECT_EQ(values[0][i], 10.0 * static_cast<double>(i));
    EXPECT_EQ(values[1][i], 5.0 * static_cast<double>(i));
  }
  EXPECT_EQ(bench.count().done, 501U);
  EXPECT_EQ(bench.count().lost, 0U);
  EXPECT_EQ(bench.said(), "");
}

TEST_F(Histories, SkippedCyclesMoveNoRowOffTheGrid) {
  HistoryBench bench(file());
  bench.start();
  bench.run(25);
  bench.skip(8);  // the row of 30 is taken at 34
  bench.run(30);
  bench.skip(25);  // two rows are missing
  bench.run(50);
  bench.stop();
  const auto found = stretches().stretches;
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].first_slot, 0);
  EXPECT_EQ(found[0].rows, 7);
  EXPECT_EQ(found[0].late, 2) << "the first cycle is 1, not 0";
  EXPECT_EQ(found[1].first_slot, 8);
}

TEST_F(Histories, WhatHasNoRoomIsCounted) {
  HistoryBench bench(file(), 1);
  bench.start(100);
  bench.run(1000);
  EXPECT_EQ(bench.count().lost, 900U);
  bench.turn();
  EXPECT_EQ(bench.count().done, 100U);
  bench.stop();
  EXPECT_EQ(bench.count().lost + bench.count().done, 1000U);
}

TEST_F(Histories, AWallClockThatIsSetLosesAndReordersNothing) {
  HistoryBench bench(file());
  bench.start();
  bench.second();
  bench.set_clock(-3600 * test::one_second);
  bench.second();
  EXPECT_THAT(bench.said(), HasSubstr("clock was set back by 3600.0 s"));
  bench.set_clock(7200 * test::one_second);
  bench.second();
  EXPECT_THAT(bench.said(), HasSubstr("clock was set forward by 7200.0 s"));
  bench.stop();
  const auto found = stretches();
  ASSERT_EQ(found.stretches.size(), 1U) << "the time of the grid goes on";
  ASSERT_EQ(found.clock_steps.size(), 2U);
  EXPECT_NEAR(found.clock_steps[0].seconds, -3600.0, 0.01);
  EXPECT_NEAR(found.clock_steps[1].seconds, 7200.0, 0.01);
  const auto values = test::column_of(file(), 0);
  EXPECT_TRUE(std::ranges::is_sorted(values));
  EXPECT_EQ(values.size(), 301U);
}

TEST_F(Histories, AFullDiskDelaysRowsAndLosesThoseBeyondTheRoomForThem) {
  HistoryBench bench(file());
  bench.start(1000);
  bench.second();
  {
    const FileSizeLimit full(std::filesystem::file_size(file()) / 2);
    bench.second();
    EXPECT_NE(bench.count().fault, 0U);
    EXPECT_THAT(bench.said(), HasSubstr("nothing is written any more: " + file().string()));
    for (int second = 0; second < 5; ++second) {
      bench.second();
    }
    EXPECT_EQ(bench.said(), "") << "it is said once";
    EXPECT_NE(bench.keeper().remarks().problem(), "");
  }
  bench.pass(70 * test::one_second);  // the longest pause
  bench.turn();
  EXPECT_EQ(bench.count().fault, 0U);
  EXPECT_EQ(bench.keeper().remarks().problem(), "");
  EXPECT_THAT(bench.said(), HasSubstr("written again; 0 rows are lost"));
  EXPECT_EQ(bench.count().done, 701U);
  EXPECT_EQ(stretches().stretches.size(), 1U);
  {
    const FileSizeLimit full(std::filesystem::file_size(file()) / 2);
    for (int second = 0; second < 20; ++second) {
      bench.second();
    }
  }
  bench.pass(70 * test::one_second);
  bench.turn();
  EXPECT_EQ(bench.count().fault, 0U);
  EXPECT_GT(bench.count().lost, 0U);
  EXPECT_EQ(bench.count().done + bench.count().lost, 2701U);
  bench.stop();
  EXPECT_EQ(test::column_of(file(), 0).size(), bench.count().done);
}

TEST_F(Histories, ADiskThatIsGoneHealsByItself) {
  const std::string disk = folder / "disk";
  HistoryBench bench(disk + "/history.sqlite");
  bench.start();
  bench.second();
  std::filesystem::rename(disk, folder / "away");
  folder.write("disk", "no folder");
  bench.second();
  EXPECT_EQ(bench.count().fault, static_cast<std::uint16_t>(HistoryFault::Unreachable));
  EXPECT_THAT(bench.said(), testing::AllOf(HasSubstr("its file is gone"), HasSubstr("nothing is written any more")));
  std::filesystem::remove(disk);
  std::filesystem::rename(folder / "away", disk);
  bench.pass(2 * test::one_second);
  bench.second();
  EXPECT_EQ(bench.count().fault, 0U);
  bench.stop();
  const auto values = test::column_of(bench.file(), 0);
  EXPECT_EQ(values.size(), 301U) << "of one run, in the file of before";
  EXPECT_EQ(HistoryReader(bench.file()).runs().size(), 1U);
}

TEST_F(Histories, AFileThatIsDeletedIsFollowedByAnother) {
  HistoryBench bench(file());
  bench.start();
  bench.second();
  for (const char* const ending : {"", "-wal", "-shm"}) {
    std::filesystem::remove(file().string() + ending);
  }
  bench.second();
  EXPECT_THAT(bench.said(), HasSubstr("its file is gone; another one is begun"));
  bench.stop();
  EXPECT_EQ(test::column_of(file(), 0).size(), 100U);
}

/// On a virtual clock a run of days may come in one turn, and its rows are as old as they say.
TEST_F(Histories, AVirtualClockKeepsSizeAndAgeToo) {
  for (const bool by_age : {false, true}) {
    HistoryBench bench(folder / (by_age ? "by_age" : "by_size"), 1, by_age ? 100'000'000 : 1'000'000);
    bench.settings().virtual_time = true;
    bench.settings().keep = (by_age ? 10 : 86'400) * test::one_second;
    bench.start(100'000);
    bench.run(100'000);
    bench.turn();
    bench.stop();
    const auto values = test::column_of(bench.file(), 0);
    ASSERT_FALSE(values.empty());
    EXPECT_EQ(values.back(), 100'000.0);
    if (by_age) {
      EXPECT_NEAR(values.front(), 90'000.0, 1.0);
    } else {
      EXPECT_LE(std::filesystem::file_size(bench.file()), 1'000'000U);
      EXPECT_LT(values.front(), 95'000.0) << "what has room is kept";
    }
  }
}

/// SQLite closes a file that has another name by now without its log.
TEST_F(Histories, AFileThatIsMovedTakesItsRowsWithIt) {
  HistoryBench bench(file());
  bench.start();
  bench.second();
  std::filesystem::rename(file(), folder / "moved.sqlite");
  bench.second();
  bench.stop();
  EXPECT_EQ(test::column_of(folder / "moved.sqlite", 0).size(), 101U);
  EXPECT_EQ(test::column_of(file(), 0).size(), 100U);
}

TEST_F(Histories, ALockThatIsDeletedIsTakenAgain) {
  HistoryBench bench(file());
  bench.start();
  bench.second();
  const std::string lock = file().string() + ".lock";
  std::filesystem::remove(lock);
  bench.second();
  EXPECT_THROW(HistoryLock{file()}, database::DatabaseError) << "no other task comes in by the name that was free";
  std::filesystem::remove(lock);
  {
    const HistoryLock other(file());
    bench.second();
    EXPECT_EQ(bench.count().fault, static_cast<std::uint16_t>(HistoryFault::Held));
    EXPECT_THAT(bench.said(), HasSubstr("history.sqlite: another task writes it"));
  }
  bench.pass(2 * test::one_second);
  bench.second();
  EXPECT_EQ(bench.count().fault, 0U);
  bench.stop();
  EXPECT_EQ(test::column_of(file(), 0).size(), 401U) << "what waited meanwhile is there, too";
}

TEST_F(Histories, WhatIsDamagedOrOfAnotherVersionIsPutAside) {
  HistoryBench bench(file());
  bench.start();
  bench.second();
  bench.stop();
  {
    database::Database newer(file(), database::Database::Mode::Write);
    newer.set_version(history_version + 1);
  }
  EXPECT_EQ(kind_of_history(file()), HistoryKind::Other);
  bench.start();
  bench.second();
  EXPECT_THAT(bench.said(), HasSubstr("is damaged or of another version, and is " + file().string() + ".aside1 now"));
  bench.stop();
  // The pages behind the first are garbage.
  std::string bytes = contents_of(file());
  std::fill(bytes.begin() + 4096, bytes.end(), '\x5a');
  folder.write("history.sqlite", bytes);
  bench.start();
  for (int second = 0; second < 3; ++second) {
    bench.second();
  }
  EXPECT_THAT(bench.said(), HasSubstr(".aside2 now"));
  EXPECT_EQ(bench.count().fault, 0U);
  bench.stop();
  EXPECT_EQ(contents_of(file().string() + ".aside2").substr(4096), bytes.substr(4096));
  folder.write("history.sqlite", std::string(8192, '\0'));
  EXPECT_EQ(kind_of_history(file()), HistoryKind::Damaged);
}

TEST_F(Histories, WhatIsOfSomethingElseIsLeftAlone) {
  EXPECT_EQ(kind_of_history(file()), HistoryKind::None);
  folder.write("history.sqlite", "");
  EXPECT_EQ(kind_of_history(file()), HistoryKind::None);
  folder.write("history.sqlite", "FUNCTION_BLOCK PRECIOUS");
  EXPECT_EQ(kind_of_history(file()), HistoryKind::Foreign);
  HistoryBench bench(file());
  bench.start();
  bench.second();
  EXPECT_THAT(bench.said(), HasSubstr("is no history, and is left alone"));
  EXPECT_EQ(bench.count().fault, static_cast<std::uint16_t>(HistoryFault::Damaged));
  EXPECT_EQ(contents_of(file()), "FUNCTION_BLOCK PRECIOUS");
  std::filesystem::remove(file());
  database::Database(file(), database::Database::Mode::Write).run("CREATE TABLE grafana (a)");
  EXPECT_EQ(kind_of_history(file()), HistoryKind::Foreign);
  EXPECT_EQ(kind_of_history(folder.path()), HistoryKind::Foreign);
}

TEST_F(Histories, AnEditedDiagramGoesOnInTheColumnsOfItsNames) {
  HistoryBench bench(file());
  bench.start();
  bench.second();
  bench.stop();
  auto& points = bench.settings().plan.points;
  points = {{.name = "y", .unit = "um"}, {.name = "U", .unit = "mV"}};
  bench.start();
  bench.second();
  bench.stop();
  points = {{.name = "CYCLE", .unit = "1"}, {.name = "Y", .unit = "um"}};  // a name that the table has for itself
  bench.start();
  bench.second();
  bench.stop();
  HistoryReader reader(file());
  const auto runs = reader.runs();
  ASSERT_EQ(runs.size(), 3U);
  const auto columns = [&](std::size_t run) {
    return std::vector<std::string>{runs[run].points[0].column, runs[run].points[1].column};
  };
  EXPECT_THAT(columns(0), ElementsAre("U", "Y"));
  EXPECT_THAT(columns(1), ElementsAre("Y", "U [mV]"));
  EXPECT_THAT(columns(2), ElementsAre("CYCLE [1]", "Y"));
  for (const RecordedRun& run : runs) {
    const auto found = reader.stretches({.run = run.run}).stretches;
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(reader.values(found[0], run.points)[0].back(), 1000.0);
  }
}

TEST_F(Histories, TheSizeIsBoundedAndTheNewestStays) {
  constexpr std::uint64_t bytes = 1'000'000;
  HistoryBench bench(file(), 1, bytes);
  bench.start();
  std::uint64_t largest = 0;
  for (int second = 0; second < 120; ++second) {
    bench.second();
    largest =
        std::max(largest, std::filesystem::file_size(file()) + std::filesystem::file_size(file().string() + "-wal"));
  }
  bench.stop();
  EXPECT_LE(largest, bytes);
  EXPECT_EQ(bench.count().lost, 0U);
  EXPECT_EQ(bench.count().done, 120'000U);
  const auto values = test::column_of(file(), 0);
  EXPECT_GT(values.size(), 10'000U) << "most of the room is rows";
  EXPECT_EQ(values.back(), 120'000.0);
  EXPECT_EQ(values.back() - values.front() + 1.0, static_cast<double>(values.size()))
      << "the oldest are gone, no other";
}

TEST_F(Histories, LessRoomIsGivenBackToTheDisk) {
  HistoryBench bench(file(), 1, 4'000'000);
  bench.start();
  for (int second = 0; second < 60; ++second) {
    bench.second();
  }
  bench.stop();
  EXPECT_GT(std::filesystem::file_size(file()), 1'000'000U);
  bench.settings().plan.bytes = 1'000'000;
  bench.start();
  for (int second = 0; second < 5; ++second) {
    bench.second();
  }
  bench.stop();
  EXPECT_LE(std::filesystem::file_size(file()), 1'000'000U);
}

TEST_F(Histories, RowsThatAreTooOldAreDeletedByAClockThatIsTrusted) {
  HistoryBench bench(file(), 1000);
  bench.settings().keep = 3 * 3600 * test::one_second;
  bench.start();
  const auto hour = [&] {
    for (int minute = 0; minute < 60; ++minute) {
      bench.skip(59'000);
      bench.second();
    }
  };
  const auto oldest = [&] { return stretches().stretches.front().first_ms; };
  const auto begin = bench.utc_ms();
  hour();
  hour();
  bench.set_clock(24 * 3600 * test::one_second);
  bench.second();
  EXPECT_LT(oldest(), begin + 61'000) << "a clock that was just set deletes nothing";
  bench.set_clock(-24 * 3600 * test::one_second);
  bench.second();
  hour();
  hour();
  bench.stop();
  EXPECT_NEAR(static_cast<double>(oldest()), static_cast<double>(bench.utc_ms() - 3 * 3'600'000), 61'000.0);
}

TEST_F(Histories, AProgramThatReadsForLongCannotMakeItGrow) {
  constexpr std::uint64_t bytes = 1'000'000;
  HistoryBench bench(file(), 1, bytes);
  bench.start(100'000);
  bench.second();
  {
    HistoryReader reader(file());
    reader.hold_still();
    EXPECT_TRUE(reader.newest_ms().has_value());
    for (int second = 0; second < 60 && bench.count().fault == 0; ++second) {
      bench.second();
    }
    EXPECT_EQ(bench.count().fault, static_cast<std::uint16_t>(HistoryFault::Held));
    EXPECT_LE(std::filesystem::file_size(file()) + std::filesystem::file_size(file().string() + "-wal"), 2 * bytes);
    EXPECT_EQ(reader.stretches({}).stretches[0].rows, 1000) << "of the moment that it began at";
  }
  bench.pass(70 * test::one_second);
  bench.turn();
  EXPECT_EQ(bench.count().fault, 0U);
  bench.stop();
  EXPECT_EQ(bench.count().lost, 0U);
}

TEST_F(Histories, AKillLosesNothingThatWasConfirmed) {
  std::mt19937 random(5);
  std::int64_t rows = 0;
  for (int kill = 0; kill < 20; ++kill) {
    const auto result =
        test::kill_history(file(), kill, 1 + static_cast<int>(random() % 8), static_cast<useconds_t>(random() % 3000));
    EXPECT_GT(result.confirmed, 0U);
    EXPECT_TRUE(result.is_whole) << result.rows << " rows, " << result.confirmed << " confirmed";
    rows += result.rows;
  }
  EXPECT_EQ(test::column_of(file(), 0).size(), static_cast<std::size_t>(rows)) << "of all runs";
}

TEST_F(Histories, AnotherTaskKeepsOut) {
  const HistoryLock held(file());
  EXPECT_THROW(HistoryLock second(file()), database::DatabaseError);
  HistoryBench bench(file());
  bench.start();
  bench.second();
  EXPECT_EQ(bench.count().fault, static_cast<std::uint16_t>(HistoryFault::Held));
}

TEST_F(Histories, TheLastTurnCountsWhatCannotBeWritten) {
  folder.write("history.sqlite", "FUNCTION_BLOCK PRECIOUS");
  HistoryBench bench(file());
  bench.start();
  bench.second();
  bench.stop();
  EXPECT_EQ(bench.count().done, 0U);
  EXPECT_EQ(bench.count().lost, 101U);
}

}  // namespace
}  // namespace hysteron::runtime
