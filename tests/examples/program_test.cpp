// The programs of the examples: each runs, leaves its records and its picture, and says so where it cannot draw.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "codegen/compile.hpp"
#include "examples/example.hpp"
#include "records/read.hpp"
#include "support/text_file.hpp"
#include "tests/examples/printed.hpp"
#include "tests/examples/programs.hpp"
#include "tests/support/measured_records.hpp"
#include "tests/support/scratch_folder.hpp"

namespace hysteron::examples {
namespace {

using test::contents_of;
using test::ScratchFolder;
using testing::HasSubstr;
using testing::StartsWith;

struct Example {
  const char* program;
  const char* picture;
  std::vector<std::string> records;
};

class ExampleProgram : public testing::TestWithParam<Example> {
 protected:
  /// Runs the example with a compiler on its path and no gnuplot.
  void run_without_gnuplot() const {
    ASSERT_EQ(run("mkdir -p " + folder / "bin" + " && for p in c++ as ld; do ln -s \"$(command -v $p)\" " +
                  folder / "bin/" + "; done"),
              0);
    ASSERT_EQ(run("PATH=" + folder / "bin" + " " + programs + "/" + GetParam().program + " " + folder / "out" + " > " +
                  folder / "printed"),
              0);
  }
  const ScratchFolder folder;
};

TEST_P(ExampleProgram, LeavesRecordsAndPicture) {
  const auto& [program, picture, records] = GetParam();
  ASSERT_EQ(run(programs + "/" + program + " " + folder / "out" + " > " + folder / "printed"), 0);
  for (const std::string& record : records) {
    EXPECT_TRUE(std::filesystem::exists(folder / ("out/" + record))) << record;
  }
  if (run("command -v gnuplot > " + folder / "where") == 0) {
    EXPECT_THAT(contents_of(folder / (std::string("out/") + picture)), StartsWith("\x89PNG"));
  } else {
    EXPECT_THAT(contents_of(folder / "printed"), HasSubstr("No picture: gnuplot is not installed"));
  }
}

TEST_P(ExampleProgram, SaysThatGnuplotIsMissing) {
  run_without_gnuplot();
  EXPECT_THAT(contents_of(folder / "printed"), HasSubstr("No picture: gnuplot is not installed"));
  EXPECT_FALSE(std::filesystem::exists(folder / (std::string("out/") + GetParam().picture)));
}

TEST_P(ExampleProgram, ReadmeShowsWhatItPrints) {
  run_without_gnuplot();
  const std::string printed = contents_of(folder / "printed");
  const std::string name = std::string(GetParam().program).substr(std::string("example_").size());
  expect_readme_shows(name, printed.substr(0, printed.find("No picture")));
}

INSTANTIATE_TEST_SUITE_P(
    All, ExampleProgram,
    testing::Values(
        Example{"example_01_memory_element", "memory_element.png", {"memory_element.csv"}},
        Example{"example_02_procedure_1", "procedure_1.png", {"map.csv", "rounds_weighted.csv"}},
        Example{"example_03_feedforward", "feedforward.png", {"closed_form.csv", "servo_closed.csv", "order.csv"}},
        Example{"example_05_simulated_actuator",
                "simulated_actuator.png",
                {"simulated_identify.csv", "simulated_feedforward.csv"}}),
    [](const auto& example) { return std::string(example.param.program).substr(8); });

/// Those that read measured records: where there is a folder of them, what their pages tell must be what they print.
class MeasuredExample : public test::OnMeasuredRecords<testing::TestWithParam<const char*>> {};

TEST_P(MeasuredExample, ReadmeShowsWhatItPrints) {
  const ScratchFolder folder;
  ASSERT_EQ(run(programs + "/example_" + GetParam() + " " + folder / "out" + " > " + folder / "printed"), 0);
  const std::string printed = contents_of(folder / "printed");
  expect_readme_shows(GetParam(), printed.substr(0, printed.find("Records and pictures")));
}

INSTANTIATE_TEST_SUITE_P(All, MeasuredExample, testing::Values("06_piezo_diagnosis", "07_heater_diagnosis"),
                         [](const auto& example) { return std::string(example.param); });

TEST(ExampleDiagrams, AreInTheLayoutOfTheHouse) {
  std::size_t count = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(HYSTERON_EXAMPLES)) {
    if (entry.path().extension() == ".st") {
      Diagnostics diagnostics;
      const std::string text = read_text_file(entry.path().string());
      EXPECT_TRUE(format_text(entry.path().string(), text, diagnostics) == text)
          << entry.path() << ": run `hysteron fmt` on it";
      EXPECT_FALSE(diagnostics.has_errors());
      ++count;
    }
  }
  EXPECT_GE(count, 6U);
}

class Simulate : public testing::Test {
 protected:
  [[nodiscard]] int simulate(const std::string& words) const {
    return run(programs + "/hysteron-simulate " + words + " > " + folder / "printed" + " 2>&1");
  }
  const ScratchFolder folder;
};

TEST_F(Simulate, IdentifiesAlikeEveryTime) {
  ASSERT_EQ(simulate("identify " + folder / "one.csv"), 0);
  ASSERT_EQ(simulate("identify " + folder / "two.csv"), 0);
  EXPECT_EQ(contents_of(folder / "one.csv"), contents_of(folder / "two.csv"));
  EXPECT_THAT(contents_of(folder / "one.csv"), StartsWith("t,u,y\n0,1.8,"));
  const records::Record record = records::read_record(folder / "one.csv");
  EXPECT_EQ(record.size(), 8001U);
  EXPECT_DOUBLE_EQ(record.sample_time(), 0.005);
}

TEST_F(Simulate, PlaysAnyVoltageAndKeepsTheOtherColumns) {
  ASSERT_EQ(simulate("reference " + folder / "reference.csv"), 0);
  ASSERT_EQ(simulate("play " + folder / "reference.csv" + " " + folder / "played.csv"), 0);
  const records::Record played = records::read_record(folder / "played.csv");
  EXPECT_THAT(played.names(), testing::ElementsAre("ref", "u", "y"));
  EXPECT_EQ(played.size(), 7200U);
  EXPECT_GT(range(column(played, "y")), 30.0);
}

TEST_F(Simulate, RefusesAnotherSampleTimeAndWrongWords) {
  std::string slow = "t,u\n";
  for (int k = 0; k < 10; ++k) {
    slow += std::to_string(0.01 * k) + ",1\n";
  }
  folder.write("slow.csv", slow);
  EXPECT_EQ(simulate("play " + folder / "slow.csv" + " " + folder / "played.csv"), 1);
  EXPECT_THAT(contents_of(folder / "printed"), HasSubstr("the sample time is 0.01 s"));
  EXPECT_EQ(simulate("play " + folder / "missing.csv" + " " + folder / "played.csv"), 1);
  EXPECT_THAT(contents_of(folder / "printed"), HasSubstr("HY100"));
  EXPECT_FALSE(std::filesystem::exists(folder / "played.csv"));
  EXPECT_EQ(simulate("dance"), 2);
  EXPECT_EQ(simulate("--help"), 0);
}

}  // namespace
}  // namespace hysteron::examples
