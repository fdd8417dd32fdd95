// The formatter: the house's layout, letter by letter, and that nothing is lost.
#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

#include "codegen/language/syntax.hpp"
#include "tests/codegen/language/samples.hpp"
#include "tests/fuzz/parse_property.hpp"

namespace hysteron::test {
namespace {

std::string formatted(std::string_view text, const language::StatementOrders& orders = {}) {
  Diagnostics diagnostics;
  const auto file = language::parse("test.st", std::string(text), diagnostics);
  for (const auto& one : diagnostics.all()) {
    ADD_FAILURE() << one.place.line << ":" << one.place.column << ": " << one.cause;
  }
  return language::format(file, orders);
}

TEST(Format, EverySampleKeepsItsTreeAndIsStable) {
  for (const auto sample : sample_diagrams) {
    EXPECT_EQ(parse_flaw(sample), "") << sample;
  }
}

TEST(Format, FeedforwardOfAPiezo) {
  EXPECT_EQ(formatted(sample_diagrams[1]), R"(FUNCTION_BLOCK PIEZO_FF  (* @ts 50us *)
  VAR_INPUT
    Y_REF : LREAL;  (* @unit um *)
    RESET : BOOL;
  END_VAR
  VAR_OUTPUT
    U : LREAL;  (* @unit V  *)
  END_VAR
  VAR
    RATE   : HY_DERIVATIVE;
    BRANCH : HY_BRANCH;
    P      : HY_MOMENTUM;
    INV    : HY_M_INVERSE;
    SUM    : HY_INTEGRAL;
    HOLD   : HY_DELAY;
  END_VAR

  RATE(XIN := Y_REF);
  BRANCH(XIN := RATE.XOUT);
  INV(XIN := RATE.XOUT, P := HOLD.XOUT, R1 := BRANCH.Q);
  P(XIN := INV.XOUT, R1 := BRANCH.Q OR RESET);
  SUM(XIN := INV.XOUT, R1 := RESET);
  HOLD(XIN := P.XOUT);
  U := SUM.XOUT;
END_FUNCTION_BLOCK
)");
}

TEST(Format, CommentsStayBesideWhatTheyStoodBeside) {
  EXPECT_EQ(formatted(sample_diagrams[2]), R"((* head of the file *)

(* a second comment,
     on two lines *)
FUNCTION_BLOCK Outer  (* @ts 1ms *) (* @doc what it is for *)
  (* @top *)
  VAR_INPUT  (* what comes in *)
    A, B : LREAL := 1.0e-3;  (* @unit um @min -1.0 @max 40 *) (* more *)

    (* about C *)
    C (* in progress @unit 1 *) : BOOL := TRUE;
  END_VAR  (* behind the inputs *)
  VAR_OUTPUT
    Y : LREAL;  (* @doc a long word
                   on two lines *)
    Z : DINT := 16#FF;
  END_VAR
  VAR CONSTANT
    N : DINT  := -2147483648;
    W : WORD  := WORD#16#00_FF;
    K : LREAL := LREAL#-1.5;
  END_VAR
  VAR
  END_VAR
  VAR
    T : HY_TABLE := (X := [0.0, 1.0, 2.0], Y := [0.0, -1.5e-3, 1_000.0]);
    I : Inner;
  END_VAR

  (* above the first call *)
  I(A := A * (B + 2.0) ** 2.0 - -B, (* inside *) B := NOT C & TRUE);  (* beside it *)

  (* above the second *)
  (* twice *)
  T(XIN := LIMIT(MN := 0.0, IN := I.Y, MX := MAX(A, B, 1.0)));

  Y := T.XOUT;
  Z := (N + 3) MOD 8#17 / 2#1010;
  (* at the end *)
END_FUNCTION_BLOCK  (* of Outer *)

FUNCTION_BLOCK Inner
  VAR_INPUT
    A : LREAL;
    B : BOOL;
  END_VAR
  VAR_OUTPUT
    Y : LREAL;
  END_VAR

  Y := SEL(B = FALSE XOR A >= 1.0 OR A <> 2.0 AND NOT (A < 3.0), A, -A);
END_FUNCTION_BLOCK

(* tail *)
)");
}

TEST(Format, OrderIsThatWhichIsAskedFor) {
  const std::string text = R"(FUNCTION_BLOCK F
  A := B;  (* beside A *)
  (* above C *)
  C := D;

  E := F;
END_FUNCTION_BLOCK
)";
  EXPECT_EQ(formatted(text), text);
  EXPECT_EQ(formatted(text, {{2, 0, 1}}), R"(FUNCTION_BLOCK F
  E := F;
  A := B;  (* beside A *)
  (* above C *)
  C := D;
END_FUNCTION_BLOCK
)");
  EXPECT_EQ(formatted(text, {{}}), text);
  EXPECT_THROW(formatted(text, {{0, 1}}), std::invalid_argument);
  EXPECT_THROW(formatted(text, {{0, 1, 1}}), std::invalid_argument);
  EXPECT_THROW(formatted(text, {{0, 1, 3}}), std::invalid_argument);
}

TEST(Format, BlankLines) {
  EXPECT_EQ(formatted("\n\nFUNCTION_BLOCK F\n\n\nVAR\n\nX : LREAL;\n\n\n\nY : LREAL;\n\nEND_VAR\nX := 1.0;\n\n\n\nY := "
                      "2.0;\n\nEND_FUNCTION_BLOCK\n"
                      "FUNCTION_BLOCK G END_FUNCTION_BLOCK\n\n\n"),
            R"(FUNCTION_BLOCK F
  VAR
    X : LREAL;

    Y : LREAL;
  END_VAR

  X := 1.0;

  Y := 2.0;
END_FUNCTION_BLOCK

FUNCTION_BLOCK G
END_FUNCTION_BLOCK
)");
}

TEST(Format, KeywordsAreUpperCaseAndNamesAndNumbersAreKept) {
  EXPECT_EQ(formatted("function_block f var constant x:lreal:=1.50E-06;n:dint:=16#aF;b:bool:=bool#true;end_var "
                      "Y:=-x*(-n+ 3 mod 2)**2.0;z:=not b and true or(x<>1.0)xor x>=Y&false;end_function_block"),
            R"(FUNCTION_BLOCK f
  VAR CONSTANT
    x : LREAL := 1.50E-06;
    n : DINT  := 16#aF;
    b : BOOL  := bool#true;
  END_VAR

  Y := -x * (-n + 3 MOD 2) ** 2.0;
  z := NOT b AND TRUE OR (x <> 1.0) XOR x >= Y & FALSE;
END_FUNCTION_BLOCK
)");
}

TEST(Format, LongLinesAreBrokenBetweenArguments) {
  EXPECT_EQ(formatted(sample_diagrams[3]), R"(FUNCTION_BLOCK LONG
  VAR
    A_VERY_LONG_NAME_THAT_PUSHES_ALL_OTHERS_ASIDE, ANOTHER_VERY_LONG_NAME_THAT_PUSHES_ALL_OTHERS_ASIDE : LREAL;
    X     : LREAL;  (* short *)
    CURVE : HY_TABLE := (X := [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 10.0, 11.0, 12.0, 13.0, 14.0, 15.0,
                             16.0],
                         Y := [0.0, 1.0]);
  END_VAR

  CURVE(FIRST_PIN_OF_THIS := X + X + X + X + X, SECOND_PIN_OF_THIS := LIMIT(0.0, X, 1.0) * X, THIRD_PIN_OF_THIS := X,
        FOURTH_PIN := X);
  X := 1.0 + 2.0 * 3.0 + 4.0 * 5.0 + 6.0 * 7.0 + 8.0 * 9.0 + 10.0 * 11.0 + 12.0 * 13.0 + 14.0 * 15.0 + 16.0 * 17.0 +
      (18.0 - 19.0) / 20.0;
  CURVE(ONE_PIN := MAX(11111111.0, 22222222.0, 33333333.0, 44444444.0, 55555555.0, 66666666.0, 77777777.0, 88888888.0,
            99999999.0, 1.0),
        B := 2.0);
END_FUNCTION_BLOCK
)");
}

TEST(Format, LineEndsOfTheSourceAreKept) {
  EXPECT_EQ(formatted("FUNCTION_BLOCK F\r\nA := B; (* one\r\n  two *)\r\n\r\n\r\nC := D;\r\nEND_FUNCTION_BLOCK"),
            "FUNCTION_BLOCK F\r\n  A := B;  (* one\r\n              two *)\r\n\r\n  C := D;\r\nEND_FUNCTION_BLOCK\r\n");
}

TEST(Format, ATextWithErrorsIsGivenBackAsItIs) {
  Diagnostics diagnostics;
  const std::string text = "function_block F a := ; end_function_block";
  EXPECT_EQ(language::format(language::parse("", text, diagnostics)), text);
  EXPECT_TRUE(diagnostics.has_errors());
}

}  // namespace
}  // namespace hysteron::test
