// `hysteron draw`: pictures by Graphviz, whole or not at all.
#include <gmock/gmock.h>

#include <string>

#include "tests/tool/workbench.hpp"

namespace hysteron {
namespace {

using testing::AllOf;
using testing::HasSubstr;

const std::string plant =
    "FUNCTION_BLOCK STAGE\n  VAR_INPUT\n    U : LREAL;\n  END_VAR\n  VAR_OUTPUT\n    Y : LREAL;\n  END_VAR\n  VAR\n"
    "    L : HY_LAG := (T1 := 0.1);\n  END_VAR\n\n  L(XIN := U);\n  Y := L.XOUT;\nEND_FUNCTION_BLOCK\n\n"
    "FUNCTION_BLOCK PLANT  (* @ts 1ms *)\n  VAR_INPUT\n    U : LREAL;  (* @unit V *)\n  END_VAR\n  VAR_OUTPUT\n"
    "    Y : LREAL;  (* @unit V *)\n  END_VAR\n  VAR\n    A : STAGE;\n  END_VAR\n\n  A(U := U);\n  Y := A.Y;\n"
    "END_FUNCTION_BLOCK\n";

TEST(Draw, WritesSvgAndPngWithTheNamesOnIt) {
  const test::Workbench bench;
  bench.write("plant.st", plant);
  const auto svg = bench.shell("hysteron draw plant.st --out plant.svg");
  ASSERT_EQ(svg.code, 0) << svg.err;
  EXPECT_EQ(svg.out, "plant.svg: 5 boxes\n");
  EXPECT_THAT(bench.read("plant.svg"),
              AllOf(HasSubstr("<svg"), HasSubstr("HY_LAG"), HasSubstr("STAGE"), HasSubstr("</svg>")));
  ASSERT_EQ(bench.shell("hysteron draw plant.st --out plant.PNG").code, 0);
  EXPECT_TRUE(bench.read("plant.PNG").starts_with("\x89PNG"));
  EXPECT_EQ(bench.names().size(), 3U) << "nothing else is left behind";
}

TEST(Draw, TheTextNeedsNoGraphvizAndIsTheSameEachTime) {
  const test::Workbench bench;
  bench.write("plant.st", plant);
  ASSERT_EQ(bench.shell("GRAPHVIZ_DOT=no-such-dot hysteron draw plant.st --out one.dot").code, 0);
  ASSERT_EQ(bench.shell("hysteron draw plant.st --out two.dot").code, 0);
  EXPECT_EQ(bench.read("one.dot"), bench.read("two.dot"));
  EXPECT_TRUE(bench.read("one.dot").starts_with("digraph \"PLANT\" {"));
}

TEST(Draw, LeavesWhatWasThereWhereGraphvizFails) {
  const test::Workbench bench;
  bench.write("plant.st", plant);
  bench.write("plant.svg", "an older picture");
  const auto failed = bench.shell("GRAPHVIZ_DOT=false hysteron draw plant.st --out plant.svg");
  EXPECT_EQ(failed.code, 2);
  EXPECT_THAT(failed.err, HasSubstr("HY741"));
  EXPECT_EQ(bench.read("plant.svg"), "an older picture");
  const auto missing = bench.shell("GRAPHVIZ_DOT=no-such-dot hysteron draw plant.st --out plant.svg");
  EXPECT_EQ(missing.code, 2);
  EXPECT_THAT(missing.err, AllOf(HasSubstr("HY740"), HasSubstr("install the Debian package graphviz")));
  EXPECT_EQ(bench.names().size(), 2U);
}

TEST(Draw, RefusesNamesThatAreNoPictureAndItsOwnInput) {
  const test::Workbench bench;
  bench.write("plant.st", plant);
  EXPECT_THAT(bench.shell("hysteron draw plant.st --out plant.bmp").err, HasSubstr("HY730"));
  ASSERT_EQ(bench.shell("ln -s plant.st plant.dot").code, 0);
  EXPECT_THAT(bench.shell("hysteron draw plant.st --out plant.dot").err, HasSubstr("HY709"));
  EXPECT_EQ(bench.read("plant.st"), plant);
}

TEST(Draw, DrawsTheBlockThatIsAskedFor) {
  const test::Workbench bench;
  bench.write("plant.st", plant);
  ASSERT_EQ(bench.shell("hysteron draw plant.st --top STAGE --out stage.dot").code, 0);
  EXPECT_TRUE(bench.read("stage.dot").starts_with("digraph \"STAGE\" {"));
  EXPECT_THAT(bench.read("stage.dot"), testing::Not(HasSubstr("cluster")));
}

}  // namespace
}  // namespace hysteron
