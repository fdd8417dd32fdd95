// The command line as a whole: help, version, and what is said of slips.
#include <gmock/gmock.h>

#include <string>
#include <utility>
#include <vector>

#include "tests/tool/workbench.hpp"

namespace hysteron {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

TEST(CommandLine, VersionAndHelp) {
  const test::Workbench bench;
  const auto version = bench.shell("hysteron --version");
  EXPECT_EQ(version.code, 0);
  EXPECT_THAT(version.out, testing::MatchesRegex("hysteron [0-9]+\\.[0-9]+\\.[0-9]+\n"));
  const auto help = bench.shell("hysteron help");
  EXPECT_EQ(help.code, 0);
  EXPECT_EQ(help.out, bench.shell("hysteron --help").out);
  for (const char* const command : {"check", "fmt", "run", "tune", "generate", "test", "blocks"}) {
    EXPECT_THAT(help.out, HasSubstr(std::string("\n  ") + command + " "));
    const auto own = bench.shell(std::string("hysteron ") + command + " --help");
    EXPECT_EQ(own.code, 0);
    EXPECT_THAT(own.out, HasSubstr("Examples:\n  hysteron " + std::string(command)));
    EXPECT_EQ(own.err, "");
    EXPECT_EQ(own.out, bench.shell(std::string("hysteron help ") + command).out);
  }
}

TEST(CommandLine, SlipsAreExplained) {
  const test::Workbench bench;
  const auto refused = [&](const std::string& line) {
    const auto outcome = bench.shell(line);
    EXPECT_EQ(outcome.code, 2) << line;
    EXPECT_EQ(outcome.out, "") << line;
    return outcome.err;
  };
  EXPECT_EQ(refused("hysteron chekc plant.st"),
            "HY730 error: There is no command chekc.\nmend: did you mean check?\n\n1 error\n");
  EXPECT_THAT(refused("hysteron"), HasSubstr("No command is given."));
  EXPECT_THAT(refused("hysteron xyzzy"),
              HasSubstr("the commands are new, check, fmt, draw, record, plot, compare, run, "));
  EXPECT_EQ(refused("hysteron run plant.st --in a.csv --out b.csv --parms p.toml"),
            "HY730 error: hysteron run has no option --parms.\nmend: did you mean --params?\n\n1 error\n");
  EXPECT_THAT(refused("hysteron run plant.st --in a.csv"), AllOf(HasSubstr("--out"), HasSubstr("hysteron run --help")));
  EXPECT_THAT(refused("hysteron run plant.st --in a.csv --out"), HasSubstr("hysteron run: --out needs a value."));
  EXPECT_THAT(refused("hysteron generate plant.st --target ada --out g"), HasSubstr("There is no target ada."));
  EXPECT_THAT(refused("hysteron check"), HasSubstr("FILE"));
  EXPECT_THAT(refused("hysteron blocks HY_LAG HY_GAIN"), HasSubstr("ask for one at a time: `hysteron blocks HY_LAG`"));
}

/// An empty value is most often a variable of the shell that is not set: no command goes on as if the option were not
/// there, and none writes into the current folder instead.
TEST(CommandLine, WhatIsMissingIsExplainedAndAMisspeltOptionIsToldFirst) {
  const test::Workbench bench;
  bench.write("plant.st", "");
  EXPECT_EQ(bench.shell("hysteron run plant.st --inn log.csv").err,
            "HY730 error: hysteron run has no option --inn.\nmend: did you mean --in?\n\n1 error\n");
  EXPECT_THAT(bench.shell("hysteron run plant.st").err,
              AllOf(HasSubstr("--in is required."), HasSubstr("give --in LOG.csv: The record that drives the inputs")));
  EXPECT_THAT(bench.shell("hysteron check").err,
              AllOf(HasSubstr("FILE is required."), HasSubstr("give FILE: Diagrams")));
}

TEST(CommandLine, EmptyValuesAreRefused) {
  const test::Workbench bench;
  bench.write("plant.st", test::plant);
  bench.write("log.csv", test::plant_log);
  bench.write("p.toml", "[parameters.AMP]\nK = 1.0\n[fit.AMP]\nK = {}\n");
  bench.write("plant.test.toml", "[[case]]\nname = \"a\"\nsteps = 1\nexpect = {BUSY = 0}\n");
  const auto before = bench.names();
  const std::string tune = "hysteron tune plant.st --log log.csv --params p.toml ";
  const std::string diagnose = "hysteron diagnose plant.st --log log.csv --params p.toml ";
  for (const auto& [line, option] : std::vector<std::pair<std::string, std::string>>{
           {"hysteron run plant.st --in log.csv --out out.csv --params \"$UNSET\"", "--params"},
           {"hysteron run plant.st --in log.csv --out out.csv --params=\"$UNSET\"", "--params"},
           {"hysteron run plant.st --in log.csv --out out.csv --top ''", "--top"},
           {"hysteron run plant.st --in log.csv --out out.csv --trace ''", "--trace"},
           {"hysteron run plant.st --in log.csv --out ''", "--out"},
           {"hysteron run plant.st --in '' --out out.csv", "--in"},
           {"hysteron generate plant.st --target cpp --out ''", "--out"},
           {tune + "--out ''", "--out"},
           {tune + "--out tuned.toml --report ''", "--report"},
           {diagnose + "--out ''", "--out"},
           {diagnose + "--out found --effects ''", "--effects"},
           {diagnose + "--out found --controller ''", "--controller"},
           {"hysteron test plant.st --junit ''", "--junit"},
           {"hysteron test plant.st --filter ''", "--filter"},
           {"hysteron map plant.st --config ''", "--config"},
           {"hysteron map plant.st --format ''", "--format"},
           {"hysteron serve plant.st --config RUN.toml --engine ''", "--engine"},
           {"hysteron replay plant.st --trace run.trace --out ''", "--out"}}) {
    const auto outcome = bench.shell(line);
    EXPECT_EQ(outcome.code, 2) << line;
    EXPECT_EQ(outcome.out, "") << line;
    EXPECT_THAT(outcome.err,
                AllOf(StartsWith("HY730 error: hysteron "), HasSubstr(": the value of " + option + " is empty.\n")))
        << line;
  }
  for (const std::string line : {"check ''", "blocks ''", "blocks --json ''", "fmt plant.st ''", "test ''"}) {
    const auto outcome = bench.shell("hysteron " + line);
    EXPECT_EQ(outcome.code, 2) << line;
    EXPECT_THAT(outcome.err, HasSubstr(": an argument is empty.\n")) << line;
  }
  EXPECT_EQ(bench.names(), before);
}

/// `run` takes it for the standard output; elsewhere it would be the name of a file.
TEST(CommandLine, ADashIsNoNameOfAFile) {
  const test::Workbench bench;
  for (const std::string line :
       {"export axis.st --out -", "import drawing.xml --out -", "generate axis.st --out - --target c", "man --out -",
        "tune p.st --log log.csv --params p.toml --out tuned.toml --report -"}) {
    const auto outcome = bench.shell("hysteron " + line);
    EXPECT_EQ(outcome.code, 2) << line;
    EXPECT_THAT(outcome.err, AllOf(StartsWith("HY730 error: hysteron "), HasSubstr(" takes no -,"))) << line;
  }
  EXPECT_EQ(bench.shell("test -e ./-").code, 1);
}

TEST(CommandLine, AnOptionGivenTwiceIsSaidToBe) {
  const test::Workbench bench;
  const auto outcome = bench.shell("hysteron run plant.st --in a.csv --in b.csv --out out.csv");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, StartsWith("HY730 error: hysteron run: --in is given more than once.\nmend: give it once"));
}

/// The limits of a number are told as a person would, and held.
TEST(CommandLine, NumbersOutOfTheirLimits) {
  const test::Workbench bench;
  const std::string diagnose = "hysteron diagnose plant.st --log log.csv --params p.toml --out found ";
  const std::string serve = "hysteron serve plant.st --config RUN.toml --virtual ";
  for (const auto& [line, said] : std::vector<std::pair<std::string, std::string>>{
           {diagnose + "--effort -1", "--effort: a number above 0 is needed, not -1."},
           {diagnose + "--time-limit nan", "--time-limit: a number above 0 is needed, not nan."},
           {"hysteron online-change RUN.toml --load nan", "--load: a number from 0.001 to 1 is needed, not nan."},
           {"hysteron online-change RUN.toml --load 2", "--load: a number from 0.001 to 1 is needed, not 2."},
           {"hysteron fleet set --out out --time-limit nan", "--time-limit: a number from 0.001 to 1000000 is needed"},
           {"hysteron fleet-report out --out o --false-share nan",
            "--false-share: a number from 1e-6 to 0.5 is needed"},
           {diagnose + "--material -3", "--material: a number from 0 on is needed, not -3."},
           {diagnose + "--seed -1", "--seed: a whole number from 0 on is needed, not -1."},
           {serve + "--cycles -1", "--cycles: a whole number from 1 on is needed, not -1."},
           {serve + "--cycles 0", "--cycles: a whole number from 1 on is needed, not 0."},
           {serve + "--cycles 1e3", "--cycles: a whole number from 1 on is needed, not 1e3."}}) {
    const auto outcome = bench.shell(line);
    EXPECT_EQ(outcome.code, 2) << line;
    EXPECT_THAT(outcome.err, AllOf(StartsWith("HY730 error: "), HasSubstr(said))) << line;
  }
}

TEST(CommandLine, FilesThatAreNotThere) {
  const test::Workbench bench;
  bench.write("plant.st", test::plant);
  const auto outcome = bench.shell("hysteron check plnat.st");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.out, AllOf(StartsWith("HY100 error: plnat.st: "), HasSubstr("did you mean plant.st?")));
  const auto run = bench.shell("hysteron run plnat.st --in log.csv --out out.csv");
  EXPECT_EQ(run.code, 2);
  EXPECT_EQ(run.err, outcome.out);
}

/// It had written the file, and then told what is wrong with it: 1m is a time of a PLC, and no @ts.
TEST(CommandLine, AnImportWithoutASampleTimeWritesNothing) {
  const test::Workbench bench;
  bench.write("drawing.xml", "<project/>");
  for (const std::string time : {"0ms", "-1ms", "soon", "1m", "1s500ms", "0.5ns"}) {
    const auto outcome = bench.shell("hysteron import drawing.xml --ts " + time + " --out made.st");
    EXPECT_EQ(outcome.code, 2);
    EXPECT_THAT(outcome.err, HasSubstr(time + " is no sample time.")) << outcome.err;
    EXPECT_FALSE(bench.has("made.st"));
  }
}

TEST(CommandLine, AClosedPipeIsNoCrash) {
  const test::Workbench bench;
  const auto outcome = bench.shell("(hysteron blocks --markdown; echo $? > code) | head -n 1; cat code");
  EXPECT_EQ(outcome.out, "# The blocks\n0\n");
  EXPECT_EQ(outcome.err, "");
}

TEST(CommandLine, AFullDiskIsAnError) {
  const test::Workbench bench;
  const auto outcome = bench.shell("hysteron blocks > /dev/full");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("HY700 error: The results cannot be written: No space left on device."));
}

TEST(CommandLine, NoColourWithoutATerminal) {
  const test::Workbench bench;
  bench.write("plant.st", "FUNCTION_BLOCK P END_FUNCTION_BLOK");
  const auto outcome = bench.shell("TERM=xterm-256color hysteron check plant.st");
  EXPECT_EQ(outcome.code, 1);
  EXPECT_EQ(outcome.out.find('\033'), std::string::npos);
}

}  // namespace
}  // namespace hysteron
