#include "records/record.hpp"

#include <gmock/gmock.h>

#include <bit>
#include <cstdint>
#include <limits>
#include <random>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "records/csv.hpp"
#include "records/read.hpp"
#include "support/errors.hpp"
#include "tests/support/scratch_folder.hpp"

namespace hysteron::records {
namespace {

using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;

Record sample() {
  Record record = Record::even(0.0, 0.25, 8);
  record.add({"u", "V", {0, 1, 2, 3, 4, 5, 6, 7}});
  record.add({"Y", "um", {0, -1, -2, -3, -4, -5, -6, -7}});
  return record;
}

TEST(Record, ColumnsByName) {
  const Record record = sample();
  EXPECT_EQ(record.size(), 8U);
  EXPECT_EQ(record.time()[7], 1.75);
  EXPECT_EQ(record.column("y").unit, "um");
  EXPECT_EQ(record.find("U")->values[3], 3.0);
  EXPECT_EQ(record.find("z"), nullptr);
  EXPECT_THAT(record.names(), ElementsAre("u", "Y"));
}

TEST(Record, AnElementIsNoOtherElement) {
  const auto mend = [](const std::string& head, const std::string& name) {
    const auto record = parse_record("log.csv", head + "\n0,1,2\n1,1,2\n");
    try {
      (void)record.column(name);
    } catch (const InputError& refused) {
      return refused.diagnostics().all().front().mend;
    }
    return std::string();
  };
  EXPECT_EQ(mend("t,U[0],U[1]", "U[2]"), "record the signal, or say which column it is, as --column U[2]=NAME.");
  EXPECT_EQ(mend("t,U_0,U_1", "u[1]"), "if U_1 is meant, say so: --column u[1]=U_1.");
}

TEST(Record, AMissingColumnNamesThoseThereAre) {
  const auto record = parse_record("log.csv", "# x\nt,ref,position\n0,1,2\n1,1,2\n");
  try {
    (void)record.column("postion");
    FAIL();
  } catch (const InputError& refused) {
    const auto& said = refused.diagnostics().all().front();
    EXPECT_EQ(said.number, error::missing_column);
    EXPECT_EQ(said.place.file, "log.csv");
    EXPECT_EQ(said.place.line, 2U);
    EXPECT_EQ(said.cause, "There is no column postion; the columns are t, ref, position.");
    EXPECT_EQ(said.mend, "if position is meant, say so: --column postion=position.");
  }
}

/// The time is listed as the file calls it, and not at all where a rate is stated instead.
TEST(Record, AMissingColumnNamesTheTimeAsTheFileDoes) {
  const auto cause = [](const Record& record) {
    try {
      (void)record.column("Q");
      return std::string();
    } catch (const InputError& refused) {
      return refused.diagnostics().all().front().cause;
    }
  };
  EXPECT_EQ(cause(parse_record("log.csv", "Zeit;U;Y\n0;1;2\n1;1;2\n")),
            "There is no column Q; the columns are Zeit, U, Y.");
  EXPECT_EQ(cause(parse_record("log.csv", "U,Y\n1,2\n1,2\n", {.rate = 100.0})),
            "There is no column Q; the columns are U, Y.");
  EXPECT_EQ(cause(parse_record("log.csv", "U\n1\n2\n", {.rate = 100.0})),
            "There is no column Q; the only column is U.");
}

TEST(Record, KnowsWhereItsNumbersStand) {
  const auto at = [](const Record& record, std::string_view column, std::size_t row) {
    const Place place = record.place(column, row);
    return std::vector<std::uint32_t>{place.line, place.column, place.length};
  };
  const auto record =
      parse_record("log.csv", "\xEF\xBB\xBF# log\r\nt;u [V];\"y\"\r\n0; 1,5;20\r\n# µ\r\n1;25 ;\"30\"\r\n2;5;6");
  EXPECT_EQ(record.place("u", 0).file, "log.csv");
  EXPECT_THAT(at(record, "U", 0), ElementsAre(3, 4, 3));
  EXPECT_THAT(at(record, "u", 1), ElementsAre(5, 3, 2));
  EXPECT_THAT(at(record, "Y", 1), ElementsAre(5, 8, 2));
  EXPECT_EQ(record.place_of_time(2).line, 6U);
  EXPECT_EQ(record.place_of_time(2).length, 1U);
  EXPECT_THAT(at(record.slice({1, 3}), "y", 1), ElementsAre(6, 5, 1));
  EXPECT_THAT(at(record, "added", 2), ElementsAre(6, 1, 5)) << "the row, where the file has no such column";
  EXPECT_EQ(sample().place("u", 3).line, 0U) << "a record that was not read from a file";
}

TEST(Record, TakesOtherValuesForAColumn) {
  Record record = sample();
  record.replace("u", std::vector<double>(8, 2.0));
  EXPECT_THAT(record.column("U").values, Each(2.0));
  EXPECT_EQ(record.column("U").unit, "V");
  EXPECT_THROW(record.replace("u", {1, 2}), std::invalid_argument);
  EXPECT_THROW(record.replace("z", std::vector<double>(8)), InputError);
}

TEST(Record, RefusesColumnsThatDoNotFit) {
  Record record = sample();
  EXPECT_THROW(record.add({"z", "", {1, 2}}), std::invalid_argument);
  EXPECT_THROW(record.add({"U", "", std::vector<double>(8)}), std::invalid_argument);
  EXPECT_THROW(record.add({"", "", std::vector<double>(8)}), std::invalid_argument);
  EXPECT_THROW((void)Record::even(0.0, 0.0, 3), std::invalid_argument);
  EXPECT_THROW((void)Record::even(0.0, std::numeric_limits<double>::quiet_NaN(), 3), std::invalid_argument);
}

TEST(Record, SlicesAndIntervals) {
  const Record record = sample();
  const Record part = record.slice({2, 5});
  EXPECT_THAT(part.time(), ElementsAre(0.5, 0.75, 1.0));
  EXPECT_THAT(part.column("u").values, ElementsAre(2, 3, 4));
  EXPECT_EQ(part.column("u").unit, "V");
  EXPECT_EQ(part.sample_time(), 0.25);
  EXPECT_THROW((void)record.slice({2, 9}), std::out_of_range);
  EXPECT_THROW((void)record.slice({3, 2}), std::out_of_range);

  const auto range = [&](double begin, double end) {
    const auto rows = record.rows_between(begin, end);
    return std::pair(rows.first, rows.last);
  };
  EXPECT_EQ(range(0.5, 1.0), std::pair(std::size_t{2}, std::size_t{4}));
  EXPECT_EQ(range(0.5000001, 1.0000001), std::pair(std::size_t{2}, std::size_t{4})) << "rounded times";
  EXPECT_EQ(range(-5.0, 99.0), std::pair(std::size_t{0}, std::size_t{8}));
  EXPECT_EQ(record.rows_between(3.0, 2.0).size(), 0U);
  EXPECT_EQ(record.rows_between(0.0, 0.9).size() + record.rows_between(0.9, 9.0).size(), 8U);
}

TEST(CsvWriter, WritesTheShortestNumbers) {
  Record record = Record::even(0.0, 0.1, 3);
  record.add({"u", "V", {1.0, 1e-11, 0.1 + 0.2}});
  EXPECT_EQ(csv_text(record), "t,u [V]\n0,1\n0.1,1e-11\n0.2,0.30000000000000004\n");
}

TEST(CsvWriter, ReadsBackToTheSameBits) {
  std::mt19937_64 random(5);
  const auto finite = [&] {
    while (true) {
      if (const auto value = std::bit_cast<double>(random()); std::isfinite(value)) {
        return value;
      }
    }
  };
  Record record = Record::even(-1.0, 1.0 / 6400.0, 5000);
  for (const auto& [name, unit] : {std::pair("u", "V"), std::pair("flow", "l/min, at 20 °C"), std::pair("a b", "")}) {
    Column column{name, unit, {}};
    for (std::size_t i = 0; i < record.size(); ++i) {
      column.values.push_back(finite());
    }
    record.add(std::move(column));
  }
  const test::ScratchFolder folder;
  write_csv(folder / "out.csv", record);
  const Record read = read_record(folder / "out.csv");
  ASSERT_EQ(read.size(), record.size());
  EXPECT_EQ(read.names(), record.names());
  EXPECT_DOUBLE_EQ(read.sample_time(), record.sample_time());
  for (std::size_t i = 0; i < record.size(); ++i) {
    ASSERT_EQ(read.time()[i], record.time()[i]);
  }
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_EQ(read.columns()[c].unit, record.columns()[c].unit);
    for (std::size_t i = 0; i < record.size(); ++i) {
      ASSERT_EQ(std::bit_cast<std::uint64_t>(read.columns()[c].values[i]),
                std::bit_cast<std::uint64_t>(record.columns()[c].values[i]));
    }
  }
  EXPECT_EQ(csv_text(read), csv_text(record));
}

}  // namespace
}  // namespace hysteron::records
