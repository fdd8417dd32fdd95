// Rows that wait in a file: at an end, on a full disk, in the file of another task, and where somebody deletes it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cerrno>
#include <cstddef>
#include <filesystem>
#include <string>

#include "runtime/mqtt/mqtt.hpp"
#include "runtime/mqtt/outbox_file.hpp"
#include "tests/runtime/mqtt/mqtt_bench.hpp"
#include "tests/support/file_size_limit.hpp"
#include "tests/support/own_disk.hpp"
#include "tests/support/scratch_folder.hpp"

namespace hysteron::runtime {
namespace {

using test::Broker;
using test::MqttBench;
using testing::HasSubstr;

class RowsInAFile : public test::WithBroker {};

/// Eleven rows wait, and the broker has answered none.
struct ElevenRows {
  ElevenRows() { bench.settings.file = folder / "rows.sqlite"; }
  void begin() {
    bench.start();
    bench.turn();
    bench.run(100);
    bench.turn();
  }
  void wait_for_the_disk() {
    bench.pass(2100 * MqttBench::ms);
    bench.turn();
  }
  void delete_files() const {
    for (const std::string& name : folder.names()) {
      std::filesystem::remove(folder.path() / name);
    }
  }
  /// Ends in order: all rows wait for the next start.
  void end_with_all_rows() {
    bench.finish();
    EXPECT_EQ(bench.count().lost, 0U);
    EXPECT_EQ(bench.count().waiting, 11U);
    EXPECT_THAT(bench.said(), HasSubstr("11 rows wait in "));
    bench.stop();
    EXPECT_EQ(rows_in_the_file(), 11U);
  }
  [[nodiscard]] std::size_t rows_in_the_file(const std::string& owner = "") const {
    return OutboxFile(bench.settings.file, {"U", "Y"}, owner).rows().size();
  }

  hysteron::test::ScratchFolder folder;
  Broker broker;
  MqttBench bench{broker.port()};
};

/// An end in order keeps all that waits, and loses nothing.
TEST_F(RowsInAFile, WhatWaitsAtTheEndIsKeptForTheNextStart) {
  ElevenRows waiting;
  waiting.begin();
  waiting.end_with_all_rows();
}

/// Somebody clears the folder while the broker is away: rows do not go on into a file that has no name.
TEST_F(RowsInAFile, AFileThatIsDeletedIsSaidAndAnotherOneIsBegun) {
  ElevenRows waiting;
  MqttBench& bench = waiting.bench;
  waiting.begin();
  const auto wait_for_another = [&] {
    waiting.wait_for_the_disk();
    bench.turn();
  };
  wait_for_another();
  waiting.delete_files();
  wait_for_another();
  EXPECT_THAT(bench.said(), HasSubstr("rows.sqlite is gone; another one is begun. Had the task died meanwhile, 11 "
                                      "rows"));
  ASSERT_TRUE(bench.until([&] { return std::filesystem::exists(bench.settings.file); }));
  wait_for_another();
  EXPECT_EQ(bench.count().lost, 0U);
  bench.stop();
  EXPECT_EQ(waiting.rows_in_the_file(), 11U) << "as after a crash";
}

TEST_F(RowsInAFile, AFileThatIsDeletedJustBeforeTheEndHasTheRowsThen) {
  ElevenRows waiting;
  waiting.begin();
  waiting.wait_for_the_disk();
  waiting.delete_files();
  waiting.end_with_all_rows();
}

/// What went to the file before the disk was full waits there, and is not lost.
TEST_F(RowsInAFile, AFullDiskAtTheEndLosesWhatIsNotInTheFileAlone) {
  ElevenRows waiting;
  MqttBench& bench = waiting.bench;
  waiting.begin();
  waiting.wait_for_the_disk();  // eleven rows are there
  {
    const hysteron::test::FileSizeLimit limit(1024);
    bench.run(200);
    bench.turn();
    waiting.wait_for_the_disk();
    bench.finish();
  }
  EXPECT_EQ(bench.count().lost, 20U);
  EXPECT_EQ(bench.count().waiting, 11U);
  const std::string said = bench.said();
  EXPECT_THAT(said, HasSubstr("rows that wait are in memory alone: "));
  EXPECT_THAT(said, HasSubstr("11 rows wait in "));
  EXPECT_THAT(bench.remarks().problem(), HasSubstr("20 since the start"));
  bench.stop();
  EXPECT_EQ(waiting.rows_in_the_file(), 11U);
}

/// Nothing there is in the way: the disk itself has to be seen to.
TEST_F(RowsInAFile, OnAReadOnlyDiskTheMendIsThatOfTheDisk) {
  const hysteron::test::ScratchFolder disk;
  hysteron::test::with_own_disk(disk.path().string(), "size=1m", [&] {
    hysteron::test::change_disk(disk.path().string(), "size=1m", true);
    try {
      const OutboxFile file(disk.path() / "rows.sqlite", {"U", "Y"});
      ADD_FAILURE();
    } catch (const database::DatabaseError& problem) {
      EXPECT_EQ(problem.reason(), EROFS) << problem.what();
      EXPECT_THAT(database::way_out(problem), HasSubstr("See to the disk: "));
    }
  });
}

TEST_F(RowsInAFile, AFileOfAnotherTaskIsLeftAloneAndTheMendIsSaid) {
  ElevenRows waiting;
  MqttBench& bench = waiting.bench;
  bench.settings.owner = "STAGE on topic a";
  waiting.begin();
  bench.finish();
  bench.stop();
  bench.settings.owner = "STAGEB on topic b";
  bench.start();
  bench.turn();
  EXPECT_THAT(bench.said(), HasSubstr("holds 11 rows of STAGE on topic a, and is left alone. Each task needs a file of "
                                      "its own: write another one under [mqtt]"));
  bench.stop();
  EXPECT_EQ(waiting.rows_in_the_file("STAGE on topic a"), 11U);
}

}  // namespace
}  // namespace hysteron::runtime
