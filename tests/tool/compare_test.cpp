// `hysteron compare`: records, parameter files, diagrams and verdicts, side by side.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <string>

#include "tests/tool/workbench.hpp"

namespace hysteron {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class CompareCommand : public testing::Test {
 protected:
  [[nodiscard]] test::Outcome compare(const std::string& arguments, int code) const {
    auto outcome = bench.shell("hysteron compare " + arguments);
    EXPECT_EQ(outcome.code, code) << arguments << "\n" << outcome.out << outcome.err;
    return outcome;
  }
  test::Workbench bench;
};

TEST_F(CompareCommand, RecordsColumnByColumn) {
  bench.write("a.csv", "t,y [um],z\n0,1,5\n1,2,5\n2,3,5\n3,4,5\n");
  bench.write("b.csv", "t,y [nm],z\n0,1000,5\n1,2000,5\n2,3300,5\n3,3600,5\n");
  const auto text = compare("a.csv b.csv", 1).out;
  EXPECT_THAT(
      text,
      HasSubstr("y: largest difference 0.4 um at t = 3 s, RMS 0.25 um; first different at t = 2 s, in 2 of 4 rows"));
  EXPECT_THAT(text, AllOf(HasSubstr("z: equal bits"), HasSubstr("\ndifferent\n")));
  EXPECT_THAT(compare("a.csv b.csv --abs 0.41", 0).out, HasSubstr("within the tolerance"));
  (void)compare("a.csv b.csv --rel 0.09", 1);
  (void)compare("a.csv b.csv --rel 0.11", 0);
  EXPECT_THAT(compare("a.csv a.csv", 0).out, HasSubstr("\nthe same\n"));
  const auto json = nlohmann::json::parse(compare("a.csv b.csv --json --plot apart.svg", 1).out);
  EXPECT_EQ(json.at("kind"), "record");
  EXPECT_FALSE(json.at("same").get<bool>());
  EXPECT_NEAR(json.at("columns").at(0).at("rms").get<double>(), 0.25, 1e-12);
  EXPECT_EQ(json.at("columns").at(0).at("first_at"), 2.0);
  EXPECT_TRUE(json.at("columns").at(1).at("equal_bits").get<bool>());
  EXPECT_THAT(bench.read("apart.svg"), HasSubstr("b.csv − a.csv"));
}

TEST_F(CompareCommand, RowsAndColumnsThatOneAloneHasAreDifferences) {
  bench.write("a.csv", "t,y,z\n0,1,1\n1,2,1\n2,3,1\n3,4,1\n");
  bench.write("b.csv", "t,y,w\n1,2,1\n2,3,1\n3,4,1\n4,5,1\n");
  EXPECT_THAT(compare("a.csv b.csv", 1).out,
              AllOf(HasSubstr("3 rows have the same time; 1 are only in A, 1 only in B"), HasSubstr("y: equal bits"),
                    HasSubstr("z: only in A"), HasSubstr("w: only in B")));
  EXPECT_THAT(compare("a.csv b.csv --range 1..3", 1).out, testing::Not(HasSubstr("only in B\nw")));
  bench.write("late.csv", "t,y\n10,2\n11,3\n12,4\n");
  EXPECT_THAT(compare("a.csv late.csv", 2).err, AllOf(HasSubstr("HY730"), HasSubstr("no time in common")));
}

/// A column that is no signal in one of the records is not compared, and keeps no other from it.
TEST_F(CompareCommand, AColumnWithoutNumbersIsNamed) {
  bench.write("a.csv", "t,y,z\n0,1,5\n1,2,5\n2,3,5\n3,4,5\n");
  bench.write("b.csv", "t,y,z\n0,1,5\n1,2,5\n2,nan,5\n3,4,5\n");
  for (const std::string files : {"a.csv b.csv", "b.csv a.csv"}) {
    const auto text = compare(files, 1).out;
    EXPECT_THAT(text, AllOf(HasSubstr("z: equal bits"), HasSubstr("y: not compared; b.csv: "))) << files;
    EXPECT_THAT(text, testing::Not(HasSubstr("y: only in"))) << files;
  }
}

TEST_F(CompareCommand, ConvertedUnitsAreSaid) {
  bench.write("a.csv", "t,y [um],z\n0,1,5\n1,2,5\n2,3,5\n");
  bench.write("b.csv", "t,y [nm],z [V]\n0,1000,5\n1,2000,5\n2,3000,5\n");
  EXPECT_THAT(compare("a.csv b.csv --abs 1e-9", 0).err,
              HasSubstr("note: b.csv: column y is in nm, and was converted to um, as in a.csv: times 0.001\n"));
  EXPECT_THAT(compare("b.csv a.csv --abs 1e-9", 0).err,
              HasSubstr("note: a.csv: column z has no unit, and is taken to be in V, as in b.csv\n"));
  bench.write("c.csv", "t,y [kg]\n0,1\n1,2\n2,3\n");
  EXPECT_THAT(compare("a.csv c.csv", 2).err, HasSubstr("HY729"));
}

/// Records of the same uneven times row by row; of two clocks at the times of the slower one, and of those in A's grid.
TEST_F(CompareCommand, UnevenTimesAndOtherClocks) {
  bench.write("a.csv", "t,y\n0,0\n1,10\n2.2,22\n3,30\n4,40\n5,50\n6,60\n");
  bench.write("b.csv", "t,y\n0,0\n1,10\n2.2,23\n3,30\n4,40\n5,50\n6,60\n");
  EXPECT_THAT(
      compare("a.csv b.csv", 1).out,
      HasSubstr("y: largest difference 1 at t = 2.2 s, RMS 0.378; first different at t = 2.2 s, in 1 of 7 rows"));
  bench.write("slow.csv", "t,y\n0.5,5\n2.5,25\n4.5,46\n");
  EXPECT_THAT(compare("a.csv slow.csv", 2).err,
              AllOf(HasSubstr("no time in common"), HasSubstr("--resample linear, or hold")));
  for (const std::string files : {"a.csv slow.csv", "slow.csv a.csv"}) {
    EXPECT_THAT(compare(files + " --resample linear", 1).out,
                AllOf(HasSubstr("y: largest difference 1 at t = 4.5 s"), HasSubstr("in 1 of 3 rows")))
        << files;
  }
  bench.write("shifted.csv", "t,y\n0,0\n1.5,15\n2.5,25\n4,40\n5.5,55\n6,60\n");
  EXPECT_THAT(compare("a.csv shifted.csv", 1).out,
              HasSubstr("; --resample linear compares at the times of the slower"));
}

TEST_F(CompareCommand, ParametersValueByValue) {
  bench.write("a.toml", "[parameters.A]\nK = 2.0\nN = 3\nOLD = 1.0\n[initial.S]\nX = 0.0\n");
  bench.write("b.toml", "# tuned\n[parameters.A]\nN = 3.0\nK = 2.5\nNEW = true\n[initial.S]\nX = 1.0\n");
  const auto text = compare("a.toml b.toml", 1).out;
  EXPECT_THAT(text, AllOf(HasSubstr("A.K: 2 -> 2.5  (+25 %)"), HasSubstr("A.OLD: 1, only in A"),
                          HasSubstr("A.NEW: true, only in B"), HasSubstr("initial S.X: 0 -> 1  (–)"),
                          HasSubstr("1 of 5 values are the same")));
  EXPECT_THAT(compare("a.toml a.toml", 0).out, HasSubstr("4 of 4 values are the same"));
  const auto json = nlohmann::json::parse(compare("a.toml b.toml --json", 1).out);
  EXPECT_EQ(json.at("kind"), "parameter file");
  EXPECT_DOUBLE_EQ(json.at("parameters").at(0).at("change_percent"), 25.0);
}

constexpr std::string_view diagram =
    "FUNCTION_BLOCK P  (* @ts 1ms *)\n  VAR_INPUT U : LREAL; (* @unit V *) END_VAR\n"
    "  VAR_OUTPUT Y : LREAL; END_VAR\n  VAR A : HY_GAIN := (K := 2.0); B : HY_LAG := (T1 := 0.1); END_VAR\n"
    "  A(XIN := U + 1.0);\n  B(XIN := A.XOUT * 2.0);\n  Y := B.XOUT;\nEND_FUNCTION_BLOCK\n";

std::string with(std::string text, const std::string& what, const std::string& by) {
  const auto at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return text.replace(at, what.size(), by);
}

TEST_F(CompareCommand, DiagramsByTheirGraphs) {
  bench.write("a.st", diagram);
  // Another layout, other comments, another case of names: the same diagram.
  bench.write("b.st",
              "(* new *)\n" + with(with(std::string(diagram), "  A(XIN := U + 1.0);\n", "A( xin:=(u+1.0) ) ; (* x *)"),
                                   "VAR A : HY_GAIN := (K := 2.0); B", "VAR\n a : HY_GAIN := (K := 2.00);\n\nb"));
  EXPECT_THAT(compare("a.st b.st", 0).out, HasSubstr("the same diagram"));
  const struct {
    std::string what;
    std::string by;
    std::string said;
  } changes[] = {
      {"U + 1.0", "U - 1.0", "wire A.XIN: from (U + 1.0) -> from (U - 1.0)"},
      {"A.XOUT * 2.0", "U * 2.0", "wire B.XIN: from (A.XOUT * 2.0) -> from (U * 2.0)"},
      {"K := 2.0", "K := 3.0", "parameter A.K: 2 -> 3"},
      {"B : HY_LAG := (T1 := 0.1)", "B : HY_INTEGRAL", "block B: HY_LAG -> HY_INTEGRAL"},
      {"@unit V", "@unit mV", "port U: input LREAL [V] -> input LREAL [mV]"},
      {"@ts 1ms", "@ts 2ms", "port sample time: 0.001 s -> 0.002 s"},
      {"Y := B.XOUT", "Y := A.XOUT", "wire Y: from B.XOUT -> from A.XOUT"},
      {"(T1 := 0.1); END_VAR", "(T1 := 0.1); C : HY_GAIN; END_VAR\n  C(XIN := U);", "block C: added, HY_GAIN"}};
  for (const auto& [what, by, said] : changes) {
    bench.write("b.st", with(std::string(diagram), what, by));
    EXPECT_THAT(compare("a.st b.st", 1).out, HasSubstr(said)) << by;
  }
  EXPECT_THAT(compare("b.st a.st", 1).out, HasSubstr("block C: removed, was HY_GAIN"));
}

/// A shared expression is compared once, and a deep one is cut where it is printed and nowhere else.
TEST_F(CompareCommand, DeepExpressionsThatDifferInsideAreDifferent) {
  std::string sum = "U";
  for (int i = 0; i < 40; ++i) {
    sum = "(" + sum + " + ABS(U))";
  }
  bench.write("a.st", with(std::string(diagram), "U + 1.0", sum));
  bench.write("b.st", with(std::string(diagram), "U + 1.0", with(sum, "(U + ABS(U))", "(U - ABS(U))")));
  EXPECT_THAT(compare("a.st b.st", 1).out, HasSubstr("differs further inside"));
  EXPECT_THAT(compare("a.st a.st", 0).out, HasSubstr("the same diagram"));
}

TEST_F(CompareCommand, VerdictsByWhatTheySay) {
  const auto verdict = [](const char* effect, double confidence) {
    return nlohmann::json{{"schema", "hysteron-verdict/1"},
                          {"verdict", "explained"},
                          {"effects", {{{"id", effect}, {"edge", "SUM.XOUT"}}}},
                          {"families", {{{"family", "slow"}, {"probability", 0.9}}}},
                          {"confidence", confidence},
                          {"gap", {{"signal", "Y"}, {"nominal_rms", 2.0}, {"improved_rms", nullptr}, {"closed", 0.5}}}}
        .dump();
  };
  bench.write("a/verdict.json", verdict("creep", 0.5));
  bench.write("b/verdict.json", verdict("drift", 0.75));
  const auto text = compare("a/verdict.json b/verdict.json", 1).out;
  EXPECT_THAT(text, AllOf(HasSubstr("effects: creep -> drift"), HasSubstr("confidence: 0.5 -> 0.75  (+50 %)"),
                          HasSubstr("family: slow\n"), HasSubstr("gap left, RMS: –")));
  EXPECT_THAT(compare("a/verdict.json a/verdict.json", 0).out, HasSubstr("\nthe same\n"));
}

TEST_F(CompareCommand, MixedKindsAreRefused) {
  bench.write("a.st", diagram);
  bench.write("a.toml", "[parameters.A]\nK = 2.0\n");
  bench.write("a.csv", "t,y\n0,1\n1,2\n2,3\n");
  EXPECT_THAT(compare("a.st a.toml", 2).err, HasSubstr("a.st is a diagram, and a.toml is a parameter file"));
  EXPECT_THAT(compare("a.csv a.toml", 2).err, HasSubstr("a.csv is a record"));
  EXPECT_THAT(compare("a.st a.st --plot x.svg", 2).err, HasSubstr("leave --plot out"));
  EXPECT_THAT(compare("a.csv nowhere.csv", 2).err, HasSubstr("HY100"));
  EXPECT_THAT(compare("a.csv a.csv --abs -1", 2).err, HasSubstr("HY730"));
  bench.write("odd.json", "{\"schema\":\"x\",\"verdict\":1,\"effects\":[]}");
  EXPECT_THAT(compare("odd.json odd.json", 2).err, HasSubstr("no verdict"));
}

}  // namespace
}  // namespace hysteron
