// Pictures from the command line: `hysteron plot`, and --plot of run, test and compare.
#include <gmock/gmock.h>

#include <string>

#include "tests/tool/workbench.hpp"

namespace hysteron {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr std::string_view gain =
    "FUNCTION_BLOCK P  (* @ts 1ms *)\n  VAR_INPUT U : LREAL; (* @unit V *) B : BOOL := FALSE; END_VAR\n"
    "  VAR_OUTPUT Y : LREAL; (* @unit um *) Q : BOOL; END_VAR\n  VAR A : HY_GAIN := (K := 2.0); END_VAR\n"
    "  A(XIN := U);\n  Y := A.XOUT;\n  Q := B;\nEND_FUNCTION_BLOCK\n";
constexpr std::string_view log =
    "t [ms],u [mV],y [um],b,z\n0,0,0,0,1\n1,1000,2.1,1,2\n2,500,1.1,1,1\n3,-200,-0.4,0,0\n";

class PlotCommand : public testing::Test {
 protected:
  void SetUp() override {
    bench.write("p.st", gain);
    bench.write("log.csv", log);
  }
  void refuse(const std::string& command, const std::string& number, const std::string& said = "") const {
    const auto outcome = bench.shell(command);
    EXPECT_EQ(outcome.code, 2) << command;
    EXPECT_THAT(outcome.err, AllOf(HasSubstr(number), HasSubstr(said))) << command;
  }
  test::Workbench bench;
};

TEST_F(PlotCommand, DrawsARecordByTheEndingOfTheFile) {
  ASSERT_EQ(bench.shell("hysteron plot log.csv --out log.svg && xmllint --noout log.svg").code, 0);
  EXPECT_THAT(bench.read("log.svg"), AllOf(HasSubstr(">u [mV]<"), HasSubstr(">y [um]<"), HasSubstr(">t [s]<")));
  ASSERT_EQ(bench.shell("hysteron plot log.csv --out log.png").code, 0);
  EXPECT_THAT(bench.read("log.png"), HasSubstr("PNG"));
  const auto page = bench.shell("hysteron plot log.csv --out log.html --signal y --xy u,y");
  EXPECT_EQ(page.code, 0) << page.err;
  EXPECT_EQ(page.out, "log.html: 2 plots\n");
  EXPECT_THAT(bench.read("log.html"),
              AllOf(HasSubstr("y over u: log.csv"), testing::Not(HasSubstr("\"z\"")), testing::Not(HasSubstr("src="))));
  ASSERT_EQ(bench.shell("cp log.svg first.svg && hysteron plot log.csv --out log.svg && cmp first.svg log.svg").code,
            0);
}

TEST_F(PlotCommand, OptionsOfRecordsAreThoseOfElsewhere) {
  const auto outcome = bench.shell("hysteron plot log.csv --out log.svg --column U=u[V] --range 1ms..3ms --signal U");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(bench.read("log.svg"), AllOf(HasSubstr(">U [V]<"), testing::Not(HasSubstr(">y [um]<"))));
}

/// A run in its unit beside a record in another: one axis, and the difference below.
TEST_F(PlotCommand, TwoRecordsAreDrawnTogetherInOneUnit) {
  bench.write("other.csv", "t,u [V]\n0,0\n0.001,1\n0.002,0.6\n0.003,-0.2\n");
  ASSERT_EQ(bench.shell("hysteron plot log.csv other.csv --out both.html --signal u").code, 0);
  EXPECT_THAT(bench.read("both.html"),
              AllOf(HasSubstr("[0,1000,600,-200]"), HasSubstr("[0,0,100,0]"), HasSubstr("u [mV]")));
  bench.write("odd.csv", "t,u [kg]\n0,0\n0.001,1\n0.002,0.6\n0.003,-0.2\n");
  refuse("hysteron plot log.csv odd.csv --out both.svg", "HY729", "kg");
  EXPECT_FALSE(bench.has("both.svg"));
}

TEST_F(PlotCommand, AColumnWithoutNumbersIsLeftOutAndSaid) {
  bench.write("a.csv", "t,y,z\n0,1,5\n1,2,5\n2,3,5\n");
  bench.write("b.csv", "t,y,z\n0,1,5\n1,nan,5\n2,3,5\n");
  const auto drawn = bench.shell("hysteron plot a.csv b.csv --out ab.svg");
  EXPECT_EQ(drawn.code, 0) << drawn.err;
  EXPECT_THAT(drawn.err, HasSubstr("note: b.csv: y is left out: "));
  refuse("hysteron plot a.csv b.csv --signal y --out y.svg", "HY506");
}

TEST_F(PlotCommand, ConvertedUnitsAreSaid) {
  bench.write("a.csv", "t,y [um]\n0,1\n1,2\n2,3\n");
  bench.write("b.csv", "t,y [nm]\n0,1000\n1,2000\n2,3000\n");
  EXPECT_THAT(bench.shell("hysteron plot a.csv b.csv --out ab.svg").err,
              HasSubstr("note: b.csv: column y is in nm, and was converted to um, as in a.csv: times 0.001\n"));
}

TEST_F(PlotCommand, ParametersAreDrawnOverTheirFiles) {
  bench.write("a.toml", "[parameters.A]\nK = 1.0\nSAME = 4.0\n");
  bench.write("b.toml", "[parameters.A]\nK = 2.0\nSAME = 4.0\n");
  ASSERT_EQ(bench.shell("hysteron plot a.toml b.toml --out k.svg").code, 0);
  EXPECT_THAT(bench.read("k.svg"), AllOf(HasSubstr(">A.K<"), HasSubstr(">b.toml<"), testing::Not(HasSubstr("SAME"))));
  refuse("hysteron plot a.toml --out k.svg", "HY730", "two parameter files");
  refuse("hysteron plot a.toml a.toml --out k.svg", "HY730", "No parameter differs");
  refuse("hysteron plot a.toml log.csv --out k.svg", "HY730", "log.csv is a record");
}

TEST_F(PlotCommand, RefusesWhatItCannotDraw) {
  refuse("hysteron plot log.csv --out log.bmp", "HY730", ".html");
  refuse("hysteron plot log.csv --out log.csv", "HY730");
  refuse("cp log.csv log.svg && hysteron plot log.svg --out log.svg", "HY709");
  refuse("hysteron plot p.st --out p.svg", "HY730", "hysteron draw p.st");
  refuse("hysteron plot log.csv --out x.svg --signal uu", "HY502", "There is no column uu");
  refuse("hysteron plot log.csv --out x.svg --xy u", "HY730", "--xy U,Y");
  refuse("hysteron plot log.csv --out x.svg --xy u,nothing", "HY502");
  refuse("hysteron plot nowhere.csv --out x.svg", "HY100");
  bench.write("back.csv", "t,u\n0,1\n1,2\n2,3\n1.4,4\n5,5\n6,6\n");
  refuse("hysteron plot back.csv --out x.svg", "HY508");
  refuse("RSVG_CONVERT=no-such hysteron plot log.csv --out x.png", "HY740", "librsvg2-bin");
  refuse("RSVG_CONVERT=false hysteron plot log.csv --out x.png", "HY741", ".html needs none");
  EXPECT_FALSE(bench.has("x.svg"));
  EXPECT_FALSE(bench.has("x.png"));
}

/// At the times of the record, with nothing over the rows that are missing.
TEST_F(PlotCommand, UnevenTimesAreDrawnAsTheyAre) {
  bench.write("uneven.csv", "t,u\n0,1\n1,2\n2,3\n3.3,4\n4,5\n9,6\n10,7\n11,8\n12,8.5\n");
  const auto drawn = bench.shell("hysteron plot uneven.csv --out uneven.html");
  EXPECT_EQ(drawn.code, 0) << drawn.err;
  EXPECT_THAT(drawn.err,
              HasSubstr("note: uneven.csv: its times are uneven, and are kept: most rows are 1 s apart, with "
                        "a jitter of 0.16 s RMS and 1 gap\n"));
  EXPECT_THAT(bench.read("uneven.html"),
              AllOf(HasSubstr("[0,1,2,3.3,4,6.5,9,10,11,12]"), HasSubstr("[1,2,3,4,5,null,6,7,8,8.5]")));
  ASSERT_EQ(bench.shell("hysteron plot uneven.csv --out part.html --range 1..10").code, 0);
  EXPECT_THAT(bench.read("part.html"), HasSubstr("[1,2,3.3,4,6.5,9]"));
  ASSERT_EQ(bench.shell("hysteron plot uneven.csv --out even.html --resample linear").code, 0);
  EXPECT_THAT(bench.read("even.html"), HasSubstr("5,5.2,5.4,5.6,5.8,6,7,8"));
}

TEST_F(PlotCommand, ARunIsDrawnAgainstItsRecord) {
  const auto outcome = bench.shell("hysteron run p.st --in log.csv --out out.csv --plot run.html");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(bench.read("run.html"),
              AllOf(HasSubstr("P: run of log.csv"), HasSubstr("y [um]"), HasSubstr("run \\u2212 record"),
                    HasSubstr("\"stroke\":\"steps\""), testing::Not(HasSubstr("\"title\":\"z\""))));
  refuse("hysteron run p.st --in log.csv --out out.svg --plot out.svg", "HY709");
}

TEST_F(PlotCommand, TestsAreDrawn) {
  bench.write("p.test.toml",
              "[[case]]\nname = \"right\"\nsteps = 4\ninputs = {U = 1.0}\nexpect = {Y = 2.0}\n"
              "[[case]]\nname = \"wrong\"\nsteps = 4\ninputs = {U = 1.0}\nexpect = {Y = {3 = 5.0}}\n");
  EXPECT_EQ(bench.shell("hysteron test p.st --no-generated --plot cases.html").code, 1);
  EXPECT_THAT(bench.read("cases.html"),
              AllOf(HasSubstr("p.test.toml: right"), HasSubstr("wrong (failed)"), HasSubstr("expected")));
  refuse("hysteron test p.st --no-generated --plot p.test.toml", "HY730");
}

TEST_F(PlotCommand, TheHelpTellsOfPictures) {
  EXPECT_THAT(bench.shell("hysteron plot --help").out,
              AllOf(HasSubstr("--xy"), HasSubstr("--resample"), HasSubstr("Examples:")));
}

}  // namespace
}  // namespace hysteron
