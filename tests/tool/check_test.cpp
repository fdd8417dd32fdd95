// hysteron check and hysteron fmt.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <string>

#include "tests/tool/workbench.hpp"

namespace hysteron {
namespace {

using testing::AllOf;
using testing::HasSubstr;

constexpr std::string_view two_slips = R"(FUNCTION_BLOCK P  (* @ts 1ms *)
  VAR_INPUT
    X : LREAL;
  END_VAR
  VAR_OUTPUT
    Y : LREAL;
  END_VAR
  VAR
    AMP : HY_GIAN;
  END_VAR

  Y := Z;
END_FUNCTION_BLOCK
)";

TEST(Check, PrintsEveryDiagnosticWithItsPlace) {
  const test::Workbench bench;
  bench.write("p.st", two_slips);
  const auto outcome = bench.shell("hysteron check p.st");
  EXPECT_EQ(outcome.code, 1);
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("HY201 error: p.st:9:11: "), HasSubstr("    9 |     AMP : HY_GIAN;\n"),
                                 HasSubstr("      |           ^^^^^^^\n"), HasSubstr("HY_GAIN")));
  EXPECT_EQ(outcome.err, "");
}

TEST(Check, SaysSoWhereNothingIsFound) {
  const test::Workbench bench;
  bench.write("plant.st", test::plant);
  const auto one = bench.shell("hysteron check plant.st");
  EXPECT_EQ(one.code, 0);
  EXPECT_EQ(one.out, "plant.st: no errors\n");
  EXPECT_EQ(bench.shell("hysteron check plant.st plant.st").out, "2 files: no errors\n");
}

TEST(Check, JsonIsAListOfDiagnostics) {
  const test::Workbench bench;
  bench.write("p.st", two_slips);
  bench.write("plant.st", test::plant);
  const auto outcome = bench.shell("hysteron check --json p.st");
  EXPECT_EQ(outcome.code, 1);
  const auto list = nlohmann::json::parse(outcome.out);
  ASSERT_FALSE(list.empty());
  EXPECT_EQ(list[0]["number"], "HY201");
  EXPECT_EQ(list[0]["file"], "p.st");
  EXPECT_EQ(list[0]["line"], 9);
  EXPECT_EQ(list[0]["column"], 11);
  EXPECT_EQ(list[0]["length"], 7);
  EXPECT_EQ(list[0]["page"], "docs/errors/HY201.md");
  EXPECT_EQ(nlohmann::json::parse(bench.shell("hysteron check --json plant.st").out), nlohmann::json::array());
}

constexpr std::string_view disorderly = R"(function_block p (* @ts 1ms *)
var_input x:lreal;end_var var_output y:lreal;end_var
var a:hy_gain:=(K:=2.0);b:hy_gain:=(K:=3.0);end_var
b(XIN:=a.XOUT); (* the second *)
a(XIN:=x);
y:=b.XOUT;
end_function_block
)";

/// To move the read would change what an IEC compiler makes of the text.
TEST(Fmt, MovesNoStatementOfItsOwnAccord) {
  const test::Workbench bench;
  bench.write("p.st", disorderly);
  for (const std::string options : {"", "--check ", "--stdout "}) {
    const auto outcome = bench.shell("hysteron fmt " + options + "p.st");
    EXPECT_EQ(outcome.code, 2);
    EXPECT_EQ(outcome.out, "");
    EXPECT_THAT(outcome.err, AllOf(HasSubstr("HY402 error"), HasSubstr("HY_DELAY"), HasSubstr("--any-order")));
  }
  EXPECT_EQ(bench.read("p.st"), disorderly);
}

TEST(Fmt, InAnyOrderPutsStatementsInOrderAndIsIdempotent) {
  const test::Workbench bench;
  bench.write("p.st", disorderly);
  EXPECT_EQ(bench.shell("hysteron check p.st").code, 1);  // b reads last cycle's a
  const auto outcome = bench.shell("hysteron fmt --any-order p.st");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("HY402 warning")) << "what was moved is told";
  EXPECT_EQ(outcome.out, "p.st formatted\n");
  const auto formatted = bench.read("p.st");
  EXPECT_LT(formatted.find("XIN := x"), formatted.find("(* the second *)"));
  EXPECT_EQ(bench.shell("hysteron check p.st").code, 0);
  EXPECT_EQ(bench.shell("hysteron fmt p.st").out, "");
  EXPECT_EQ(bench.read("p.st"), formatted);
}

TEST(Fmt, CheckChangesNothing) {
  const test::Workbench bench;
  bench.write("p.st", disorderly);
  const auto outcome = bench.shell("hysteron fmt --any-order --check p.st");
  EXPECT_EQ(outcome.code, 1);
  EXPECT_EQ(outcome.out, "p.st would change\n");
  EXPECT_EQ(bench.read("p.st"), disorderly);
  EXPECT_EQ(bench.shell("hysteron fmt --any-order p.st && hysteron fmt --check p.st").code, 0);
}

TEST(Fmt, StdoutLeavesTheFile) {
  const test::Workbench bench;
  bench.write("p.st", disorderly);
  const auto outcome = bench.shell("hysteron fmt --any-order --stdout p.st");
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(bench.read("p.st"), disorderly);
  EXPECT_EQ(outcome.out, bench.shell("hysteron fmt --any-order --stdout /dev/stdin < p.st").out);
  EXPECT_EQ(bench.shell("hysteron fmt --any-order p.st; cat p.st").out, "p.st formatted\n" + outcome.out);
}

TEST(Fmt, AFileWithSyntaxErrorsStays) {
  const test::Workbench bench;
  const std::string broken = "FUNCTION_BLOCK P\nVAR x : LREAL END_VAR\n";
  bench.write("broken.st", broken);
  bench.write("p.st", disorderly);
  const auto outcome = bench.shell("hysteron fmt --any-order broken.st p.st");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_THAT(outcome.err, HasSubstr("broken.st:2"));
  EXPECT_EQ(bench.read("broken.st"), broken);
  EXPECT_EQ(outcome.out, "p.st formatted\n");
}

/// A body has a layout of its own: the diagrams beside it are not formatted either, which nobody should have to guess.
TEST(Fmt, AFileWithASequentialBodyStaysAndThatIsSaid) {
  const test::Workbench bench;
  const std::string body =
      "FUNCTION_BLOCK COUNTS (* @body @ts 1ms *)\nVAR_INPUT GO : BOOL; END_VAR\nVAR_OUTPUT N : DINT; END_VAR\n"
      "IF GO THEN N := N + 1; END_IF;\nEND_FUNCTION_BLOCK\n";
  bench.write("body.st", body);
  bench.write("both.st", body + std::string("FUNCTION_BLOCK P (* @ts 1ms *)\nVAR_INPUT X:LREAL; END_VAR\n"
                                            "VAR_OUTPUT Y:LREAL; END_VAR\nY:=X;\nEND_FUNCTION_BLOCK\n"));
  const auto alone = bench.shell("hysteron fmt body.st");
  EXPECT_EQ(alone.code, 0);
  EXPECT_EQ(alone.err, "note: body.st: COUNTS has a sequential body, so the file is left as it stands\n");
  const auto both = bench.shell("hysteron fmt --check both.st");
  EXPECT_EQ(both.code, 0);
  EXPECT_THAT(both.err, HasSubstr("in a file of their own its diagrams are formatted"));
}

}  // namespace
}  // namespace hysteron
