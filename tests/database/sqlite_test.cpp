#include "database/sqlite.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>

#include "support/temporary_folder.hpp"

namespace hysteron::database {
namespace {

class Sqlite : public testing::Test {
 protected:
  [[nodiscard]] std::filesystem::path file() const { return folder_.path() / "a.sqlite"; }

 private:
  TemporaryFolder folder_{std::filesystem::temp_directory_path()};
};

TEST_F(Sqlite, GivesBackWhatItWasGiven) {
  Database database(file(), Database::Mode::Write);
  database.run("CREATE TABLE cells (a REAL, b INTEGER, c TEXT)");
  Statement insert = database.prepared("INSERT INTO cells VALUES (?, ?, ?)");
  insert.bind(1, 0.1).bind(2, std::numeric_limits<std::int64_t>::min()).bind(3, std::string_view("ü;\0x", 5)).run();
  insert.bind(1, std::numeric_limits<double>::infinity()).bind(2, std::int64_t{0}).bind(3, std::string_view()).run();
  insert.bind(1, std::numeric_limits<double>::quiet_NaN()).bind_null(2).bind_null(3).run();

  Database reader(file(), Database::Mode::Read);
  Statement rows = reader.prepared("SELECT a, b, c FROM cells ORDER BY rowid");
  ASSERT_TRUE(rows.step());
  EXPECT_EQ(rows.number(0), 0.1);
  EXPECT_EQ(rows.integer(1), std::numeric_limits<std::int64_t>::min());
  EXPECT_EQ(rows.text(2), std::string("ü;\0x", 5));
  ASSERT_TRUE(rows.step());
  EXPECT_EQ(rows.number(0), std::numeric_limits<double>::infinity());
  EXPECT_FALSE(rows.is_null(2));
  EXPECT_EQ(rows.text(2), "");
  ASSERT_TRUE(rows.step());
  EXPECT_TRUE(std::isnan(rows.number(0)));
  EXPECT_TRUE(rows.is_null(1));
  EXPECT_TRUE(rows.is_null(2));
  EXPECT_FALSE(rows.step());
}

TEST_F(Sqlite, ATransactionIsThereAsAWholeOrNotAtAll) {
  Database database(file(), Database::Mode::Write);
  database.run("CREATE TABLE cells (a INTEGER)");
  {
    Transaction given_up(database);
    database.run("INSERT INTO cells VALUES (1)");
  }
  {
    Transaction kept(database);
    database.run("INSERT INTO cells VALUES (2)");
    kept.commit();
  }
  Statement sum = database.prepared("SELECT sum(a), count(*) FROM cells");
  ASSERT_TRUE(sum.step());
  EXPECT_EQ(sum.integer(0), 2);
  EXPECT_EQ(sum.integer(1), 1);
}

TEST_F(Sqlite, KeepsTheVersionOfItsTables) {
  {
    Database database(file(), Database::Mode::Write);
    EXPECT_EQ(database.version(), 0);
    database.set_version(3);
  }
  EXPECT_EQ(Database(file(), Database::Mode::Read).version(), 3);
}

/// The error names the file, and says whether another try may help.
std::string refusal(const std::filesystem::path& path, Database::Mode mode, bool is_passing) {
  try {
    const Database database(path, mode);
  } catch (const DatabaseError& error) {
    EXPECT_EQ(error.is_passing(), is_passing) << error.what();
    return error.what();
  }
  return "opened";
}

TEST_F(Sqlite, WhatIsNoDatabaseIsRefusedByItsName) {
  std::ofstream(file())
      << "time,U\n0,1\n and more text than a head of SQLite has, so that it is read as a file that is none\n";
  for (const Database::Mode mode : {Database::Mode::Read, Database::Mode::Write}) {
    EXPECT_EQ(refusal(file(), mode, false), file().string() + ": file is not a database");
  }
  EXPECT_EQ(
      refusal(file().parent_path() / "none.sqlite", Database::Mode::Read, true),
      (file().parent_path() / "none.sqlite").string() + ": unable to open database file (No such file or directory)");
}

TEST_F(Sqlite, AWrongStatementIsAnErrorAndNoCrash) {
  Database database(file(), Database::Mode::Write);
  EXPECT_THROW(database.run("SELEKT 1"), DatabaseError);
  EXPECT_THROW(static_cast<void>(database.prepared("SELECT nothing FROM nowhere")), DatabaseError);
  EXPECT_THROW(database.prepared("SELECT ?").bind(2, 1.0), DatabaseError);
}

}  // namespace
}  // namespace hysteron::database
