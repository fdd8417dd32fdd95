// Values of a parameter file set in a diagram: names, types, lengths and ranges.
#include "codegen/parameters/apply.hpp"

#include <gmock/gmock.h>

#include <string>

#include "codegen/compile.hpp"
#include "support/errors.hpp"
#include "support/render.hpp"

namespace hysteron::parameters {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr std::string_view diagram = R"(FUNCTION_BLOCK INNER
  VAR_INPUT
    X    : LREAL;
    GAIN : LREAL := 1.0;  (* @param @min 0 @max 5 *)
  END_VAR
  VAR_OUTPUT
    Y : LREAL;
  END_VAR
  VAR
    AMP : HY_GAIN;
  END_VAR

  AMP(XIN := X * GAIN);
  Y := AMP.XOUT;
END_FUNCTION_BLOCK

FUNCTION_BLOCK TOP  (* @ts 1ms *)
  VAR_INPUT
    X    : LREAL;
    BIAS : LREAL := 0.5;    (* @param *)
    MODE : DINT := 1;       (* @param *)
    WIDE : BOOL := FALSE;   (* @param *)
    MASK : WORD := WORD#3;  (* @param *)
  END_VAR
  VAR_OUTPUT
    Y : LREAL;
    Z : DINT;
    B : BOOL;
    W : WORD;
  END_VAR
  VAR
    PART  : INNER;
    CURVE : HY_TABLE := (X := [0.0, 1.0, 2.0], Y := [0.0, 1.0, 4.0], COUNT := 3);
    HYST  : HY_HYSTERESIS_RO;
    FIXED : HY_GAIN;
  END_VAR

  FIXED(XIN := X, K := BIAS);
  PART(X := FIXED.XOUT);
  CURVE(XIN := PART.Y);
  HYST(XIN := CURVE.XOUT);
  Y := HYST.XOUT + BIAS;
  Z := MODE;
  B := WIDE;
  W := MASK;
END_FUNCTION_BLOCK
)";

class Apply : public ::testing::Test {
 protected:
  Program program = compile_text(std::string(diagram), {.top = "TOP"});

  const std::vector<double>& value(std::string_view path) {
    return program.graph.parameters[static_cast<std::size_t>(find_parameter(program.graph, path))].value;
  }

  void set(std::string_view toml) { apply(parse_parameter_file("p.toml", toml), program.graph); }

  std::string refusal(std::string_view toml) {
    try {
      set(toml);
    } catch (const InputError& refused) {
      Sources sources;
      sources.put("p.toml", toml);
      return as_text(refused.diagnostics(), sources);
    }
    return "accepted";
  }
};

TEST_F(Apply, SetsValuesByPathWithoutRegardToCase) {
  set("[parameters]\nbias = 2\nMODE = -3\nWide = true\nmask = 65535\n"
      "[parameters.Part]\ngain = 2.5\n[parameters.PART.amp]\nK = 7.25\n");
  EXPECT_EQ(value("BIAS"), std::vector{2.0});
  EXPECT_EQ(value("MODE"), std::vector{-3.0});
  EXPECT_EQ(value("WIDE"), std::vector{1.0});
  EXPECT_EQ(value("MASK"), std::vector{65535.0});
  EXPECT_EQ(value("PART.GAIN"), std::vector{2.5});
  EXPECT_EQ(value("PART.AMP.K"), std::vector{7.25});
}

TEST_F(Apply, WhatTheFileDoesNotNameStays) {
  set("[parameters]\nBIAS = 2.0\n");
  EXPECT_EQ(value("MODE"), std::vector{1.0});
  EXPECT_EQ(value("CURVE.COUNT"), std::vector{3.0});
}

TEST_F(Apply, AListReplacesAWholeArray) {
  set("[parameters.CURVE]\nX = [1.0, 2]\nCOUNT = 2\n");
  std::vector<double> expected(value("CURVE.X").size(), 0.0);
  expected[0] = 1.0;
  expected[1] = 2.0;
  EXPECT_EQ(value("CURVE.X"), expected);
  std::string long_list = "[parameters.CURVE]\nX = [0.0";
  for (int i = 1; i <= 32; ++i) {
    long_list += ", " + std::to_string(i) + ".0";
  }
  EXPECT_THAT(refusal(long_list + "]\n"), HasSubstr("CURVE.X takes at most 32 numbers, here are 33."));
}

TEST_F(Apply, TypesAreChecked) {
  EXPECT_EQ(refusal("[parameters]\nWIDE = 1\n"),
            "HY604 error: p.toml:2:8: WIDE takes true or false, not 1.\n"
            "    2 | WIDE = 1\n"
            "      |        ^\n"
            "mend: write it as in WIDE = true.\n\n1 error\n");
  EXPECT_THAT(refusal("[parameters]\nMODE = 1.5\n"), HasSubstr("MODE takes a whole number, not 1.5."));
  EXPECT_THAT(refusal("[parameters]\nBIAS = true\n"), HasSubstr("BIAS takes a number, not true."));
  EXPECT_THAT(refusal("[parameters]\nBIAS = [1.0]\n"), HasSubstr("BIAS takes a number, not a list of 1."));
  EXPECT_THAT(refusal("[parameters.CURVE]\nX = 1.0\n"), HasSubstr("CURVE.X takes a list of numbers, not 1."));
}

TEST_F(Apply, RangesAreChecked) {
  EXPECT_EQ(refusal("[parameters.PART]\nGAIN = 5.5\n"),
            "HY214 error: p.toml:2:8: PART.GAIN = 5.5 lies outside of its range.\n"
            "    2 | GAIN = 5.5\n"
            "      |        ^^^\n"
            "mend: GAIN must be at least 0 and at most 5.\n\n1 error\n");
  set("[parameters.PART]\nGAIN = 5\n");
  EXPECT_THAT(refusal("[parameters.HYST]\nC1 = 0\n"), HasSubstr("C1 must be above 0."));
  EXPECT_THAT(refusal("[parameters]\nMASK = 65536\n"), HasSubstr("MASK must be at least 0 and at most 65535."));
  EXPECT_THAT(refusal("[parameters]\nMODE = 3000000000\n"), HasSubstr("at most 2147483647."));
  EXPECT_THAT(refusal("[parameters.CURVE]\nCOUNT = 1\n"), HasSubstr("COUNT must be at least 2 and at most 32."));
}

TEST_F(Apply, NamesAreChecked) {
  EXPECT_THAT(
      refusal("[parameters.HYST]\nCC1 = 1.0\n"),
      AllOf(HasSubstr("HY603 error: p.toml:2:1: TOP has no parameter HYST.CC1."), HasSubstr("did you mean HYST.C1?")));
  EXPECT_THAT(refusal("[parameters]\nQQQQQQ = 1.0\n"), HasSubstr("the parameters are BIAS, "));
  EXPECT_THAT(refusal("[parameters]\nX = 1.0\n"), HasSubstr("X is an input of the diagram, not a parameter."));
  EXPECT_THAT(refusal("[parameters.FIXED]\nK = 1.0\n"),
              HasSubstr("FIXED.K is not free to be set: the diagram connects or fixes it."));
  EXPECT_THAT(refusal("[parameters.FIXED]\nXIN = 1.0\n"),
              AllOf(HasSubstr("HY603 error: p.toml:2:1: FIXED.XIN is an input of HY_GAIN, not a parameter."),
                    HasSubstr("mark it (* @param *)")));
}

TEST_F(Apply, SetsWhereStatesBegin) {
  set("[initial.hyst]\nbranch_y = 3\nBRANCH_X = -0.5\n");
  set("[initial.HYST]\nBRANCH_Y = 4.5\n");
  const Graph& graph = program.graph;
  ASSERT_EQ(graph.initial_states.size(), 2U);
  const InitialState& last = graph.initial_states.back();
  EXPECT_EQ(graph.nodes[last.node].path, "HYST");
  EXPECT_EQ(graph.nodes[last.node].block->states[last.state].name, "BRANCH_Y");
  EXPECT_EQ(last.value, 4.5);
  EXPECT_THAT(refusal("[initial.HYST]\nBRANCH_Q = 1.0\n"),
              AllOf(HasSubstr("HY603 error: p.toml:2:1: TOP has no state HYST.BRANCH_Q that is a real number."),
                    HasSubstr("did you mean HYST.BRANCH_")));
  EXPECT_THAT(refusal("[initial.HYST]\nBRANCH_Y = true\n"),
              HasSubstr("HY604 error: p.toml:2:12: HYST.BRANCH_Y takes a number, not true."));
}

TEST_F(Apply, EveryFaultIsReportedAndNothingElseIsLost) {
  const auto text = refusal("[parameters]\nBIAS = true\nMODE = 1.5\nNONE = 1\n");
  EXPECT_THAT(text, AllOf(HasSubstr(":2:8:"), HasSubstr(":3:8:"), HasSubstr(":4:1:"), HasSubstr("3 errors")));
}

}  // namespace
}  // namespace hysteron::parameters
