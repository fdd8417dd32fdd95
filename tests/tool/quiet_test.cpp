// --quiet and output that fits a terminal, as a user runs them.
#include <gmock/gmock.h>

#include <sstream>
#include <string>

#include "support/utf8.hpp"
#include "tests/tool/workbench.hpp"

namespace hysteron {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

struct QuietBench : test::Workbench {
  QuietBench() {
    write("plant.st", test::plant);
    write("log.csv", "t,X,unused\n0,1,3\n0.001,2,3\n0.002,3,4\n");
  }
};

TEST(Quiet, SaysErrorsAndWarningsAlone) {
  const QuietBench bench;
  const std::string run = "hysteron run plant.st --in log.csv --out out.csv --summary";
  const auto loud = bench.shell(run);
  EXPECT_EQ(loud.code, 0) << loud.err;
  EXPECT_NE(loud.out, "");
  const std::string written = bench.read("out.csv");
  const auto quiet = bench.shell(run + " --quiet");
  EXPECT_EQ(quiet.code, 0);
  EXPECT_EQ(quiet.out, "");
  EXPECT_EQ(quiet.err, "");
  EXPECT_EQ(bench.read("out.csv"), written);
  const auto refused = bench.shell("hysteron run none.st --in log.csv --out out.csv --quiet");
  EXPECT_EQ(refused.code, 2);
  EXPECT_THAT(refused.err, HasSubstr("HY100"));
}

TEST(Quiet, LeavesWhatIsTheResultItself) {
  const QuietBench bench;
  EXPECT_EQ(bench.shell("hysteron run plant.st --in log.csv --out - --quiet").out,
            bench.shell("hysteron run plant.st --in log.csv --out -").out);
  for (const char* const command : {"explain HY402", "blocks HY_LAG", "blocks --json", "record log.csv"}) {
    const auto loud = bench.shell(std::string("hysteron ") + command);
    EXPECT_NE(loud.out, "") << command;
    EXPECT_EQ(bench.shell(std::string("hysteron ") + command + " --quiet").out, loud.out) << command;
  }
}

/// The help of a command says what --quiet does there.
TEST(Quiet, HelpSaysWhetherResultsStay) {
  const QuietBench bench;
  for (const char* const command : {"check", "record", "compare", "map", "doctor", "blocks", "test"}) {
    const std::string help = bench.shell(std::string("hysteron help ") + command).out;
    EXPECT_THAT(help, HasSubstr("No notes, no progress; results are printed all the same.")) << command;
  }
  for (const char* const command : {"run", "tune", "draw", "export"}) {
    const std::string help = bench.shell(std::string("hysteron help ") + command).out;
    EXPECT_THAT(help, HasSubstr("Says errors and warnings alone: no report, no notes, no progress.")) << command;
  }
  EXPECT_NE(bench.shell("hysteron check plant.st --quiet").out, "");
}

TEST(Width, HelpAndErrorsFitTheTerminal) {
  const QuietBench bench;
  for (const char* const command : {"help tune", "help run", "help", "run plan.st --in log.csv --out out.csv"}) {
    const auto done = bench.shell(std::string("COLUMNS=72 hysteron ") + command);
    std::istringstream lines(done.out + done.err);
    std::string line;
    std::size_t count = 0;
    while (std::getline(lines, line)) {
      // Examples are commands and tables: they stay as they are.
      if (line.find("   ") == std::string::npos && !line.starts_with("  hysteron")) {
        EXPECT_LE(character_count(line), 72U) << line;
      }
      ++count;
    }
    EXPECT_GT(count, 1U) << command;
  }
  const auto wide = bench.shell("hysteron help tune").out;
  const auto narrow = bench.shell("COLUMNS=72 hysteron help tune").out;
  EXPECT_NE(wide, narrow);
  std::istringstream a(wide);
  std::istringstream b(narrow);
  std::string one;
  std::string other;
  while (a >> one) {
    ASSERT_TRUE(b >> other);
    ASSERT_EQ(one, other) << "every word is there";
  }
}

/// What a reader sees of a narrow window: no line of words is longer. A command to be copied stays whole.
TEST(Width, FindingsAndHelpFitANarrowTerminal) {
  const QuietBench bench;
  for (const char* const command :
       {"help tune", "help export", "help doctor", "check wrong.st", "doctor --rt --seconds 0.01", "explain HY402",
        "blocks HY_LAG", "blocks HY_HYSTERESIS_RO", "record log.csv"}) {
    const auto done =
        bench.shell(std::string("printf 'FUNCTION_BLOCK W\nVAR_OUTPUT Y : LREAL; END_VAR\nY := NOWHERE_DECLARED;\n"
                                "END_FUNCTION_BLOCK\n' > wrong.st; COLUMNS=40 hysteron ") +
                    command);
    std::istringstream lines(done.out + done.err);
    std::string line;
    std::size_t count = 0;
    while (std::getline(lines, line)) {
      const auto first = line.find_first_not_of(" 0123456789");
      const std::string text = first == std::string::npos ? std::string() : line.substr(first);
      const bool is_one_word = text.find(' ') == std::string::npos;
      if (!text.starts_with("|") && !text.starts_with("$") && !is_one_word) {
        EXPECT_LE(character_count(line), 40U) << command << ": " << line;
      }
      ++count;
    }
    EXPECT_GT(count, 3U) << command;
  }
}

TEST(Width, WhatAProgramReadsIsNotBroken) {
  const QuietBench bench;
  EXPECT_EQ(bench.shell("COLUMNS=30 hysteron blocks HY_LAG --json").out,
            bench.shell("hysteron blocks HY_LAG --json").out);
}

}  // namespace
}  // namespace hysteron
