// Insertion: a changed text compiles, and an effect at its neutral setting leaves every bit as it was.
#include "diagnosis/effects/insertion.hpp"

#include <gmock/gmock.h>

#include <string>

#include "diagnosis/effects/candidates.hpp"
#include "tests/diagnosis/simulated_machine.hpp"

namespace hysteron::diagnosis {
namespace {

using testing::HasSubstr;

const language::SourceFile& source_of(const test::ReadText& read) {
  return *read.source;
}

TEST(FreeName, TakesTheWishOrANumberBehindIt) {
  const auto read = test::read_text(
      "FUNCTION_BLOCK P VAR_INPUT u : LREAL; END_VAR VAR_OUTPUT Y : LREAL; END_VAR VAR u2 : HY_GAIN; END_VAR "
      "U2(XIN := u); Y := u2.XOUT; END_FUNCTION_BLOCK",
      "P");
  EXPECT_EQ(free_name(source_of(read).blocks[0], "CREEP"), "CREEP");
  EXPECT_EQ(free_name(source_of(read).blocks[0], "U"), "U3");  // U and U2 are taken, whatever the case
}

TEST(WithEffect, WhatReadTheSignalReadsTheEffect) {
  const auto read = test::read_text(test::stack(), "STACK");
  const std::string text = with_effect(source_of(read), *find_edge(read.edges, "AMP.XOUT"),
                                       {.block = "HY_OFFSET", .instance = "AMP_OFFSET"});
  EXPECT_THAT(text, HasSubstr("AMP_OFFSET : HY_OFFSET;"));
  EXPECT_THAT(text, HasSubstr("HYST(XIN := AMP_OFFSET.XOUT)"));
  EXPECT_THAT(text, HasSubstr("AMP_OFFSET(XIN := AMP.XOUT)"));
  // 0.25 V more at the hysteresis are 0.25 V more at the input, once the lag has settled there.
  const records::Record steady = test::record_of("U", std::vector<double>(200, 1.5));
  const records::Record higher = test::record_of("U", std::vector<double>(200, 1.75));
  const Program changed = test::program_of(text, "[parameters.AMP_OFFSET]\nBIAS = 0.25\n");
  EXPECT_DOUBLE_EQ(simulate(changed, steady)[0].back(), simulate(test::program_of(test::stack()), higher)[0].back());
}

TEST(WithEffect, OneBranchAloneOrTheWholeSignal) {
  const std::string plant =
      "FUNCTION_BLOCK P (* @ts 1ms *) VAR_INPUT U : LREAL; END_VAR VAR_OUTPUT Y : LREAL; Z : LREAL; END_VAR VAR A : "
      "HY_GAIN; B : HY_GAIN; END_VAR A(XIN := U); B(XIN := U); Y := A.XOUT; Z := B.XOUT; END_FUNCTION_BLOCK";
  const auto read = test::read_text(plant, "P");
  const auto outputs = [&](const char* edge) {
    const std::string text =
        with_effect(source_of(read), *find_edge(read.edges, edge), {.block = "HY_OFFSET", .instance = "E"});
    const auto signals =
        simulate(test::program_of(text, "[parameters.E]\nBIAS = 1.0\n"), test::record_of("U", {3.0, 3.0}, 0.001));
    return std::pair(signals[0].back(), signals[1].back());
  };
  EXPECT_EQ(outputs("U"), std::pair(4.0, 4.0));
  EXPECT_EQ(outputs("A.XIN"), std::pair(4.0, 3.0));
  EXPECT_EQ(outputs("B.XIN"), std::pair(3.0, 4.0));
  EXPECT_EQ(outputs("Z"), std::pair(3.0, 4.0));
}

TEST(WithEffect, ABlockWithoutVariablesGetsASection) {
  const std::string plant =
      "FUNCTION_BLOCK P (* @ts 1ms *) VAR_INPUT U : LREAL; END_VAR VAR_OUTPUT Y : LREAL; END_VAR Y := 2.0 * U; "
      "END_FUNCTION_BLOCK";
  const auto read = test::read_text(plant, "P");
  const std::string text =
      with_effect(source_of(read), *find_edge(read.edges, "Y"), {.block = "HY_OFFSET", .instance = "E"});
  const auto signals =
      simulate(test::program_of(text, "[parameters.E]\nBIAS = 1.0\n"), test::record_of("U", {3.0, 3.0}, 0.001));
  EXPECT_EQ(signals[0].back(), 7.0);
}

TEST(WithEffect, AFurtherInputOfDefaultZeroDrivesIt) {
  const auto read = test::read_text(test::stack(), "STACK");
  const Program program = test::program_of(with_effect(
      source_of(read), *find_edge(read.edges, "HYST.XOUT"),
      {.block = "HY_SUM", .instance = "ADDED", .input = "IN1", .wires = {{"IN2", "TEMP"}}, .new_input = "TEMP"}));
  ASSERT_EQ(program.graph.inputs.size(), 2U);
  EXPECT_EQ(program.graph.inputs[1].name, "TEMP");
  EXPECT_EQ(program.graph.inputs[1].preset, 0.0);
}

TEST(WithBlock, AnInstanceOfARicherType) {
  const auto read = test::read_text(test::stack(), "STACK");
  const language::Variable* const hyst =
      read.definitions.list[read.top].variables[read.definitions.list[read.top].by_name.at("HYST")].variable;
  const Program program = test::program_of(with_block(source_of(read), *hyst, "HY_HYSTERESIS_GENERAL"));
  EXPECT_GE(find_parameter(program.graph, "HYST.ASYMMETRY"), 0);
}

/// All strengths at their neutral setting.
Program at_neutral(const Candidate& candidate) {
  Program program = *candidate.variant.program;
  const Applied& own = candidate.own();
  for (std::size_t j = 0; j < own.paths.size(); ++j) {
    const auto at = find_parameter(program.graph, own.paths[j]);
    if (at >= 0 && own.parameters[j].strength) {
      program.graph.parameters[static_cast<std::size_t>(at)].value.front() = own.parameters[j].field.neutral;
    }
  }
  return program;
}

void expect_neutral(const std::string& text, const std::string& top, const std::vector<std::string>& columns) {
  const Variant base{.text = text, .program = std::make_shared<const Program>(compile_text(text))};
  test::Noise noise(7);
  records::Record record = test::record_of(base.program->graph.inputs.front().name, noise.white(150, 1.0));
  for (const std::string& column : columns) {
    record.add({.name = column, .values = noise.white(150, 1.0)});
  }
  const auto expected = simulate(*base.program, record);
  const std::vector<Candidate> candidates = candidates_of(base, top, {.columns = columns});
  ASSERT_GT(candidates.size(), 40U);
  for (const Candidate& candidate : candidates) {
    SCOPED_TRACE(candidate.own().effect + " at " + candidate.own().edge);
    EXPECT_EQ(simulate(at_neutral(candidate), record), expected);  // every bit of every sample
  }
}

TEST(NeutralEffects, LeaveAStackAsItIs) {
  expect_neutral(test::stack(), "STACK", {"TEMP"});
}

TEST(NeutralEffects, LeaveAnAxisAsItIs) {
  expect_neutral(test::axis(), "AXIS", {});
}

TEST(NeutralEffects, LeaveANestedDiagramAsItIs) {
  expect_neutral(
      "FUNCTION_BLOCK INNER VAR_INPUT A : LREAL; END_VAR VAR_OUTPUT B : LREAL; END_VAR VAR G : HY_GAIN := (K := 3.0); "
      "L : HY_LAG := (T1 := 0.01); END_VAR G(XIN := A); L(XIN := G.XOUT + 0.5); B := L.XOUT; END_FUNCTION_BLOCK\n"
      "FUNCTION_BLOCK P (* @ts 5ms *) VAR_INPUT U : LREAL; END_VAR VAR_OUTPUT Y : LREAL; END_VAR VAR ONE : INNER; "
      "OTHER : INNER; END_VAR ONE(A := U); OTHER(A := ONE.B - U); Y := OTHER.B; END_FUNCTION_BLOCK\n",
      "P", {});
}

}  // namespace
}  // namespace hysteron::diagnosis
