// hysteron test: the tests that users write beside their diagrams.
#include <gmock/gmock.h>

#include <string>

#include "tests/tool/workbench.hpp"

namespace hysteron {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

class UserTests : public testing::Test {
 protected:
  UserTests() { bench.write("plant.st", test::plant); }

  test::Outcome run(const std::string& toml, const std::string& options = " --no-generated") {
    bench.write("plant.test.toml", toml);
    return bench.shell("hysteron test plant.st" + options);
  }

  /// The message about a test file that is refused.
  std::string refusal(const std::string& toml) {
    const auto outcome = run(toml);
    EXPECT_EQ(outcome.code, 2) << toml << outcome.out;
    return outcome.err;
  }

  test::Workbench bench;
};

constexpr std::string_view cases = R"([[case]]
name = "a constant is integrated"
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
name = "a record"
csv = "logs/log.csv"
params = "p.toml"
steps = 3
expect = {Y = {0 = 1.0, 1 = 2.0, 2 = 0.0}}
)";

TEST_F(UserTests, WhatTheDiagramLacksIsToldOnceForAllItsCases) {
  bench.write("plant.st",
              "FUNCTION_BLOCK F\nVAR_INPUT X : LREAL; END_VAR\nVAR_OUTPUT Y : LREAL; END_VAR\n"
              "VAR D : HY_DELAY; END_VAR\nD(XIN := X);\nY := D.XOUT;\nEND_FUNCTION_BLOCK\n");
  const auto named = [](const std::string& name) {
    return "[[case]]\nname = \"" + name + "\"\nsteps = 1\ninputs = {X = 1.0}\nexpect = {Y = 0.0}\n";
  };
  EXPECT_THAT(refusal(named("a") + named("b")), AllOf(HasSubstr("HY404"), HasSubstr("\n1 error\n")));
}

TEST_F(UserTests, PassOnTheInterpreterAndOnGeneratedCode) {
  bench.write("logs/log.csv", test::plant_log);
  bench.write("p.toml", "[parameters.AMP]\nK = 1000\n");
  const auto outcome = run(std::string(cases), " --junit tests.xml");
  EXPECT_EQ(outcome.err, "");
  EXPECT_EQ(outcome.out,
            "plant.test.toml\n"
            "  pass  a constant is integrated\n"
            "  pass  a step, with another gain\n"
            "  pass  a ramp in 32 bits\n"
            "  pass  a record\n"
            "4 passed, 0 failed\n");
  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(bench.read("tests.xml"),
              AllOf(StartsWith("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n"),
                    HasSubstr("<testsuite name=\"plant.test.toml\" tests=\"4\" failures=\"0\""),
                    HasSubstr("<testcase name=\"a record\" classname=\"plant.test.toml\"")));
}

TEST_F(UserTests, FailuresShowStepExpectedGotAndAPlot) {
  const auto outcome =
      run("[[case]]\nname = \"a <step>\"\nsteps = 8\ninputs = {X = 1.0}\n"
          "expect = {Y = [0.002, 0.004, 0.006, 0.008, 0.012, 0.012, 0.014, 0.016], BUSY = {3 = false}}\n",
          " --no-generated --junit tests.xml");
  EXPECT_EQ(outcome.code, 1);
  EXPECT_EQ(
      outcome.out,
      "plant.test.toml\n"
      "  FAIL  a <step>\n"
      "        Y at step 4 (t = 0.004 s): expected 0.012, got 0.01, off by 0.002, allowed 1.3e-11; 1 of 8 steps fail\n"
      "              step            t     expected          got   x expected, o got, * both\n"
      "                 0            0        0.002        0.002  |*                                |\n"
      "                 1        0.001        0.004        0.004  |     *                           |\n"
      "                 2        0.002        0.006        0.006  |         *                       |\n"
      "                 3        0.003        0.008        0.008  |              *                  |\n"
      "        >        4        0.004        0.012         0.01  |                  o    x         |\n"
      "                 5        0.005        0.012        0.012  |                       *         |\n"
      "                 6        0.006        0.014        0.014  |                           *     |\n"
      "                 7        0.007        0.016        0.016  |                                *|\n"
      "        BUSY at step 3 (t = 0.003 s): expected FALSE, got TRUE\n"
      "              step            t     expected          got   x expected, o got, * both\n"
      "                 0            0                         1  |                                o|\n"
      "                 1        0.001                         1  |                                o|\n"
      "                 2        0.002                         1  |                                o|\n"
      "        >        3        0.003            0            1  |x                               o|\n"
      "                 4        0.004                         1  |                                o|\n"
      "                 5        0.005                         1  |                                o|\n"
      "                 6        0.006                         1  |                                o|\n"
      "                 7        0.007                         1  |                                o|\n"
      "0 passed, 1 failed\n");
  EXPECT_THAT(bench.read("tests.xml"),
              AllOf(HasSubstr("name=\"a &lt;step&gt;\""), HasSubstr("failures=\"1\""),
                    HasSubstr("<failure message=\"Y at step 4 (t = 0.004 s): expected 0.012, got 0.01, ")));
}

TEST_F(UserTests, TolerancesAreAbsoluteAndRelative) {
  const auto with = [&](const std::string& tolerance) {
    return run("[[case]]\nname = \"n\"\nsteps = 1\ninputs = {X = 1.0}\nexpect = {Y = 0.0021}\n" + tolerance).code;
  };
  EXPECT_EQ(with(""), 1);
  EXPECT_EQ(with("abs = 1.1e-4\n"), 0);
  EXPECT_EQ(with("abs = 0.9e-4\n"), 1);
  EXPECT_EQ(with("rel = 0.05\n"), 0);
  EXPECT_EQ(with("rel = 0.04\n"), 1);
}

TEST_F(UserTests, GoldenRecords) {
  const std::string toml = "[[case]]\nname = \"n\"\nsteps = 3\ninputs = {X = 1.0}\ngolden = \"gold/n.csv\"\n";
  auto outcome = run(toml);
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.out, HasSubstr("the golden record gold/n.csv is missing; write it with --update"));
  EXPECT_FALSE(bench.has("gold"));
  outcome = run(toml, " --no-generated --update");
  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(outcome.out, HasSubstr("  pass  n (wrote gold/n.csv)\n"));
  EXPECT_EQ(bench.read("gold/n.csv"), "t,Y,BUSY\n0,0.002,1\n0.001,0.004,1\n0.002,0.006,1\n");
  EXPECT_EQ(run(toml).code, 0);
  EXPECT_THAT(run(toml, " --no-generated --update").out, Not(HasSubstr("wrote")));

  bench.write("gold/n.csv", "t,Y,BUSY\n0,0.002,1\n0.001,0.005,1\n0.002,0.006,1\n");
  EXPECT_THAT(run(toml).out, HasSubstr("Y at step 1 (t = 0.001 s): golden 0.005, got 0.004, "));
  bench.write("gold/n.csv", "t,Y,OLD\n0,0.002,1\n0.001,0.004,1\n0.002,0.006,1\n");
  EXPECT_THAT(run(toml).out, AllOf(HasSubstr("has no column BUSY"), HasSubstr("has a column OLD")));
  bench.write("gold/n.csv", "t,Y,BUSY\n0,0.002,1\n0.001,0.004,1\n");
  EXPECT_THAT(run(toml).out, HasSubstr("has 2 rows, the case 3 steps"));
}

/// A record that drives a case, and one that its outputs are held against, are in the units of the diagram.
TEST_F(UserTests, RecordsAreBroughtToTheUnitsOfTheDiagram) {
  bench.write("log.csv", "t,X [mV]\n0,1000\n0.001,1000\n0.002,1000\n");
  bench.write("gold.csv", "t,Y [mV*s],BUSY\n0,2,1\n0.001,4,1\n0.002,6,1\n");
  const std::string toml = "[[case]]\nname = \"n\"\ncsv = \"log.csv\"\ngolden = \"gold.csv\"\nabs = 1e-12\n";
  const auto outcome = run(toml);
  EXPECT_EQ(outcome.code, 0) << outcome.out << outcome.err;
  EXPECT_THAT(outcome.err,
              AllOf(HasSubstr("note: log.csv: column X is in mV, and was converted to V: times 0.001\n"),
                    HasSubstr("note: gold.csv: column Y is in mV*s, and was converted to V*s: times 0.001\n")));
  bench.write("gold.csv", "t,Y [kg],BUSY\n0,2,1\n0.001,4,1\n0.002,6,1\n");
  EXPECT_THAT(refusal(toml), HasSubstr("HY729"));
}

/// What cases are made from is never written over: neither by golden records nor by the results.
TEST_F(UserTests, NothingIsWrittenOverWhatCasesAreMadeFrom) {
  const std::string log = "t,X\n0,1\n0.001,1\n0.002,1\n";
  const auto toml = [](const std::string& golden) {
    return "[[case]]\nname = \"n\"\ncsv = \"log.csv\"\ngolden = \"" + golden + "\"\n";
  };
  bench.write("log.csv", log);
  for (const std::string name : {"log.csv", "./plant.st", "plant.test.toml"}) {
    const auto outcome = run(toml(name), " --no-generated --update");
    EXPECT_EQ(outcome.code, 2) << name;
    EXPECT_THAT(outcome.err, HasSubstr("HY709")) << name;
    EXPECT_EQ(bench.read("plant.test.toml"), toml(name));
  }
  for (const std::string name : {"log.csv", "plant.st", "plant.test.toml", "gold.csv"}) {
    const auto outcome = run(toml("gold.csv"), " --no-generated --junit " + name);
    EXPECT_EQ(outcome.code, 2) << name;
    EXPECT_THAT(outcome.err, HasSubstr("HY709")) << name;
  }
  EXPECT_EQ(bench.read("log.csv"), log);
  EXPECT_EQ(bench.read("plant.st"), test::plant);
  EXPECT_EQ(run(toml("gold.csv"), " --no-generated --update --junit results.xml").code, 0);
}

TEST_F(UserTests, AGoldenRecordIsWrittenByOneCaseAlone) {
  const auto one = [](const std::string& name, const std::string& x) {
    return "[[case]]\nname = \"" + name + "\"\nsteps = 2\ninputs = {X = " + x + "}\ngolden = \"gold.csv\"\n";
  };
  const auto outcome = run(one("a", "1.0") + one("b", "2.0"), " --no-generated --update");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, AllOf(HasSubstr("HY709"), HasSubstr("\"a\" and \"b\" would both write gold.csv")));
  EXPECT_FALSE(bench.has("gold.csv"));
  EXPECT_EQ(run(one("a", "1.0") + one("b", "2.0"), " --no-generated --update --filter a").code, 0);
}

TEST_F(UserTests, AFailingCaseWritesNoGoldenRecord) {
  const auto outcome =
      run("[[case]]\nname = \"n\"\nsteps = 3\ninputs = {X = 1.0}\nexpect = {Y = 1.0}\ngolden = \"n.csv\"\n",
          " --no-generated --update");
  EXPECT_EQ(outcome.code, 1);
  EXPECT_FALSE(bench.has("n.csv"));
}

TEST_F(UserTests, NotANumberFailsThoughNothingExpectsIt) {
  bench.write("plant.st",
              "FUNCTION_BLOCK P (* @ts 1ms *) VAR_INPUT X : LREAL; END_VAR VAR_OUTPUT Y, Z : LREAL; END_VAR\n"
              "Y := X; Z := SQRT(X);\nEND_FUNCTION_BLOCK\n");
  const auto outcome = run("[[case]]\nname = \"n\"\nsteps = 2\ninputs = {X = -1.0}\nexpect = {Y = -1.0}\n");
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.out, HasSubstr("Z is not a number at step 0 (t = 0 s), and in 2 steps in all."));
}

TEST_F(UserTests, FilterChoosesByName) {
  bench.write("logs/log.csv", test::plant_log);
  bench.write("p.toml", "[parameters.AMP]\nK = 1000\n");
  const auto outcome = run(std::string(cases), " --no-generated --filter 'A STEP'");
  EXPECT_EQ(outcome.out, "plant.test.toml\n  pass  a step, with another gain\n1 passed, 0 failed\n");
  const auto nothing = run(std::string(cases), " --no-generated --filter dwell");
  EXPECT_EQ(nothing.code, 2);
  EXPECT_THAT(nothing.err, StartsWith("HY727 error: No case has \"dwell\" in its name.\n"));
}

TEST_F(UserTests, TheTestFileCanStandElsewhere) {
  bench.write("tests/plant.toml", "[[case]]\nname = \"n\"\nsteps = 1\ninputs = {X = 1.0}\nexpect = {Y = 0.002}\n");
  EXPECT_THAT(bench.shell("hysteron test plant.st").err,
              HasSubstr("HY724 error: plant.st: The test file plant.test.toml does not exist."));
  EXPECT_EQ(bench.shell("hysteron test plant.st --no-generated --tests tests/plant.toml").code, 0);
}

TEST_F(UserTests, SeveralFilesGoOnAfterAnError) {
  bench.write("broken.st", "FUNCTION_BLOCK B\n");
  bench.write("broken.test.toml", "[[case]]\nname = \"n\"\nsteps = 1\nexpect = {Y = 1.0}\n");
  bench.write("plant.test.toml", "[[case]]\nname = \"n\"\nsteps = 1\ninputs = {X = 1.0}\nexpect = {Y = 0.002}\n");
  const auto outcome = bench.shell("hysteron test broken.st plant.st --no-generated");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.out, "plant.test.toml\n  pass  n\n1 passed, 0 failed\n");
  EXPECT_THAT(outcome.err, HasSubstr("broken.st:"));
}

TEST_F(UserTests, AMissingCompilerIsAnError) {
  const std::string toml = "[[case]]\nname = \"n\"\nsteps = 1\ninputs = {X = 1.0}\nexpect = {Y = 0.002}\n";
  bench.write("plant.test.toml", toml);
  const auto outcome = bench.shell("CXX=no-such-compiler hysteron test plant.st");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, StartsWith("HY725 error: CXX is \"no-such-compiler\", which cannot be run.\n"));
  EXPECT_EQ(bench.shell("CXX=no-such-compiler hysteron test plant.st --no-generated").code, 0);
}

// A compiler that breaks the promise of equal bits: it is found out.
TEST_F(UserTests, GeneratedCodeWithOtherBitsFails) {
  bench.write("plant.st",
              "FUNCTION_BLOCK P (* @ts 1ms *) VAR_INPUT X : LREAL; END_VAR VAR_OUTPUT Y : LREAL; END_VAR\n"
              "Y := SIN(X);\nEND_FUNCTION_BLOCK\n");
  bench.write("wrong",
              "#!/bin/sh\nfor a; do case $a in *.cpp) d=${a%/*}; sed -i 's/std::sin(/1.0e-15 + std::sin(/' "
              "\"$d\"/program_*.hpp;; esac; done\nexec c++ \"$@\"\n");
  ASSERT_EQ(bench.shell("chmod +x wrong").code, 0);
  bench.write("plant.test.toml",
              "[[case]]\nname = \"n\"\nsteps = 2\ninputs = {X = 1.0}\nexpect = {Y = 0.8414709848078965}\n");
  EXPECT_EQ(bench.shell("hysteron test plant.st").code, 0);
  const auto outcome = bench.shell("CXX=./wrong hysteron test plant.st");
  EXPECT_EQ(outcome.code, 1) << outcome.err;
  EXPECT_THAT(outcome.out,
              HasSubstr("Y at step 0 (t = 0 s): the interpreter gives 0.8414709848078965, the generated C++ "
                        "0.8414709848078975; their bits must be equal"));
}

TEST_F(UserTests, SlipsInTheTestFileAreExplained) {
  const std::string good = "[[case]]\nname = \"n\"\nsteps = 2\ninputs = {X = 1.0}\nexpect = {Y = [0.002, 0.004]}\n";
  ASSERT_EQ(run(good).code, 0);
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string toml = good;
    toml.replace(toml.find(from), from.size(), to);
    return refusal(toml);
  };
  EXPECT_EQ(with("steps", "stesp"),
            "HY721 error: plant.test.toml:3:1: There is no key stesp in a test case.\n"
            "    3 | stesp = 2\n"
            "      | ^^^^^\n"
            "mend: did you mean steps?\n\n1 error\n");
  EXPECT_THAT(with("{X = 1.0}", "{X := 1.0}"), HasSubstr("HY720 error: plant.test.toml:4:"));
  EXPECT_THAT(with("steps = 2", "steps = 2\nsteps = 3"), HasSubstr("HY720 error: plant.test.toml:4:"));
  EXPECT_THAT(with("[[case]]", "[case]"), AllOf(HasSubstr("HY722"), HasSubstr("[[case]]")));
  EXPECT_THAT(with("steps = 2", "steps = 2.5"),
              HasSubstr("HY722 error: plant.test.toml:3:9: steps must be a whole number"));
  EXPECT_THAT(with("X = 1.0", "X = nan"), HasSubstr("HY722 error: plant.test.toml:4:"));
  EXPECT_THAT(with("X = 1.0", "X = \"one\""), AllOf(HasSubstr("HY722"), HasSubstr("from = 0.0")));
  EXPECT_THAT(with("X = 1.0", "X = 1.0, RESET = 0.5"),
              AllOf(HasSubstr("RESET takes 0 or 1, not 0.5."), HasSubstr("true or false")));
  EXPECT_THAT(with("{X = 1.0}", "{U = 1.0, X = 1.0}"),
              HasSubstr("HY721 error: plant.test.toml:4:11: There is no input U."));
  EXPECT_THAT(with("{Y", "{Z"), AllOf(HasSubstr("HY721"), HasSubstr("the outputs are Y, BUSY.")));
  EXPECT_THAT(with("{X = 1.0}", "{}"), AllOf(HasSubstr("HY723"), HasSubstr("inputs = {X = 0.0}")));
  EXPECT_THAT(with("[0.002, 0.004]", "[0.002]"),
              HasSubstr("HY723 error: plant.test.toml:5:15: Y has 1 values for 2 steps."));
  EXPECT_THAT(with("X = 1.0", "X = [1.0]"), AllOf(HasSubstr("X has 1 values for 2 steps."), HasSubstr("\n1 error\n")));
  EXPECT_THAT(with("[0.002, 0.004]", "{2 = 0.006}"), HasSubstr("steps count from 0"));
  EXPECT_THAT(with("X = 1.0", "X = {1 = 1.0}"), HasSubstr("X has no value for step 0."));
  EXPECT_THAT(with("expect = {Y = [0.002, 0.004]}", ""), HasSubstr("The case \"n\" checks nothing."));
  EXPECT_THAT(with("name = \"n\"\n", ""), HasSubstr("The case has no name."));
  EXPECT_THAT(refusal(good + good), HasSubstr("Two cases are named \"n\"."));
  EXPECT_THAT(refusal(""), HasSubstr("The file has no test case."));
  EXPECT_THAT(refusal(good + "params = {AMP = {G = 1.0}}\n"), HasSubstr("HY603 error: plant.test.toml:6:18: "));
  EXPECT_THAT(refusal(good + "block = \"PLAN\"\n"),
              AllOf(HasSubstr("HY723 error: plant.test.toml:6:9: "), HasSubstr("PLAN")));
  EXPECT_THAT(refusal(good + "abs = -1.0\n"), HasSubstr("HY722 error: plant.test.toml:6:7: "));
  EXPECT_THAT(refusal(good + "csv = \"no.csv\"\n"),
              AllOf(HasSubstr("HY100"),
                    HasSubstr("note: plant.test.toml:6:7: named here; files are looked for beside the test file")));
}

}  // namespace
}  // namespace hysteron
