// Annotations that do not fit, or contradict each other: HY210.
#include <gmock/gmock.h>

#include <string>

#include "support/errors.hpp"
#include "tests/codegen/refusal.hpp"

namespace hysteron::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

/// What is said of a text, all of it under HY210: causes and mends.
std::string refusal(const std::string& text) {
  std::string said;
  for (const Diagnostic& one : refusals(text)) {
    EXPECT_EQ(one.number, error::bad_annotation) << one.cause;
    said += one.cause + "\n" + one.mend + "\n";
  }
  return said.empty() ? "accepted" : said;
}

std::string with(const std::string& head, const std::string& input, const std::string& output = "",
                 const std::string& instance = "") {
  return "FUNCTION_BLOCK F " + head + "\nVAR_INPUT\nU : LREAL; " + input + "\nEND_VAR VAR_OUTPUT\nY : LREAL; " +
         output + "\nEND_VAR VAR\nG : HY_HOLD; " + instance + "\nEND_VAR\nG(XIN := U); Y := U;\nEND_FUNCTION_BLOCK";
}

TEST(Annotations, OfAKindAreGivenOnce) {
  EXPECT_THAT(refusal(with("(* @ts 1ms *) (* @ts 10ms *)", "")), HasSubstr("@ts is given twice"));
  EXPECT_THAT(refusal(with("", "", "(* @unit um @unit V *)")), HasSubstr("@unit is given twice"));
  EXPECT_THAT(refusal(with("", "", "", "(* @every 2 @EVERY 3 *)")), HasSubstr("@EVERY is given twice"));
  EXPECT_EQ(refusal(with("(* @ts 1ms *)", "(* @unit um *)", "(* @unit um *)")), "accepted");
}

TEST(Annotations, OfARangeAreInOrder) {
  EXPECT_THAT(refusal(with("", "(* @min 5.0 @max 1.0 *)")), HasSubstr("@min 5 is above @max 1"));
  EXPECT_EQ(refusal(with("", "(* @min 1.0 @max 1.0 *)")), "accepted");
}

TEST(Annotations, ThatDoNotFitAreToldThoseThatDo) {
  EXPECT_THAT(refusal(with("", "", "(* @min 0 *)")),
              AllOf(HasSubstr("@min is not an annotation that fits here"), HasSubstr("Known here: @unit, @doc.")));
  EXPECT_THAT(refusal(with("", "(* @every 4 *)")),
              HasSubstr("Known here: @unit, @min, @max, @param, @neutral, @role, @doc."));
  EXPECT_THAT(refusal(with("", "", "", "(* @unit V *)")), HasSubstr("Known here: @every, @phase, @doc."));
  EXPECT_THAT(refusal(with("(* @unit V *)", "")), HasSubstr("Known here: @ts, @effect, @family, @doc, @body."));
}

TEST(Annotations, ARoleIsOneOfThoseThatAParameterCanHave) {
  EXPECT_THAT(refusal(with("", "(* @param @role begin *)")),
              AllOf(HasSubstr("'begin' is not a role"), HasSubstr("start, reference_size, centre")));
  EXPECT_THAT(refusal(with("", "(* @param @role lower_bound *)")), HasSubstr("'lower_bound' is not a role"));
  EXPECT_THAT(refusal(with("", "(* @role start *)")), HasSubstr("'U' has a @role and is no parameter"));
  EXPECT_EQ(refusal(with("", "(* @role Start @param *)")), "accepted");
  EXPECT_EQ(refusal(with("", "(* @neutral 0.0 *) (* @role quantum *)")), "accepted");
}

TEST(Annotations, AFamilyIsKnownAndIsOfAnEffect) {
  EXPECT_THAT(refusal(with("(* @effect sag @family bending *)", "")),
              AllOf(HasSubstr("'bending' is not a family of effects"), HasSubstr("dry_friction, viscous_friction")));
  EXPECT_THAT(refusal(with("(* @family play *)", "")), HasSubstr("the block names none"));
  EXPECT_EQ(refusal(with("(* @family Static_Curve *) (* @effect sag *)", "")), "accepted");
}

TEST(Annotations, APhaseBelowZeroIsToldFromWhereItCounts) {
  EXPECT_THAT(refusal(with("", "", "", "(* @every 4 @phase -1 *)")),
              AllOf(HasSubstr("from 0 on"), HasSubstr("@phase 1")));
}

std::string inner_with(const std::string& ts, const std::string& instance) {
  return "FUNCTION_BLOCK A (* @ts " + ts +
         " *) VAR_INPUT X : LREAL; END_VAR VAR_OUTPUT Y : LREAL; END_VAR VAR D : HY_DERIVATIVE; END_VAR D(XIN := X); "
         "Y := D.XOUT; END_FUNCTION_BLOCK\n" +
         "FUNCTION_BLOCK M VAR_INPUT X : LREAL; END_VAR VAR_OUTPUT Y : LREAL; END_VAR VAR P : A; "
         "END_VAR P(X := X); Y := P.Y; END_FUNCTION_BLOCK\n" +
         "FUNCTION_BLOCK B (* @ts 1ms *) VAR_INPUT X : LREAL; END_VAR VAR_OUTPUT Y : LREAL; END_VAR VAR I : M; " +
         instance + " S : HY_SAMPLE; (* @every 5 *) H : HY_HOLD; END_VAR S(XIN := X); I(X := " +
         (instance.empty() ? "X" : "S.XOUT") + "); H(XIN := I.Y); Y := H.XOUT; END_FUNCTION_BLOCK";
}

TEST(Annotations, AnInnerSampleTimeIsThatOfItsInstance) {
  EXPECT_THAT(refusal(inner_with("5ms", "")),
              AllOf(HasSubstr("'P' runs every 0.001 s here, but A states @ts 0.005 s"), HasSubstr("by @every")));
  EXPECT_EQ(refusal(inner_with("1ms", "")), "accepted");
  EXPECT_EQ(refusal(inner_with("5ms", "(* @every 5 *)")), "accepted");
}

}  // namespace
}  // namespace hysteron::testing
