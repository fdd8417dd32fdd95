// Every measured record that is at hand loads, with the rows, the sample time and the values its folder states.
#include <gmock/gmock.h>

#include <cstdlib>
#include <string>

#include "records/data_folder.hpp"
#include "records/read.hpp"
#include "support/diagnostic.hpp"
#include "tests/support/scratch_folder.hpp"

namespace hysteron::records {
namespace {

namespace fs = std::filesystem;

TEST(MeasuredRecords, AllLoad) {
  const auto folder = data_folder(HYSTERON_SOURCE_DIR);
  if (!folder) {
    GTEST_SKIP() << "no measured records on this machine";
  }
  std::size_t read = 0;
  for (const auto& entry : fs::recursive_directory_iterator(*folder)) {
    const auto within = fs::relative(entry.path(), *folder);
    // Shapes of logs are to be read or refused one by one, and raw ones have the uneven times of their logger (HY507).
    const bool other = *within.begin() == "log-shapes" || within.filename().string().starts_with("raw_");
    if (entry.path().extension() == ".csv" && !other) {
      SCOPED_TRACE(entry.path());
      EXPECT_GT(read_record(entry.path().string()).size(), *within.begin() == "machines" ? 100U : 1000U);
      ++read;
    }
  }
  EXPECT_GT(read, 0U);
}

TEST(MeasuredRecords, HaveTheStatedRowsAndSampleTimes) {
  const auto folder = data_folder(HYSTERON_SOURCE_DIR);
  if (!folder) {
    GTEST_SKIP() << "no measured records on this machine";
  }
  struct Stated {
    const char* name;
    std::size_t rows;
    double sample_time;
  };
  for (const auto& [name, rows, sample_time] : {Stated{"piezo-picma-dbo/identify_1hz.csv", 8027, 0.005},
                                                {"piezo-picma-dbo/feedforward_test.csv", 14155, 0.005},
                                                {"piezo-fsm-cubespec/test_200mV_r1.csv", 16384, 1.0 / 6400.0},
                                                {"tclab-thermal/prbs_open_loop.csv", 7140, 1.0},
                                                {"silverbox/snls80mv.csv", 131072, 16384e-7},
                                                {"cascaded-tanks/tanks_val.csv", 1024, 4.0}}) {
    const auto path = find_record(name, HYSTERON_SOURCE_DIR);
    ASSERT_TRUE(path) << "the folder of measured records lacks " << name;
    const Record record = read_record(path->string());
    EXPECT_EQ(record.size(), rows) << name;
    EXPECT_EQ(record.sample_time(), sample_time) << name;
  }
  const Record first = read_record(find_record("piezo-picma-dbo/identify_1hz.csv", HYSTERON_SOURCE_DIR)->string());
  EXPECT_EQ(first.column("Y").values.front(), -123.059139);
  EXPECT_EQ(first.column("U").values.back(), 3.112144);
}

TEST(DataFolder, TheEnvironmentVariableComesFirst) {
  const char* const before = std::getenv("HYSTERON_DATA");
  const std::string saved = before != nullptr ? before : "";
  const test::ScratchFolder folder;
  folder.write("a.csv", "t,u\n0,1\n1,2\n");
  setenv("HYSTERON_DATA", folder.path().c_str(), 1);
  EXPECT_EQ(data_folder(), folder.path());
  EXPECT_EQ(find_record("a.csv"), folder.path() / "a.csv");
  EXPECT_EQ(find_record("b.csv"), std::nullopt);
  setenv("HYSTERON_DATA", (folder / "mistyped").c_str(), 1);
  EXPECT_THROW((void)data_folder(), InputError);
  unsetenv("HYSTERON_DATA");
  fs::create_directories(folder / "shared/data");
  fs::create_directories(folder / "checkout");
  const auto current = fs::current_path();
  fs::current_path(folder / "checkout");
  EXPECT_EQ(data_folder(), fs::canonical(folder.path()) / "shared/data");
  fs::create_directories(folder / "elsewhere/within");  // where no folder beside has data, as the root could
  fs::current_path(folder / "elsewhere/within");
  EXPECT_EQ(data_folder(folder.path() / "checkout"), folder.path() / "shared/data");
  fs::current_path(current);
  if (!saved.empty()) {
    setenv("HYSTERON_DATA", saved.c_str(), 1);
  }
}

}  // namespace
}  // namespace hysteron::records
