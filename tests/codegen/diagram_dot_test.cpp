// The text that a picture is drawn from: every box, port, unit and wire of the diagram, hierarchy as frames, the same
// bytes for the same text.
#include "codegen/backends/drawing/diagram_dot.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <string>

#include "codegen/compile.hpp"

namespace hysteron::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

const std::string nested =
    "FUNCTION_BLOCK STAGE\n  VAR_INPUT\n    U : LREAL;  (* @unit um *)\n    K : LREAL := 2.0;  (* @param *)\n  "
    "END_VAR\n"
    "  VAR_OUTPUT\n    Y : LREAL;  (* @unit um *)\n  END_VAR\n  VAR\n    L : HY_LAG := (T1 := 0.25);\n  END_VAR\n\n"
    "  L(XIN := U);\n  Y := L.XOUT;\nEND_FUNCTION_BLOCK\n"
    "FUNCTION_BLOCK AXIS  (* @ts 1ms @doc a loop & its \"plant\" *)\n  VAR_INPUT\n    REF : LREAL;  (* @unit um *)\n"
    "    ON_1 : BOOL;\n    TRIM : LREAL := 0.0;  (* @param @unit um *)\n  END_VAR\n  VAR_OUTPUT\n    POS : LREAL;  (* "
    "@unit um *)\n"
    "    FAR : BOOL;\n  END_VAR\n  VAR CONSTANT\n    LIMIT_1 : LREAL := 5.0;\n  END_VAR\n  VAR\n    A, B : STAGE;\n"
    "    LAST : HY_DELAY;  (* @every 1 *)\n    C : HY_PID := (KP := 0.5);\n    OFFSET : LREAL;\n    PASSED : LREAL;\n  "
    "END_VAR\n\n"
    "  C(SP := REF, PV := LAST.XOUT, AUTO := ON_1, X0 := 1.0);\n  OFFSET := C.XOUT + TRIM;\n  PASSED := OFFSET;\n"
    "  A(U := PASSED);\n  B(U := A.Y * 2.0);\n  LAST(XIN := B.Y);\n  POS := B.Y;\n  FAR := B.Y < "
    "LIMIT_1;\nEND_FUNCTION_BLOCK\n";

DiagramDot drawn(const std::string& text, const std::string& top = "") {
  return diagram_dot(compile_text(text, {.top = top, .any_order = true}));
}

TEST(DiagramDot, ShowsPortsWithTheirUnits) {
  const std::string dot = drawn(nested).text;
  EXPECT_THAT(dot, HasSubstr("\"REF (port)\" [label=<REF <FONT POINT-SIZE=\"9\" COLOR=\"#5a5a5a\">um</FONT>>"));
  EXPECT_THAT(dot, HasSubstr("\"POS (port)\" [label=<POS "));
  EXPECT_THAT(dot, HasSubstr("TS = 1 ms"));
  EXPECT_THAT(dot, HasSubstr("a loop &amp; its &quot;plant&quot;"));
}

TEST(DiagramDot, ShowsBlocksWithWiredPinsAndSettings) {
  const std::string dot = drawn(nested).text;
  EXPECT_THAT(dot, AllOf(HasSubstr("<B>C</B>"), HasSubstr("HY_PID"), HasSubstr("KP = 0.5, X0 = 1.0")));
  EXPECT_THAT(dot, AllOf(HasSubstr("PORT=\"in SP\""), HasSubstr("PORT=\"in AUTO\""), Not(HasSubstr("PORT=\"in KP\""))));
  EXPECT_THAT(dot, Not(HasSubstr("PORT=\"out ERROR\""))) << "an output that nothing reads is not drawn";
}

TEST(DiagramDot, DrawsOwnBlocksAsFramesWithTheirPorts) {
  const DiagramDot dot = drawn(nested);
  for (const std::string path : {"A", "B"}) {
    EXPECT_THAT(dot.text, HasSubstr("subgraph \"cluster_" + path + "\" {"));
    EXPECT_THAT(dot.text, HasSubstr("\"" + path + ".U (port)\" -> \"" + path + ".L\":\"in XIN\":w"));
    EXPECT_THAT(dot.text, HasSubstr("\"" + path + ".L\":\"out XOUT\":e -> \"" + path + ".Y (port)\""));
  }
  EXPECT_THAT(dot.text, Not(HasSubstr("A.K (port)"))) << "a parameter at its default is no wire";
  EXPECT_EQ(std::ranges::count(dot.text, '{'), std::ranges::count(dot.text, '}'));
}

TEST(DiagramDot, WiresSayWhatTheyCarry) {
  const std::string dot = drawn(nested).text;
  EXPECT_THAT(dot, HasSubstr("\"C\":\"in PV\":w -> \"LAST\":\"out XOUT\":e [dir=back];"))
      << "feedback, from its end to its beginning";
  EXPECT_THAT(dot, HasSubstr("\"ON_1 (port)\" -> \"C\":\"in AUTO\":w [style=dashed];")) << "a BOOL";
  EXPECT_THAT(dot, HasSubstr("\"OFFSET\" -> \"A.U (port)\" [label=<PASSED>];")) << "the variable that hands it on";
  EXPECT_THAT(dot, HasSubstr("\"A.Y (port)\" -> \"B.U (expression)\";"));
  EXPECT_THAT(dot, HasSubstr("\"B.U (expression)\" -> \"B.U (port)\";"));
  EXPECT_THAT(dot, HasSubstr("label=<FAR := B.Y &lt; LIMIT_1>"));
}

TEST(DiagramDot, CountsItsBoxes) {
  EXPECT_EQ(drawn(nested, "STAGE").boxes, 4U) << "U, K, L and Y";
  // REF, ON_1, TRIM; C, OFFSET; U, L and Y of A and of B; the argument of B; LAST; FAR; POS and FAR.
  EXPECT_EQ(drawn(nested).boxes, 16U);
}

TEST(DiagramDot, TheSameTextGivesTheSameBytes) {
  EXPECT_EQ(drawn(nested).text, drawn(nested).text);
}

const std::string with_bodies =
    "FUNCTION_BLOCK VALVE (* @body *)\n  VAR_INPUT\n    LEVEL : LREAL;  (* @unit mm *)\n    HAND : BOOL;\n    K : "
    "LREAL := 1.0;  (* "
    "@param *)\n  END_VAR\n  VAR_OUTPUT\n    OPEN, SEEN : BOOL;\n  END_VAR\n\n"
    "  IF LEVEL < K * 200.0 THEN\n    OPEN := TRUE; (* low & dry *)\n  ELSIF LEVEL > 800.0 THEN\n\tOPEN := FALSE;\n"
    "  END_IF;\n  SEEN := HAND;\nEND_FUNCTION_BLOCK\n"
    "FUNCTION_BLOCK TANK (* @ts 100ms *)\n  VAR_INPUT\n    RAW : LREAL;  (* @unit mm *)\n    AUTO : BOOL;\n  END_VAR\n"
    "  VAR_OUTPUT\n    A, B : BOOL;\n  END_VAR\n  VAR\n    V : VALVE;\n    W : VALVE := (K := 0.5);\n  END_VAR\n\n"
    "  V(LEVEL := RAW, HAND := AUTO);\n  W(LEVEL := RAW * 2.0);\n  A := V.OPEN;\n  B := V.OPEN AND W.OPEN;\n"
    "END_FUNCTION_BLOCK\n";

/// A block with a sequential body has pins like one of the library, and its statements stand within it.
TEST(DiagramDot, ShowsASequentialBodyWithItsPinsAndItsStatements) {
  const DiagramDot dot = drawn(with_bodies, "TANK");
  EXPECT_THAT(dot.text, AllOf(HasSubstr("<B>V</B>"), HasSubstr("PORT=\"in LEVEL\""), HasSubstr("PORT=\"in HAND\""),
                              HasSubstr("PORT=\"out OPEN\""), Not(HasSubstr("PORT=\"out SEEN\""))));
  EXPECT_THAT(dot.text,
              HasSubstr(">IF LEVEL &lt; K * 200.0 THEN<BR ALIGN=\"LEFT\"/>&#160;&#160;OPEN := TRUE; (* low &amp; "
                        "dry *)<BR ALIGN=\"LEFT\"/>ELSIF LEVEL &gt; 800.0 THEN<BR ALIGN=\"LEFT\"/>&#160;&#160;OPEN"));
  EXPECT_THAT(dot.text, HasSubstr("END_IF;<BR ALIGN=\"LEFT\"/>SEEN := HAND;<BR ALIGN=\"LEFT\"/></FONT>"));
  EXPECT_EQ(dot.text.find("SEEN := HAND"), dot.text.rfind("SEEN := HAND"))
      << "the second instance does not repeat them";
  EXPECT_THAT(dot.text, HasSubstr("\"RAW (port)\" -> \"V\":\"in LEVEL\":w;"));
  EXPECT_THAT(dot.text, HasSubstr("\"W.LEVEL (expression)\" -> \"W\":\"in LEVEL\":w;"));
  EXPECT_THAT(dot.text, HasSubstr("\"V\":\"out OPEN\":e -> \"A (port)\" [style=dashed];"));
  EXPECT_THAT(dot.text, AllOf(HasSubstr("K = 0.5"), Not(HasSubstr("cluster_V"))));
  EXPECT_EQ(dot.boxes, 8U) << "RAW, AUTO; V, W, the argument of W; B; A and B";
}

TEST(DiagramDot, DrawsABodyByItselfBetweenItsPorts) {
  const DiagramDot dot = drawn(with_bodies + "\n", "VALVE");
  EXPECT_THAT(dot.text, HasSubstr("\"LEVEL (port)\" -> \"(body)\":\"in LEVEL\":w;"));
  EXPECT_THAT(dot.text, HasSubstr("\"(body)\":\"out SEEN\":e -> \"SEEN (port)\" [style=dashed];"));
  EXPECT_THAT(dot.text, HasSubstr("IF LEVEL &lt; K * 200.0 THEN"));
}

TEST(DiagramDot, OfALongBodyTheFirstLinesAreShown) {
  std::string body;
  for (int i = 0; i < 60; ++i) {
    body +=
        "  Y := Y + X * " + std::to_string(i) + ".0;" + (i == 0 ? "  (* " + std::string(80, 'x') + " *)" : "") + "\n";
  }
  const std::string dot =
      drawn(
          "FUNCTION_BLOCK LONG_ONE (* @ts 1ms @body *)\n  VAR_INPUT\n    X : LREAL;\n  END_VAR\n  VAR_OUTPUT\n    "
          "Y : LREAL;\n  END_VAR\n\n" +
          body + "END_FUNCTION_BLOCK\n")
          .text;
  EXPECT_THAT(dot,
              AllOf(HasSubstr("Y := Y + X * 22.0;"), Not(HasSubstr("X * 23.0")), HasSubstr("… and 37 more lines")));
  EXPECT_THAT(dot, AllOf(HasSubstr("xxxx …<BR"), Not(HasSubstr(std::string(60, 'x')))));
}

/// Each name at an end of a wire is a box, so that Graphviz makes none up.
TEST(DiagramDot, NoWireEndsAtNothing) {
  const std::string dot = drawn(nested).text + drawn(with_bodies, "TANK").text;
  std::size_t ends = 0;
  for (std::size_t at = dot.find(" -> "); at != std::string::npos; at = dot.find(" -> ", at + 1)) {
    const std::size_t line = dot.rfind('\n', at) + 1;
    const auto named = [&](std::size_t from) {
      const std::size_t open = dot.find('"', from);
      return dot.substr(open, dot.find('"', open + 1) + 1 - open);
    };
    for (const std::string& name : {named(line), named(at + 4)}) {
      EXPECT_THAT(dot, HasSubstr(name + " [label=<")) << name;
      ++ends;
    }
  }
  EXPECT_GT(ends, 30U);
}

}  // namespace
}  // namespace hysteron::testing
