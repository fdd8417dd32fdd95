// Mistakes that people of other languages make: the mend says what to write for this very text.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <string>
#include <vector>

#include "support/diagnostic.hpp"
#include "tests/codegen/refusal.hpp"

namespace hysteron {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// A block with what is declared beside its ports, and its statements.
std::string block(const std::string& statements, const std::string& declared = "") {
  return fmt::format(
      "FUNCTION_BLOCK F (* @ts 1ms *) VAR_INPUT U : LREAL; A : BOOL; B : BOOL; END_VAR VAR_OUTPUT Y : LREAL; Z : BOOL; "
      "END_VAR {} {} END_FUNCTION_BLOCK",
      declared.empty() ? "" : "VAR " + declared + " END_VAR", statements);
}

/// The mends of a text, in order; none where it is accepted.
std::vector<std::string> mends_of(const std::string& text) {
  std::vector<std::string> mends;
  for (const Diagnostic& one : testing::refusals(text)) {
    if (one.severity == Severity::Error) {
      mends.push_back(one.mend);
    }
  }
  return mends;
}

TEST(PublicMistakes, AreMendedByWhatToWrite) {
  struct Mistake {
    std::string text;
    std::string mend;
  };
  const std::vector<Mistake> mistakes{
      {block("Y = U; Z := A;"), "Write := to assign"},
      {block("Y := U * 1,5; Z := A;"), "Write 1.5: the decimal mark is a point."},
      {block("Y := U; Z := U >= 0,25;"), "Write 0.25: the decimal mark is a point."},
      {block("Y := U; Z := A == B;"), "Write = to compare, once"},
      {block("Y := U; Z := A && B;"), "Write AND, or & once."},
      {block("Y := U; Z := A || B;"), "Write OR."},
      {block("Y := U; Z := U != 1.0;"), "<> for unequal"},
      {block("Y := U; Z := U => 1.0;"), "Write >= to compare."},
      {block("Y := A ? U : 0.0; Z := A;"), "SEL(CONDITION, IF_FALSE, IF_TRUE)"},
      {block("Y := U % 2.0; Z := A;"), "Write MOD"},
      {block("Y := U * 2; Z := A;"), "Write 2.0: no number is converted silently."},
      {block("Y := -3 + U; Z := A;"), "Write -3.0: no number is converted silently."},
      {block("Y := U * (1/2); Z := A;"), "Write (1.0/2.0): of whole numbers, (1/2) is cut to a whole one."},
      {block("Y := pow(U, 2.0); Z := A;"), "Write EXPT(base, exponent)"},
      {block("Y := 2.0 * PI * U; Z := A;"), "Write 3.141592653589793."},
      {block("G(U); Y := G.XOUT; Z := A;", "G : HY_GAIN;"), "Write PIN := U, with the name of the pin."},
      {block("G(XIN = U); Y := G.XOUT; Z := A;", "G : HY_GAIN;"), "Write XIN := value."},
      {block("G(IN := U); Y := G.XOUT; Z := A;", "G : HY_GAIN;"), "Did you mean XIN? Its inputs are"},
      {block("G(XIN := U); Y := G.OUT; Z := A;", "G : HY_GAIN;"), "Did you mean XOUT? Its outputs are"},
      {block("L(XIN := U); Y := L.XOUT; Z := A;", "L : HY_LAG := (T := 0.1);"), "Did you mean T1? Its inputs are"},
      {block("L(XIN := U); Y := L.XOUT; Z := A;", "L : HY_LAG := (T1 := T#100ms);"), "Write 0.1, the time in s"},
      {"PROGRAM MAIN VAR X : LREAL; END_VAR X := 1.0; END_PROGRAM", "Make it a block with inputs and outputs"},
  };
  for (const auto& [text, mend] : mistakes) {
    EXPECT_THAT(mends_of(text), ElementsAre(HasSubstr(mend))) << text;  // said once, and nothing beside it
  }
}

/// What only looks like these mistakes is not taken for one.
TEST(PublicMistakes, AreNotSeenWhereThereAreNone) {
  for (const char* const text :
       {"Y := MAX(1.0,5.0); Z := A;", "Y := U * 1.5; Z := (A) = (B);", "Y := U; Z := A & B;"}) {
    EXPECT_THAT(mends_of(block(text)), ElementsAre()) << text;
  }
  EXPECT_THAT(mends_of(block("Y := U; Z := A; D := 16#2 * U;", "D : LREAL;")),
              ElementsAre(::testing::Not(HasSubstr("16#2.0"))));
  // More than one pin holds the letter: none is guessed.
  EXPECT_THAT(mends_of(block("L(X := U); Y := L.XOUT; Z := A;", "L : HY_LAG;")),
              ElementsAre(::testing::StartsWith("Its inputs are")));
}

}  // namespace
}  // namespace hysteron
