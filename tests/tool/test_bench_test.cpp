// Block tests as Structured Text: the bench is read back and run, and compiled by MATIEC where HYSTERON_MATIEC names
// its folder. What it says of each test is what `hysteron test` says.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cstdlib>
#include <filesystem>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "tests/tool/workbench.hpp"

namespace hysteron {
namespace {

using testing::AllOf;
using testing::HasSubstr;

namespace fs = std::filesystem;

constexpr std::string_view benched_cases = R"toml([[case]]
name = "a constant is (* integrated *)"
inputs = {X = 1.0}
expect = {Y = [0.002, 0.004, 0.006], BUSY = true}

[[case]]
name = "a step, with another gain"
params = {AMP = {K = 5.0}}
steps = 100
inputs = {x = {0 = 0.0, 50 = 1.0}, RESET = {0 = false, 99 = true}}
expect = {y = {0 = 0.0, 49 = 0.0, 50 = 0.005, 98 = 0.245, 99 = 0.0}, busy = {98 = true, 99 = false}}

[[case]]
name = "a ramp in 32 bits"
float32 = true
steps = 5
inputs = {X = {from = 0.0, to = 4.0}}
expect = {Y = [0.0, 0.002, 0.006, 0.012, 0.02]}

[[case]]
name = "a record, by the gain of the diagram again"
csv = "log.csv"
golden = "gold.csv"

[[case]]
name = "a long ramp, and its sums"
steps = 41
inputs = {X = {from = 0.0, to = 4.0}}
expect = {Y = {0 = 0.0, 1 = 2e-4, 2 = 6e-4, 3 = 1.2e-3, 4 = 2e-3, 5 = 3e-3, 6 = 4.2e-3, 7 = 5.6e-3, 8 = 7.2e-3, 9 = 9e-3, 10 = 1.1e-2, 11 = 1.32e-2, 12 = 1.56e-2, 13 = 1.82e-2, 14 = 2.1e-2, 15 = 2.4e-2, 39 = 0.156, 40 = 0.164}}
)toml";

/// The last row of a record, by the names of its columns.
std::map<std::string, double> last_row(const std::string& csv) {
  std::istringstream lines(csv);
  std::string head;
  std::getline(lines, head);
  std::string last;
  for (std::string line; std::getline(lines, line);) {
    last = line;
  }
  std::istringstream names(head);
  std::istringstream cells(last);
  std::map<std::string, double> row;
  for (std::string name, cell; std::getline(names, name, ',') && std::getline(cells, cell, ',');) {
    row[name] = std::strtod(cell.c_str(), nullptr);
  }
  row.erase("t");
  return row;
}

class BenchOfTests : public testing::Test {
 protected:
  BenchOfTests() {
    bench.write("plant.st", test::plant);
    bench.write("log.csv", test::plant_log);
  }

  /// Writes the bench, and what else comes to be told.
  test::Outcome make(const std::string& toml, const std::string& options = "") {
    bench.write("plant.test.toml", toml);
    return bench.shell("hysteron test plant.st --no-generated --bench plc" + options);
  }

  /// The bench read back by the tool: the blocks, without the program that calls them.
  std::map<std::string, double> read_back(std::size_t steps) {
    const std::string text = bench.read("plc/plant_test.st");
    bench.write("back.st", text.substr(0, text.find("(* Runs PLANT_TEST")));
    std::string rows = "t,restart\n";
    for (std::size_t k = 0; k < steps; ++k) {
      rows += fmt::format("{},0\n", 0.001 * static_cast<double>(k));
    }
    bench.write("rows.csv", rows);
    const auto outcome = bench.shell("hysteron run back.st --top PLANT_TEST --in rows.csv --out results.csv");
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return last_row(bench.read("results.csv"));
  }

  test::Workbench bench;
};

TEST_F(BenchOfTests, ReadBackPassesWhatTheToolPasses) {
  ASSERT_EQ(make(std::string(benched_cases), " --filter record --update").code, 0);
  const auto outcome = make(std::string(benched_cases));
  ASSERT_EQ(outcome.code, 0) << outcome.out << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("plc/plant_test.st\n5 passed, 0 failed\n"));
  constexpr std::size_t steps = 3 + 100 + 5 + 4 + 41;
  const auto before = read_back(steps - 1);
  EXPECT_EQ(before.at("DONE"), 0.0);
  const auto row = read_back(steps);
  EXPECT_EQ(row.at("DONE"), 1.0);
  EXPECT_EQ(row.at("PASSED"), 1.0) << row.at("FAILED_TEST") << " " << row.at("FAILED_STEP") << " " << row.at("GOT");
  EXPECT_EQ(row.at("VALUES_COMPARED"), 2 * 3 + 7 + 5 + 2 * 4 + 18);
  EXPECT_EQ(row.at("VALUES_FAILED"), 0.0);
  EXPECT_EQ(row.at("TEST_NUMBER"), 5.0);
  EXPECT_EQ(read_back(steps + 7), row) << "it stands still when it is done";
}

TEST_F(BenchOfTests, AWrongExpectationIsToldWithItsStepExpectedAndGot) {
  const auto outcome = make(R"([[case]]
name = "right"
steps = 2
inputs = {X = 1.0}
expect = {Y = {1 = 0.004}}

[[case]]
name = "wrong in the second output, then in the first"
steps = 8
inputs = {X = 1.0}
expect = {Y = [0.002, 0.004, 0.006, 0.008, 0.012, 0.012, 0.014, 0.016], BUSY = {3 = false}}
)");
  EXPECT_EQ(outcome.code, 1) << "the tool finds the same";
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("Y at step 4 (t = 0.004 s): expected 0.012, got 0.01,"),
                                 HasSubstr("BUSY at step 3 (t = 0.003 s): expected FALSE, got TRUE")));
  const auto row = read_back(10);
  EXPECT_EQ(row.at("DONE"), 1.0);
  EXPECT_EQ(row.at("PASSED"), 0.0);
  EXPECT_EQ(row.at("TESTS_FAILED"), 1.0);
  EXPECT_EQ(row.at("VALUES_FAILED"), 2.0);
  EXPECT_EQ(row.at("VALUES_COMPARED"), 1 + 8 + 1);
  EXPECT_EQ(row.at("FAILED_TEST"), 2.0);
  EXPECT_EQ(row.at("FAILED_STEP"), 3.0);
  EXPECT_EQ(row.at("FAILED_OUTPUT"), 2.0);
  EXPECT_EQ(row.at("EXPECTED"), 0.0);
  EXPECT_EQ(row.at("GOT"), 1.0);
  EXPECT_EQ(row.at("NOT_FINITE"), 0.0);
}

TEST_F(BenchOfTests, TolerancesAreThoseOfTheCase) {
  for (const auto& [tolerance, failed] :
       {std::pair{"", 1.0}, {"abs = 1.1e-4", 0.0}, {"abs = 0.9e-4", 1.0}, {"rel = 0.05", 0.0}, {"rel = 0.04", 1.0}}) {
    const auto outcome = make(fmt::format(
        "[[case]]\nname = \"n\"\nsteps = 1\ninputs = {{X = 1.0}}\nexpect = {{Y = 0.0021}}\n{}\n", tolerance));
    EXPECT_EQ(outcome.code, failed) << tolerance;
    const auto row = read_back(2);
    EXPECT_EQ(row.at("VALUES_FAILED"), failed) << tolerance;
    if (failed > 0.0) {
      EXPECT_EQ(row.at("EXPECTED"), 0.0021);
      EXPECT_EQ(row.at("GOT"), 0.002);
    }
  }
}

TEST_F(BenchOfTests, AnOutputThatIsNoNumberFailsWhereNothingIsExpected) {
  bench.write(
      "plant.st",
      "FUNCTION_BLOCK PLANT (* @ts 1ms *) VAR_INPUT X : LREAL; END_VAR VAR_OUTPUT Y : LREAL; Z : LREAL; END_VAR\n"
      "Y := X; Z := EXP(X); END_FUNCTION_BLOCK\n");
  const auto outcome =
      make("[[case]]\nname = \"n\"\nsteps = 3\ninputs = {X = [0.0, 1.0, 800.0]}\nexpect = {Y = {0 = 0.0}}\n");
  EXPECT_EQ(outcome.code, 1);
  const std::string text = bench.read("plc/plant_test.st");
  EXPECT_EQ(bench.shell("hysteron check plc/plant_test.st").code, 1) << "a PROGRAM is none of ours";
  bench.write("back.st", text.substr(0, text.find("(* Runs PLANT_TEST")));
  bench.write("rows.csv", "t,restart\n0,0\n0.001,0\n0.002,0\n");
  const auto run = bench.shell("hysteron run back.st --top PLANT_TEST --in rows.csv --out results.csv");
  EXPECT_EQ(run.code, 1) << "GOT is infinite, and run says so";
  const auto row = last_row(bench.read("results.csv"));
  EXPECT_EQ(row.at("NOT_FINITE"), 1.0);
  EXPECT_EQ(row.at("FAILED_OUTPUT"), 2.0);
  EXPECT_EQ(row.at("FAILED_STEP"), 2.0);
}

TEST_F(BenchOfTests, WhatHasNoLiteralIsRefusedByName) {
  const std::string toml = "[[case]]\nname = \"tiny\"\nsteps = 1\ninputs = {X = 1e-300}\nexpect = {Y = 1e-300}\n";
  const auto outcome = make(toml);
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("HY728"), HasSubstr("\"tiny\": the input X is 1e-300"),
                                 HasSubstr("what is expected of Y is 1e-300"), HasSubstr("portable")));
  EXPECT_FALSE(bench.has("plc"));
  EXPECT_EQ(make(toml, " --dialect codesys").code, 0);
}

TEST_F(BenchOfTests, DialectsHaveTheFilesThatTheirEditorsTake) {
  const std::string toml = "[[case]]\nname = \"n\"\nsteps = 1\ninputs = {X = 1.0}\nexpect = {Y = 0.002}\n";
  EXPECT_THAT(make(toml, " --dialect twincat").out, HasSubstr("plc/plant_test.TcPOU\nplc/plant.TcPOU\n"));
  EXPECT_THAT(bench.read("plc/plant_test.TcPOU"), HasSubstr("PLANT_1 : PLANT;"));
  EXPECT_THAT(make(toml, " --dialect siemens-scl").out, HasSubstr("plc/plant_test.scl\n"));
  EXPECT_THAT(bench.read("plc/plant_test.scl"),
              AllOf(HasSubstr("FUNCTION_BLOCK \"PLANT\""), HasSubstr("PLANT_1 : \"PLANT\";"),
                    HasSubstr("#PLANT_1(X := #PLANT_X, RESET := #PLANT_RESET, RESET_ALL := #TEST_STEP = 0);")));
  EXPECT_EQ(make(toml, " --dialect of-mars").code, 2);
  EXPECT_EQ(bench.shell("hysteron test plant.st --no-generated --dialect codesys").code, 2);
}

TEST_F(BenchOfTests, AFileOfSomeoneElseIsKept) {
  const std::string toml = "[[case]]\nname = \"n\"\nsteps = 1\ninputs = {X = 1.0}\nexpect = {Y = 0.002}\n";
  bench.write("plc/plant_test.st", "(* mine *)\n");
  EXPECT_THAT(make(toml).err, HasSubstr("HY731"));
  EXPECT_EQ(bench.read("plc/plant_test.st"), "(* mine *)\n");
}

// ---- through MATIEC -------------------------------------------------------------------------------------------------

constexpr std::string_view bench_host = R"(#include <stdio.h>
#include "iec_std_lib.h"
#include "accessor.h"
#include "POUS.h"
TIME __CURRENT_TIME;
BOOL __DEBUG;
#include "POUS.c"
int main(void) {{
  static {0}_PROGRAM one;
  {0}_PROGRAM_init__(&one, 0);
  for (long k = 0; k < 1000000 && !one.DONE.value; ++k) {{
    {0}_PROGRAM_body__(&one);
  }}
  printf("%d %d %d %d %d %d %d %d %.17g %.17g\n", one.DONE.value, one.PASSED.value, (int)one.TESTS_FAILED.value,
         (int)one.VALUES_COMPARED.value, (int)one.VALUES_FAILED.value, (int)one.FAILED_TEST.value,
         (int)one.FAILED_STEP.value, (int)one.FAILED_OUTPUT.value, one.EXPECTED.value, one.GOT.value);
  return 0;
}}
)";

/// What the program of a bench leaves, by MATIEC and the system's C compiler; empty where they refuse it.
std::string through_matiec(const test::Workbench& bench, const std::string& file, const std::string& name) {
  bench.write("host.c", fmt::format(bench_host, name));
  const std::string matiec = std::getenv("HYSTERON_MATIEC");
  const auto outcome = bench.shell(fmt::format(
      "{0}/iec2c -I {0}/lib -T . {1} > log 2>&1 && cc -O0 -w -fwrapv -ffp-contract=off -frounding-math -I{0}/lib/C -I. "
      "host.c -lm -o bench_host >> log 2>&1 && ./bench_host",
      matiec, file));
  EXPECT_EQ(outcome.code, 0) << file << ": " << bench.read("log").substr(0, 2000);
  return outcome.out;
}

TEST_F(BenchOfTests, ThroughMatiec) {
  if (std::getenv("HYSTERON_MATIEC") == nullptr) {
    GTEST_SKIP() << "HYSTERON_MATIEC names no folder of MATIEC";
  }
  ASSERT_EQ(make(std::string(benched_cases), " --filter record --update").code, 0);
  ASSERT_EQ(make(std::string(benched_cases)).code, 0);
  EXPECT_EQ(through_matiec(bench, "plc/plant_test.st", "PLANT_TEST"), "1 1 0 44 0 0 0 0 0 0\n");
  ASSERT_EQ(
      make("[[case]]\nname = \"wrong\"\nsteps = 4\ninputs = {X = 1.0}\nexpect = {Y = {1 = 0.004, 3 = 0.5}}\n").code, 1);
  EXPECT_EQ(through_matiec(bench, "plc/plant_test.st", "PLANT_TEST"),
            fmt::format("1 0 1 2 1 1 3 1 {:.17g} {:.17g}\n", 0.5, 0.008));
}

/// Every test of the library: some thousands of values, in all types.
TEST_F(BenchOfTests, ThroughMatiecAllTestsOfTheLibraryPass) {
  if (std::getenv("HYSTERON_MATIEC") == nullptr) {
    GTEST_SKIP() << "HYSTERON_MATIEC names no folder of MATIEC";
  }
  std::size_t values = 0;
  for (const auto& entry : fs::directory_iterator(fs::path(HYSTERON_SOURCE_DIR) / "tests" / "library")) {
    if (entry.path().extension() != ".st") {
      continue;
    }
    const std::string stem = entry.path().stem().string();
    const auto outcome = bench.shell(fmt::format("hysteron test {} --no-generated --bench plc", entry.path().string()));
    ASSERT_EQ(outcome.code, 0) << outcome.out << outcome.err;
    std::string name;
    for (const char letter : stem + "_TEST") {
      name += static_cast<char>(std::toupper(letter));
    }
    std::istringstream told(through_matiec(bench, fmt::format("plc/{}_test.st", stem), name));
    std::size_t done = 0;
    std::size_t passed = 0;
    std::size_t failed = 0;
    std::size_t compared = 0;
    told >> done >> passed >> failed >> compared;
    EXPECT_TRUE(done == 1 && passed == 1) << stem << ": " << told.str();
    EXPECT_GT(compared, 0U) << stem;
    values += compared;
  }
  std::printf("MATIEC, tests of the library on the bench: %zu values compared\n", values);
}

}  // namespace
}  // namespace hysteron
