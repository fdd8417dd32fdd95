// Rows that wait for the broker, on the disk.
#include "runtime/mqtt/outbox_file.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <random>

#include "tests/runtime/mqtt/outbox_kill.hpp"
#include "tests/support/scratch_folder.hpp"

namespace hysteron::runtime {
namespace {

using database::DatabaseError;
using database::Trouble;
using test::numbered_row;
using ::testing::EndsWith;
using ::testing::HasSubstr;

const std::vector<std::string> two_points{"U", "Y"};

void add(OutboxFile& file, std::uint64_t count) {
  std::vector<MqttRow> rows;
  std::vector<const MqttRow*> added;
  for (std::uint64_t i = 0; i < count; ++i) {
    rows.push_back(numbered_row(file.end() + i));
  }
  for (const MqttRow& row : rows) {
    added.push_back(&row);
  }
  file.follow(file.first(), added);
}

TEST(OutboxFile, GivesBackWhatWaitsToTheBit) {
  const hysteron::test::ScratchFolder folder;
  const std::vector<double> values{0.1,
                                   -0.0,
                                   1e-310,
                                   1.7976931348623157e308,
                                   std::numeric_limits<double>::infinity(),
                                   std::numeric_limits<double>::quiet_NaN()};
  MqttRow row{.utc_ms = -5, .cycle = 1ULL << 62U};
  for (const double value : values) {
    row.values.push_back({.point = row.values.size() % 2, .value = value, .quality = ValueQuality::Bad});
  }
  {
    OutboxFile file(folder / "rows.sqlite", two_points);
    EXPECT_TRUE(file.rows().empty());
    file.follow(0, {&row});
  }
  const OutboxFile again(folder / "rows.sqlite", two_points);
  ASSERT_EQ(again.rows().size(), 1U);
  const MqttRow& read = again.rows().front();
  EXPECT_EQ(read.utc_ms, -5);
  EXPECT_EQ(read.cycle, 1ULL << 62U);
  ASSERT_EQ(read.values.size(), values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    EXPECT_EQ(read.values[i].point, i % 2);
    EXPECT_EQ(read.values[i].quality, ValueQuality::Bad);
    EXPECT_TRUE(read.values[i].value == values[i] || (std::isnan(values[i]) && std::isnan(read.values[i].value)));
    EXPECT_EQ(std::signbit(read.values[i].value), std::signbit(values[i])) << i;
  }
}

TEST(OutboxFile, GoesOnInItsNumbersAndLosesWhatIsConfirmed) {
  const hysteron::test::ScratchFolder folder;
  {
    OutboxFile file(folder / "rows.sqlite", two_points);
    add(file, 10);
    file.follow(4, {});
  }
  {
    OutboxFile file(folder / "rows.sqlite", two_points);
    EXPECT_EQ(file.first(), 4U);
    EXPECT_EQ(file.end(), 10U);
    ASSERT_EQ(file.rows().size(), 6U);
    EXPECT_EQ(file.rows().front().cycle, 4U);
    add(file, 1);
    file.follow(11, {});
  }
  const OutboxFile file(folder / "rows.sqlite", two_points);
  EXPECT_TRUE(file.rows().empty());
}

/// A run file that was edited: what is published no more has no value, and a place is another.
TEST(OutboxFile, PointsAreKnownByTheirNames) {
  const hysteron::test::ScratchFolder folder;
  {
    OutboxFile file(folder / "rows.sqlite", two_points);
    add(file, 3);
    const MqttRow only_u{.utc_ms = 1, .cycle = 99, .values = {{.point = 0, .value = 7.0}}};
    file.follow(0, {&only_u});
  }
  for (int i = 0; i < 2; ++i) {
    const OutboxFile file(folder / "rows.sqlite", {"NEW", "Y"});
    ASSERT_EQ(file.rows().size(), 3U) << "the row of U alone has nothing left";
    for (const MqttRow& row : file.rows()) {
      ASSERT_EQ(row.values.size(), 1U);
      EXPECT_EQ(row.values[0].point, 1U);
      EXPECT_EQ(row.values[0].value, -1.0);
    }
    EXPECT_EQ(file.end() - file.first(), 3U);
  }
}

TEST(OutboxFile, ADamagedFileIsPutAsideAndAnotherProgramsIsLeftAlone) {
  const hysteron::test::ScratchFolder folder;
  folder.write("rows.sqlite", std::string(5000, 'x'));
  {
    OutboxFile file(folder / "rows.sqlite", two_points);
    EXPECT_EQ(file.aside(), folder / "rows.sqlite.aside1");
    add(file, 2);
  }
  EXPECT_EQ(hysteron::test::contents_of(folder / "rows.sqlite.aside1"), std::string(5000, 'x'));
  EXPECT_EQ(OutboxFile(folder / "rows.sqlite", two_points).rows().size(), 2U);

  database::Database(folder / "other.sqlite", database::Database::Mode::Write).run("CREATE TABLE mine (a INTEGER);");
  const std::string before = hysteron::test::contents_of(folder / "other.sqlite");
  EXPECT_THROW(OutboxFile(folder / "other.sqlite", two_points), DatabaseError);
  EXPECT_TRUE(hysteron::test::contents_of(folder / "other.sqlite") == before);
}

std::string refusal_of(const std::filesystem::path& file, const std::string& owner) {
  try {
    const OutboxFile opened(file, two_points, owner);
  } catch (const OutboxOfAnother& problem) {
    return problem.what();
  }
  return "taken";
}

TEST(OutboxFile, RowsOfAnotherTaskOrTopicAreLeftAlone) {
  const hysteron::test::ScratchFolder folder;
  const std::filesystem::path path = folder / "rows.sqlite";
  {
    OutboxFile file(path, two_points, "STAGE on topic a");
    add(file, 3);
  }
  for (const char* const other : {"STAGEB on topic b", "STAGE on topic b"}) {
    EXPECT_THAT(refusal_of(path, other), EndsWith("rows.sqlite: holds 3 rows of STAGE on topic a, and is left alone"));
  }
  {
    OutboxFile file(path, two_points, "STAGE on topic a");
    ASSERT_EQ(file.rows().size(), 3U);
    EXPECT_EQ(file.rows().front().cycle, 0U);
    file.follow(3, {});
  }
  EXPECT_EQ(refusal_of(path, "STAGEB on topic b"), "taken") << "nothing waits in it";
  {
    OutboxFile file(path, two_points, "STAGEB on topic b");
    add(file, 1);
  }
  EXPECT_THAT(refusal_of(path, "STAGE on topic a"), HasSubstr("holds 1 rows of STAGEB on topic b"));
}

TEST(OutboxFile, AnotherProcessThatHasItIsNamed) {
  const hysteron::test::ScratchFolder folder;
  const std::filesystem::path path = folder / "rows.sqlite";
  std::array<int, 2> ends{};
  ASSERT_EQ(::pipe(ends.data()), 0);
  const pid_t child = ::fork();
  if (child == 0) {
    const OutboxFile file(path, two_points, "STAGE on topic a");
    (void)!::write(ends[1], "x", 1);
    for (;;) {
      ::pause();
    }
  }
  char told = 0;
  ASSERT_EQ(::read(ends[0], &told, 1), 1);
  EXPECT_THAT(refusal_of(path, "STAGEB on topic b"), HasSubstr(fmt::format("rows.sqlite: process {} (", child)));
  (void)::kill(child, SIGKILL);
  (void)::waitpid(child, nullptr, 0);
  ::close(ends[0]);
  ::close(ends[1]);
}

TEST(OutboxFile, WhatIsKilledAtAnyMomentIsWholeAndHasAllThatWasTold) {
  const hysteron::test::ScratchFolder folder;
  std::mt19937 random(5);
  std::uint64_t told = 0;
  for (int k = 0; k < 25; ++k) {
    const auto result = test::kill_outbox(folder / "rows.sqlite", 1 + static_cast<int>(random() % 4),
                                          static_cast<useconds_t>(random() % 3000));
    ASSERT_TRUE(result.is_whole) << k << ": " << result.first << " to " << result.end << ", found " << result.found;
    told += result.end - result.first;
  }
  EXPECT_GT(told, 0U);
}

}  // namespace
}  // namespace hysteron::runtime
