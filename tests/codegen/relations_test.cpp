// Parameters of one block that cannot work together are refused, in the text of a diagram and in a parameter file.
#include "codegen/graph/relations.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <string>

#include "codegen/compile.hpp"
#include "codegen/parameters/apply.hpp"
#include "support/errors.hpp"
#include "support/render.hpp"
#include "tests/codegen/refusal.hpp"

namespace hysteron::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

std::string text_with(const std::string& part, const std::string& more = "", const std::string& ts = "1ms") {
  return "FUNCTION_BLOCK F (* @ts " + ts +
         " *) VAR_INPUT U : LREAL; END_VAR VAR_OUTPUT Y : LREAL; END_VAR\nVAR B : " + part + " END_VAR B(XIN := U" +
         more + "); Y := B.XOUT; END_FUNCTION_BLOCK";
}

/// Everything that is said of a diagram, all of it under HY214.
std::string refusal(const std::string& text) {
  std::string said;
  for (const Diagnostic& one : refusals(text)) {
    EXPECT_EQ(one.number, error::parameter_out_of_range) << one.cause;
    EXPECT_EQ(one.place.line, 2U) << one.cause;
    said += one.cause + "\n";
  }
  return said.empty() ? "accepted" : said;
}

std::string refusal_of_file(const std::string& part, const std::string& values) {
  Program program = compile_text(text_with(part));
  const std::string toml = "[parameters.B]\n" + values;
  try {
    parameters::apply(parameters::parse_parameter_file("p.toml", toml), program.graph);
    return "accepted";
  } catch (const InputError& refused) {
    Sources sources;
    sources.put("p.toml", toml);
    return as_text(refused.diagnostics(), sources);
  }
}

TEST(Relations, TheFirstColumnOfATableRises) {
  EXPECT_EQ(refusal(text_with("HY_TABLE := (X := [0.0, 1.0, 1.0], Y := [0.0, 2.0, 3.0], COUNT := 3);")),
            "B.X does not rise: 1 follows on 1, as number 3 of 3\n");
  EXPECT_EQ(refusal(text_with("HY_TABLE := (X := [0.0, 1.0, 1.0], Y := [0.0, 2.0, 3.0], COUNT := 2);")), "accepted")
      << "what is not counted is not used";
  EXPECT_EQ(refusal(text_with("HY_TABLE := (X := [0.0, 1.0], Y := [2.0, 1.0], COUNT := 2);")), "accepted");
  EXPECT_EQ(refusal(text_with("HY_M_TABLE := (P_TABLE := [0.0, 3.0, 1.0], M_TABLE := [2.0, 3.0, 7.0], COUNT := 3);",
                              ", P := U, R1 := FALSE")),
            "B.P_TABLE does not rise: 1 follows on 3, as number 3 of 3\n");
}

TEST(Relations, EveryPointThatCountsHasItsValue) {
  EXPECT_EQ(refusal(text_with("HY_TABLE := (X := [0.0, 1.0, 2.0], Y := [0.0, 2.0], COUNT := 3);")),
            "B.Y has 2 values, COUNT = 3\n");
  EXPECT_THAT(refusal(text_with("HY_TABLE := (X := [0.0, 1.0], Y := [0.0, 2.0], COUNT := 3);")),
              AllOf(HasSubstr("B.X has 2 values"), HasSubstr("B.Y has 2 values")));
}

TEST(Relations, WhatAFileMayStillSetIsLeftOpen) {
  EXPECT_EQ(refusal(text_with("HY_TABLE;")), "accepted");
  EXPECT_EQ(refusal(text_with("HY_TABLE := (COUNT := 3);")), "accepted");
}

TEST(Relations, ALowerBoundIsNotAboveTheUpperOne) {
  EXPECT_EQ(refusal(text_with("HY_LIMIT := (MN := 5.0, MX := 1.0);")), "B.MN = 5 is above MX = 1\n");
  EXPECT_EQ(refusal(text_with("HY_LIMIT := (MN := 1.0, MX := 1.0);")), "accepted");
  EXPECT_EQ(refusal(text_with("HY_LIMIT := (MN := 5.0);")), "accepted") << "MX is infinite";
  EXPECT_EQ(refusal(text_with("HY_INTEGRAL_BOUNDED := (MN := 0.0, MX := -0.5);")), "B.MN = 0 is above MX = -0.5\n");
  EXPECT_EQ(refusal("FUNCTION_BLOCK F (* @ts 1ms *) VAR_INPUT U : LREAL; END_VAR VAR_OUTPUT Y : LREAL; END_VAR\n"
                    "VAR CONSTANT TOP : LREAL := 1.0; END_VAR VAR B : HY_LIMIT := (MN := 5.0); END_VAR "
                    "B(XIN := U, MX := TOP); Y := B.XOUT; END_FUNCTION_BLOCK"),
            "B.MN = 5 is above MX = 1\n");
}

TEST(Relations, ADeadTimeFitsIntoTheSamplesThatAreHeld) {
  EXPECT_THAT(refusal(text_with("HY_DEAD_TIME := (DEAD_TIME := 5.0);")),
              HasSubstr("B.DEAD_TIME = 5 s is longer than the 1024 samples of 0.001 s"));
  EXPECT_EQ(refusal(text_with("HY_DEAD_TIME := (DEAD_TIME := 1.024);")), "accepted");
  EXPECT_EQ(refusal(text_with("HY_DEAD_TIME := (DEAD_TIME := 5.0);", "", "10ms")), "accepted");
}

TEST(Relations, ABlockThatIsUsedTwiceHasItsFaultOnce) {
  EXPECT_EQ(refusal("FUNCTION_BLOCK P VAR_INPUT X : LREAL; END_VAR VAR_OUTPUT Z : LREAL; END_VAR\nVAR B : HY_LIMIT := "
                    "(MN := 5.0, MX := 1.0); END_VAR B(XIN := X); Z := B.XOUT; END_FUNCTION_BLOCK\n"
                    "FUNCTION_BLOCK F (* @ts 1ms *) VAR_INPUT U : LREAL; END_VAR VAR_OUTPUT Y : LREAL; END_VAR "
                    "VAR A : P; C : P; END_VAR A(X := U); C(X := A.Z); Y := C.Z; END_FUNCTION_BLOCK"),
            "B.MN = 5 is above MX = 1\n");
}

/// As p0[2] for an element of the graph's first parameter, and a number for a constant.
std::string rising(const std::string& part) {
  const Program program = compile_text(text_with(part));
  const auto text_of = [](const RisingNumbers::Number& one) {
    return one.parameter ? fmt::format("p{}[{}]", *one.parameter, one.element) : fmt::format("{}", one.constant);
  };
  std::string all;
  for (const RisingNumbers& list : rising_numbers(program.graph)) {
    for (const auto& one : list.numbers) {
      all += text_of(one) + (list.strictly ? " < " : " <= ");
    }
    all += list.count ? "count " + text_of(*list.count) + "; " : "; ";
  }
  return all;
}

TEST(Relations, AreListedForWhoChangesParametersLater) {
  EXPECT_EQ(rising("HY_LIMIT := (MX := 1.0);"), "p0[0] <= p1[0] <= ; ");
  EXPECT_EQ(rising("HY_DEAD_TIME;"), "p0[0] <= 1.024000000001024 <= ; ");
  EXPECT_TRUE(rising("HY_TABLE := (X := [0.0, 1.0], Y := [2.0, 1.0], COUNT := 2);").starts_with("p0[0] < p0[1] < "));
  EXPECT_TRUE(rising("HY_TABLE := (X := [0.0, 1.0], Y := [2.0, 1.0], COUNT := 2);").ends_with(" < count p2[0]; "));
  EXPECT_EQ(rising("HY_LAG;"), "");
}

TEST(Relations, AreCheckedInAParameterFileToo) {
  const std::string table = "HY_TABLE := (X := [0.0, 1.0, 2.0], Y := [0.0, 2.0, 3.0], COUNT := 3);";
  EXPECT_THAT(refusal_of_file(table, "X = [0.0, 1.0, 1.0]\n"),
              AllOf(HasSubstr("HY214 error: p.toml:2:5: B.X does not rise"), HasSubstr("1 error")));
  EXPECT_THAT(refusal_of_file(table, "X = [0.0, 1.0]\n"), HasSubstr("B.X has 2 values, COUNT = 3"));
  EXPECT_EQ(refusal_of_file(table, "X = [0.0, 1.0]\nCOUNT = 2\n"), "accepted");
  EXPECT_THAT(refusal_of_file("HY_LIMIT := (MX := 1.0);", "MN = 5.0\n"),
              HasSubstr("HY214 error: p.toml:2:6: B.MN = 5 is above MX = 1"));
  EXPECT_EQ(refusal_of_file("HY_LIMIT := (MX := 1.0);", "MN = 5.0\nMX = 6.0\n"), "accepted");
  EXPECT_THAT(refusal_of_file("HY_DEAD_TIME;", "DEAD_TIME = 5.0\n"), HasSubstr("B.DEAD_TIME = 5 s is longer"));
}

}  // namespace
}  // namespace hysteron::testing
