// The tree of a diagram: sections, declarations, annotations and statements, as they were written.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "codegen/language/syntax.hpp"
#include "tests/codegen/language/dump.hpp"
#include "tests/codegen/language/samples.hpp"

namespace hysteron::test {
namespace {

language::SourceFile parse_right(std::string_view text) {
  Diagnostics diagnostics;
  auto file = language::parse("test.st", std::string(text), diagnostics);
  for (const auto& one : diagnostics.all()) {
    ADD_FAILURE() << one.place.line << ":" << one.place.column << ": " << one.cause;
  }
  EXPECT_TRUE(file.valid);
  return file;
}

std::string tree(std::string_view text) {
  const auto file = parse_right(text);
  return Dump(file).whole();
}

TEST(Parse, FeedforwardOfAPiezo) {
  EXPECT_EQ(tree(sample_diagrams[1]), R"(block PIEZO_FF @ts[50us]
input Y_REF : LREAL @unit[um]
input RESET : BOOL
output U : LREAL @unit[V]
local RATE : HY_DERIVATIVE
local BRANCH : HY_BRANCH
local P : HY_MOMENTUM
local INV : HY_M_INVERSE
local SUM : HY_INTEGRAL
local HOLD : HY_DELAY
RATE(XIN := Y_REF)
BRANCH(XIN := RATE.XOUT)
INV(XIN := RATE.XOUT, P := HOLD.XOUT, R1 := BRANCH.Q)
P(XIN := INV.XOUT, R1 := (BRANCH.Q OR RESET))
SUM(XIN := INV.XOUT, R1 := RESET)
HOLD(XIN := P.XOUT)
U := SUM.XOUT
)");
}

TEST(Parse, EveryFormOfDeclaration) {
  EXPECT_EQ(tree(sample_diagrams[2]), R"(block Outer @ts[1ms] @doc[what it is for] @top[]
input A : LREAL := 0.001r @unit[um] @min[-1.0] @max[40]
input B : LREAL := 0.001r @unit[um] @min[-1.0] @max[40]
input C : BOOL := TRUE @unit[1]
output Y : LREAL @doc[a long word]
output Z : DINT := 255i
constant N : DINT := -2147483648i
constant W : WORD := 255w
constant K : LREAL := -1.5r
local T : HY_TABLE := (X := [0r, 1r, 2r], Y := [0r, (- 0.0015r), 1000r])
local I : INNER
I(A := ((A * ((B + 2r) ** 2r)) - (- B)), B := ((NOT C) AND TRUE))
T(XIN := LIMIT(MN := 0r, IN := I.Y, MX := MAX(A, B, 1r)))
Y := T.XOUT
Z := (((N + 3i) MOD 15i) / 10i)
block Inner
input A : LREAL
input B : BOOL
output Y : LREAL
Y := SEL((((B = FALSE) XOR (A >= 1r)) OR ((A <> 2r) AND (NOT (A < 3r)))), A, (- A))
)");
}

TEST(Parse, AnInitialValueInParenthesesIsNoSetting) {
  EXPECT_EQ(tree("FUNCTION_BLOCK F VAR X : LREAL := (1.0 + 2.0) * 3.0; END_VAR END_FUNCTION_BLOCK"),
            "block F\nlocal X : LREAL := ((1r + 2r) * 3r)\n");
}

TEST(Parse, CallWithoutArguments) {
  EXPECT_EQ(tree("FUNCTION_BLOCK F A(); END_FUNCTION_BLOCK"), "block F\nA()\n");
}

TEST(Parse, ViewsOutliveACopyOfTheFile) {
  language::SourceFile copy;
  {
    const auto file = parse_right("FUNCTION_BLOCK LONG_LIVED A := B; END_FUNCTION_BLOCK");
    copy = file;
  }
  EXPECT_EQ(copy.blocks.at(0).name.text, "LONG_LIVED");
  EXPECT_EQ(Dump(copy).whole(), "block LONG_LIVED\nA := B\n");
}

TEST(Parse, SpansOfBlocksAndStatements) {
  const auto file = parse_right("(* x *) FUNCTION_BLOCK F\n A (X := 1.0) ;\n B := 2.0;\nEND_FUNCTION_BLOCK (* y *)");
  const auto text = [&](language::Span span) { return file.text_of(span); };
  const auto& block = file.blocks.at(0);
  EXPECT_TRUE(text(block.span).starts_with("FUNCTION_BLOCK F"));
  EXPECT_TRUE(text(block.span).ends_with("END_FUNCTION_BLOCK"));
  EXPECT_EQ(text(std::get<language::Call>(block.statements.at(0)).span), "A (X := 1.0) ;");
  EXPECT_EQ(text(std::get<language::Assignment>(block.statements.at(1)).span), "B := 2.0;");
}

TEST(Parse, AnnotationsHaveTheirPlaces) {
  const auto file = parse_right(
      "FUNCTION_BLOCK F\nVAR\n X : LREAL; (* note@home @min  -1.0 @fit @doc a b *)\nEND_VAR\nEND_FUNCTION_BLOCK");
  const auto& annotations = file.blocks.at(0).variables.at(0).annotations;
  ASSERT_EQ(annotations.size(), 3U);
  EXPECT_EQ(annotations[0].key, "min");
  EXPECT_EQ(annotations[0].value, "-1.0");
  EXPECT_EQ(annotations[1].key, "fit");
  EXPECT_EQ(annotations[1].value, "");
  EXPECT_EQ(annotations[2].value, "a b");
  const auto place = file.place(annotations[0].span);
  EXPECT_EQ(place.line, 3U);
  EXPECT_EQ(place.column, 26U);
  EXPECT_EQ(place.length, 10U);
  EXPECT_EQ(file.place(annotations[0].value_span).column, 32U);
}

TEST(Parse, CommentBehindADeclarationSpeaksOfItAndNotOfTheNext) {
  EXPECT_EQ(
      tree("FUNCTION_BLOCK F VAR X : LREAL; (* free\n text *) (* @unit um *) Y : BOOL; END_VAR END_FUNCTION_BLOCK"),
      "block F\nlocal X : LREAL @unit[um]\nlocal Y : BOOL\n");
}

TEST(Parse, NamesAreComparedWithoutRegardToCase) {
  EXPECT_TRUE(language::same_name("Rate_1", "rATE_1"));
  EXPECT_FALSE(language::same_name("RATE", "RATES"));
  EXPECT_EQ(language::upper("Rate_1"), "RATE_1");
}

TEST(Parse, LargeDiagramsAreViewsIntoTheText) {
  // One expression for each value written, and no copies of names.
  std::string text = "FUNCTION_BLOCK F VAR\n";
  constexpr std::size_t count = 20000;
  for (std::size_t i = 0; i < count; ++i) {
    text += fmt::format("S{} : HY_GAIN := (K := 2.0);\n", i);
  }
  text += "END_VAR\n";
  for (std::size_t i = 0; i < count; ++i) {
    text += fmt::format("S{}(XIN := S{}.XOUT);\n", i, (i + count - 1) % count);
  }
  const auto file = parse_right(text + "END_FUNCTION_BLOCK");
  EXPECT_EQ(file.blocks.at(0).variables.size(), count);
  EXPECT_EQ(file.blocks.at(0).statements.size(), count);
  EXPECT_EQ(file.expressions.size(), 2 * count);
  const auto& call = std::get<language::Call>(file.blocks.at(0).statements.back());
  EXPECT_EQ(call.instance.text.data(), file.text->data() + call.instance.span.offset);
}

}  // namespace
}  // namespace hysteron::test
