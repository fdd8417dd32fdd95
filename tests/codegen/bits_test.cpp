// Bits of words: what is refused, and that each mend is a text that is taken.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "support/errors.hpp"
#include "tests/codegen/refusal.hpp"

namespace hysteron::testing {
namespace {

using ::testing::HasSubstr;

std::vector<Diagnostic> refusals_of_body(const std::string& statements) {
  return refusals(
      "FUNCTION_BLOCK F\nVAR_INPUT W, X : WORD; N : DINT; R : LREAL; B : BOOL; V : ARRAY[0..2] OF WORD; END_VAR\n"
      "VAR_OUTPUT Y : BOOL; Z : WORD; END_VAR\n" +
      statements + "\nEND_FUNCTION_BLOCK\n");
}

/// The mend of the only error; empty where there is none.
std::string mend_of_value(const std::string& expression) {
  const auto found = refusals_of_body("Z := W; Y := " + expression + ";");
  EXPECT_LE(found.size(), 1U) << expression;
  return found.empty() ? "" : found[0].mend;
}

std::string mend_of_statement(const std::string& statement) {
  const auto found = refusals_of_body("Y := B; " + statement);
  for (const Diagnostic& one : found) {
    if (one.number == error::pin_assignment || one.number == error::refused_access) {
      return one.mend;
    }
  }
  return "";
}

TEST(Bits, AComparisonWithAPatternSaysItsBrackets) {
  EXPECT_EQ(mend_of_value("W AND 16#6F = 16#27"),
            "= is done before the operation on bits. Write (W AND 16#6F) = 16#27.");
  EXPECT_EQ(mend_of_value("16#27 <> 16#6F OR W"),
            "<> is done before the operation on bits. Write 16#27 <> (16#6F OR W).");
  EXPECT_EQ(mend_of_value("(W AND 16#6F) = 16#27"), "");
  EXPECT_EQ(mend_of_value("16#27 <> (16#6F OR W)"), "");
  EXPECT_THAT(mend_of_value("(N AND 16#FF) = 3"), HasSubstr("DINT_TO_WORD converts."));
}

TEST(Bits, ABitThatAWordDoesNotHaveIsTold) {
  for (const std::string digits : {"16", "3E0", "16#1F", "1_0"}) {
    EXPECT_EQ(mend_of_value("W." + digits), "Its bits are 0 to 15; bit 0 is the lowest.") << digits;
  }
  EXPECT_EQ(mend_of_value("W.16#A"), "Write .10.");
  EXPECT_EQ(mend_of_value("W. 3"), "Write W.3.");
}

/// The mend names the type that has no bits, and not the operation that a bit stands for.
TEST(Bits, WhatIsNoWordHasNoBits) {
  EXPECT_EQ(mend_of_value("N.3"), "Write (DINT_TO_WORD(N) AND 16#8) <> 16#0.");
  EXPECT_EQ(mend_of_value("R.0"), "Write (DINT_TO_WORD(LREAL_TO_DINT(R)) AND 16#1) <> 16#0.");
  EXPECT_EQ(mend_of_value("B.3"), "A BOOL is a single bit: write B.");
  EXPECT_EQ(mend_of_value("V.3"), "Write V[2] for an element, V[0].3 for a bit of one.");
  EXPECT_EQ(mend_of_value("V[1].3"), "");
}

TEST(Bits, TheSpellingsOfOtherEditorsSayTheOneHere) {
  EXPECT_EQ(mend_of_value("W.X3"), "A bit of a WORD is written by its number alone: W.3.");
  EXPECT_EQ(mend_of_value("W.%X3"), "Write the number of the bit alone: .3.");
  EXPECT_THAT(mend_of_value("W.%B1"), HasSubstr("SHR(W, 8)"));
}

TEST(Bits, AValueWithoutANameIsMasked) {
  EXPECT_EQ(mend_of_value("(W AND X).3"),
            "Write ((W AND X) AND 16#8) <> 16#0, or give the value to a WORD of its own: NAME.3.");
  EXPECT_THAT(mend_of_value("SHR(W, 2).15"), HasSubstr("Write (SHR(W, 2) AND 16#8000) <> 16#0"));
}

TEST(Bits, AtTheDepthThatIsAllowedNothingBreaks) {
  for (std::size_t depth = 250; depth < 258; ++depth) {
    const std::string index = std::string(depth, '(') + "0" + std::string(depth, ')');
    (void)refusals_of_body("Z := W; Y := V[" + index + "].3;");
    std::string sum = "0";
    for (std::size_t i = 0; i < depth; ++i) {
      sum += " + 0";
    }
    const auto found = refusals_of_body("Z := W; Y := V[" + sum + "].3;");
    EXPECT_TRUE(found.empty() || found[0].number == error::nested_too_deeply) << depth;
  }
}

TEST(Bits, WhatAMendSaysIsTaken) {
  for (const std::string expression :
       {"(DINT_TO_WORD(N) AND 16#8) <> 16#0", "(DINT_TO_WORD(LREAL_TO_DINT(R)) AND 16#1) <> 16#0",
        "((W AND X) AND 16#8) <> 16#0", "(SHR(W, 2) AND 16#8000) <> 16#0", "W.10", "V[0].3",
        "(SHR(W, 8) AND 16#FF) = 16#1"}) {
    EXPECT_EQ(mend_of_value(expression), "");
  }
  EXPECT_TRUE(refusals_of_body("Y := B; Z := SEL(B, WORD#0, WORD#16#8) OR SEL(Y, WORD#0, WORD#16#1);").empty());
}

TEST(Bits, ABitThatIsAssignedByItselfSaysHowAWordIsMade) {
  EXPECT_THAT(mend_of_statement("Z.3 := B;"), HasSubstr("Z := SEL(BIT3, WORD#0, WORD#16#8) OR"));
  EXPECT_THAT(mend_of_statement("Z.X3 := B;"), HasSubstr("Z := SEL(BIT3, WORD#0, WORD#16#8) OR"));
  EXPECT_THAT(mend_of_statement("Z.16 := B;"), HasSubstr("0 to 15"));
  EXPECT_THAT(mend_of_statement("Z.%X3 := B;"), HasSubstr(".3"));
  EXPECT_THAT(mend_of_statement("Z.PIN := B;"), HasSubstr("write Z :="));
}

}  // namespace
}  // namespace hysteron::testing
