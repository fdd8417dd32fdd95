// Vectors within a step: where a loop is written, and where none is. That the loops have the bits of the interpreter,
// the tests over random diagrams hold.
#include "codegen/backends/st/st.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "codegen/backends/a2l/a2l.hpp"
#include "codegen/backends/batch/batch.hpp"
#include "codegen/backends/c/c.hpp"
#include "codegen/backends/shared/value_shapes.hpp"

namespace hysteron::testing {
namespace {

std::string numbers(std::size_t count) {
  std::vector<std::string> list;
  for (std::size_t i = 0; i < count; ++i) {
    list.push_back(fmt::format("0.{}", i % 9 + 1));
  }
  return fmt::format("[{}]", fmt::join(list, ", "));
}

Program state_space(std::size_t n) {
  return compile_text(
      fmt::format("FUNCTION_BLOCK T (* @ts 1ms *) VAR_INPUT U : LREAL; R : BOOL; END_VAR VAR_OUTPUT Y : LREAL; END_VAR "
                  "VAR S : HY_STATE_SPACE := (A := {}, B := {}, C := {}, D := [0.5]); END_VAR\n"
                  "S(U := U, R1 := R); Y := S.Y; END_FUNCTION_BLOCK",
                  numbers(n * n), numbers(n), numbers(n)));
}

/// The function of a step in C.
std::string step_in_c(const Program& program) {
  const std::string text = generate_c(program).back().text;
  return text.substr(text.find("_step("));
}

std::size_t count_of(std::string_view text, std::string_view part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string_view::npos; at = text.find(part, at + 1)) {
    ++count;
  }
  return count;
}

TEST(StepLoops, AStepIsAsLongForSixteenStatesAsForTwelve) {
  const std::string twelve = step_in_c(state_space(12));
  const std::string sixteen = step_in_c(state_space(16));
  EXPECT_EQ(count_of(twelve, "\n"), count_of(sixteen, "\n")) << sixteen;
  EXPECT_LT(count_of(sixteen, "\n"), 60U) << sixteen;
}

TEST(StepLoops, BelowThreeElementsLinesAreWrittenOut) {
  EXPECT_EQ(count_of(step_in_c(state_space(2)), "for ("), 0U);
  EXPECT_GT(count_of(step_in_c(state_space(shortest_loop)), "for ("), 0U);
}

std::string matrix_gain_in_c(std::size_t rows, std::size_t columns) {
  return step_in_c(compile_text(fmt::format(
      "FUNCTION_BLOCK T (* @ts 1ms *) VAR_INPUT X : ARRAY[0..{}] OF LREAL; END_VAR VAR_OUTPUT Y : ARRAY[0..{}] OF "
      "LREAL; "
      "END_VAR VAR K : HY_MATRIX_GAIN := (K := {}, ROWS := {}); END_VAR\nK(XIN := X); Y := K.XOUT; END_FUNCTION_BLOCK",
      columns - 1, rows - 1, numbers(rows * columns), rows)));
}

Program continuous(std::size_t poles, std::size_t zeros) {
  return compile_text(
      fmt::format("FUNCTION_BLOCK T (* @ts 1ms *) VAR_INPUT U : LREAL; R : BOOL; END_VAR VAR_OUTPUT Y : LREAL; END_VAR "
                  "VAR G : HY_TRANSFER_FUNCTION_S := (NUM := {}, DEN := {}); END_VAR\n"
                  "G(XIN := U, R1 := R); Y := G.XOUT; END_FUNCTION_BLOCK",
                  numbers(zeros + 1), numbers(poles + 1)));
}

/// Each integrator of the chain reads the one before, and each power of c the last.
TEST(StepLoops, AChainIsALoop) {
  for (const std::size_t zeros : {0U, 4U, 9U}) {
    const std::string twelve = step_in_c(continuous(12, zeros));
    const std::string sixteen = step_in_c(continuous(16, zeros));
    EXPECT_EQ(count_of(twelve, "\n"), count_of(sixteen, "\n")) << sixteen;
    EXPECT_LT(count_of(sixteen, "\n"), 70U) << sixteen;
  }
  const std::string step = step_in_c(continuous(5, 0));
  EXPECT_NE(step.find("  for (size_t i = 0U; i < 4U; ++i) {\n"
                      "    g_product[i + 1U] = g_product[i] * g_product[0];\n"
                      "  }\n"),
            std::string::npos)
      << step;
}

TEST(StepLoops, ADifferenceOfManyTermsIsALoop) {
  const std::string text = generate_st(continuous(6, 0), {.dialect = *st_dialect("portable")}).front().text;
  EXPECT_NE(text.find("  G_DIFFERENCE := U;\n"
                      "  FOR TERM := 0 TO 5 DO\n"
                      "    G_DIFFERENCE := G_DIFFERENCE - G_DEN[TERM + 1] * G_SUM[TERM];\n"
                      "  END_FOR;\n"),
            std::string::npos)
      << text;
}

/// Four values behind the first one are the shortest chain: below, the lines take less flash.
TEST(StepLoops, AShortChainStaysLines) {
  EXPECT_EQ(count_of(step_in_c(continuous(4, 0)), "for ("), 0U);
  EXPECT_GT(count_of(step_in_c(continuous(5, 0)), "for ("), 2U);
}

/// Up to eight terms are one line, and two rows of them share a round of the loop.
TEST(StepLoops, TwoRowsOfShortSumsAtOnce) {
  const std::string step = matrix_gain_in_c(5, 3);
  EXPECT_NE(
      step.find("  for (size_t i = 0U; i < 4U; i += 2U) {\n"
                "    const double sum = (params->k.k[3U * i] * in->x[0]) + (params->k.k[(3U * i) + 1U] * in->x[1]) + "
                "(params->k.k[(3U * i) + 2U] * in->x[2]);\n"
                "    const double sum_2 = (params->k.k[(3U * i) + 3U] * in->x[0]) + (params->k.k[(3U * i) + 4U] * "
                "in->x[1]) + (params->k.k[(3U * i) + 5U] * in->x[2]);\n"
                "    k_xout[i] = sum;\n"
                "    k_xout[i + 1U] = sum_2;\n"
                "  }\n"
                "  k_xout[4] = (params->k.k[12] * in->x[0]) + (params->k.k[13] * in->x[1]) + "
                "(params->k.k[14] * in->x[2]);\n"),
      std::string::npos)
      << step;
}

/// Nine terms and more are a loop, and four rows add side by side in it; the rows that are left over do so, too.
TEST(StepLoops, FourRowsOfLongSumsAtOnce) {
  const std::string step = matrix_gain_in_c(11, shortest_sum_at_once);
  EXPECT_EQ(count_of(step, "for ("), 4U) << step;  // rows, their terms, the terms of what is left, and the copy
  EXPECT_NE(step.find("  for (size_t i = 0U; i < 8U; i += 4U) {\n"
                      "    double sum = params->k.k[9U * i] * in->x[0];\n"
                      "    double sum_2 = params->k.k[(9U * i) + 9U] * in->x[0];\n"),
            std::string::npos)
      << step;
  EXPECT_NE(step.find("      sum_4 = sum_4 + (params->k.k[(9U * i) + k + 27U] * in->x[k]);\n    }\n"
                      "    k_xout[i] = sum;\n"),
            std::string::npos)
      << step;
  EXPECT_NE(step.find("    k_sum_3 = k_sum_3 + (params->k.k[k + 90U] * in->x[k]);\n  }\n  k_xout[8] = k_sum;\n"),
            std::string::npos)
      << step;
}

/// A PLC gets one row at a time: its text is to be short.
TEST(StepLoops, StructuredTextHasARowAtATime) {
  const std::string text = generate_st(state_space(16), {}).front().text;
  EXPECT_NE(text.find("TO 15 DO\n"), std::string::npos) << text;
  EXPECT_EQ(text.find(" BY "), std::string::npos) << text;
}

/// V := A + B: an array and a loop, where more than one value reads it; what reads it is a loop, too.
TEST(StepLoops, AVectorOfADiagramIsALocalArray) {
  const Program program = compile_text(
      "FUNCTION_BLOCK T (* @ts 1ms *) VAR_INPUT A, B : ARRAY[0..3] OF LREAL; END_VAR VAR_OUTPUT Y : ARRAY[0..3] OF "
      "LREAL; Z : LREAL; END_VAR VAR V : ARRAY[0..3] OF LREAL; W : ARRAY[0..3] OF LREAL; END_VAR\n"
      "V := A + B; W := V * 2.0 + A; Y := V - W; Z := DOT(V, W); END_FUNCTION_BLOCK");
  const std::string step = step_in_c(program);
  EXPECT_NE(step.find("  double v[4];\n  for (size_t i = 0U; i < 4U; ++i) {\n    v[i] = in->a[i] + in->b[i];\n  }\n"),
            std::string::npos)
      << step;
  EXPECT_NE(step.find("    w[i] = (v[i] * 2.0) + in->a[i];\n"), std::string::npos) << step;
  EXPECT_NE(step.find("    out->y[i] = v[i] - w[i];\n"), std::string::npos) << step;
  EXPECT_NE(step.find("(v[0] * w[0]) + (v[1] * w[1]) + (v[2] * w[2]) + (v[3] * w[3])"), std::string::npos) << step;
  EXPECT_NE(generate_st(program, {}).front().text.find("V[PLACE] := A[PLACE] + B[PLACE];"), std::string::npos);
}

/// Elements that are set one after the other, each from the one before, are lines.
TEST(StepLoops, ElementsThatNeedEachOtherStayLines) {
  const std::string step = step_in_c(compile_text(
      "FUNCTION_BLOCK T (* @ts 1ms *) VAR_INPUT A : ARRAY[0..3] OF LREAL; END_VAR VAR_OUTPUT Y, Z : LREAL; "
      "END_VAR VAR V : ARRAY[0..3] OF LREAL; END_VAR\nV[0] := A[0]; V[1] := V[0] + A[1]; V[2] := V[1] + "
      "A[2]; V[3] := V[2] + A[3]; Y := V[1] * V[2] + V[3]; Z := V[3]; END_FUNCTION_BLOCK"));
  EXPECT_EQ(count_of(step, "for ("), 0U) << step;
}

/// The elements of an array get their values from a table, so that a matrix takes no code for each.
TEST(StepLoops, DefaultsOfAMatrixAreATable) {
  const std::string text =
      generate_c(compile_text("FUNCTION_BLOCK T (* @ts 1ms *) VAR_INPUT X : ARRAY[0..2] OF LREAL; END_VAR VAR_OUTPUT "
                              "Y : ARRAY[0..1] OF LREAL; END_VAR VAR K : HY_MATRIX_GAIN := (K := [1.0, 2.0, 3.0, 4.0, "
                              "5.0, -6.5], ROWS := 2); END_VAR\nK(XIN := X); Y := K.XOUT; END_FUNCTION_BLOCK"))
          .back()
          .text;
  EXPECT_NE(text.find("  {\n    static const double values[6] = {\n        1.0, 2.0, 3.0, 4.0, 5.0, -6.5};\n"
                      "    for (size_t i = 0U; i < 6U; ++i) {\n      params->k.k[i] = values[i];\n    }\n  }\n"
                      "  for (size_t i = 0U; i < 3U; ++i) {\n    in->x[i] = 0.0;\n  }\n"),
            std::string::npos)
      << text;
}

/// In a diagram without a vector nothing is a loop, and no word is kept for one.
TEST(StepLoops, ASumOfSignalsStaysALine) {
  const std::string step = step_in_c(
      compile_text("FUNCTION_BLOCK T (* @ts 1ms *) VAR_INPUT A, B, C, D : LREAL; END_VAR VAR_OUTPUT Y, Z : LREAL; "
                   "END_VAR\nY := A + B + C + D; Z := (A * 2.0 + B * 2.0 + C * 2.0) * D; END_FUNCTION_BLOCK"));
  EXPECT_EQ(count_of(step, "for ("), 0U) << step;
  EXPECT_NE(step.find("out->y = in->a + in->b + in->c + in->d;"), std::string::npos) << step;
}

/// A sum begins with its first term: 0 before it would make +0 of -0.
TEST(StepLoops, ASumBeginsWithItsFirstTerm) {
  const std::string step = step_in_c(
      compile_text("FUNCTION_BLOCK T (* @ts 1ms *) VAR_INPUT X : ARRAY[0..8] OF LREAL; END_VAR VAR_OUTPUT Y : LREAL; "
                   "END_VAR\nY := SUM(X); END_FUNCTION_BLOCK"));
  EXPECT_NE(step.find(" = in->x[0];\n  for (size_t k = 1U; k < 9U; ++k)"), std::string::npos) << step;
}

/// Rows of a transfer function differ where its numerator ends; only those that are alike are a loop.
TEST(StepLoops, RowsThatDifferInMoreStayLines) {
  const std::string step = step_in_c(
      compile_text("FUNCTION_BLOCK T (* @ts 1ms *) VAR_INPUT X : LREAL; END_VAR VAR_OUTPUT Y : LREAL; END_VAR VAR F : "
                   "HY_TRANSFER_FUNCTION := (NUM := [1.0, 0.5], DEN := [1.0, 0.2, 0.1, 0.05, 0.01, 0.001]); END_VAR\n"
                   "F(XIN := X); Y := F.XOUT; END_FUNCTION_BLOCK"));
  EXPECT_EQ(count_of(step, "for ("), 1U) << step;
  EXPECT_NE(step.find("state->f.s[i] = "), std::string::npos) << step;
  EXPECT_NE(step.find("state->f.s[3] = "), std::string::npos) << step;
  EXPECT_NE(step.find("state->f.s[4] = "), std::string::npos) << step;
}

TEST(StepLoops, AStateIsAnArrayForEveryCaller) {
  const Program program = state_space(4);
  EXPECT_NE(generate_c(program).front().text.find("double x[4];  // state of the next step"), std::string::npos);
  EXPECT_NE(generate_batch(program).text.find("std::array<Real, 4> x{};"), std::string::npos);
  EXPECT_NE(generate_st(program, {}).front().text.find("S_X : ARRAY[0..3] OF LREAL;"), std::string::npos);
  const std::string a2l = generate_a2l(program, {}).text;
  const std::size_t entry = a2l.find("/begin MEASUREMENT T.S.X ");
  ASSERT_NE(entry, std::string::npos) << a2l;
  EXPECT_NE(a2l.substr(entry, 300).find("MATRIX_DIM 4 1 1"), std::string::npos) << a2l.substr(entry, 300);
}

}  // namespace
}  // namespace hysteron::testing
