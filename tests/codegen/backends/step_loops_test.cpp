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

TEST(StepLoops, AStepIsAsLongForSixteenStatesAsForThree) {
  const std::string three = step_in_c(state_space(3));
  const std::string sixteen = step_in_c(state_space(16));
  EXPECT_EQ(count_of(three, "\n"), count_of(sixteen, "\n")) << sixteen;
  EXPECT_LT(count_of(sixteen, "\n"), 40U) << sixteen;
}

TEST(StepLoops, BelowThreeElementsLinesAreWrittenOut) {
  EXPECT_EQ(count_of(step_in_c(state_space(2)), "for ("), 0U);
  EXPECT_GT(count_of(step_in_c(state_space(shortest_loop)), "for ("), 0U);
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
      compile_text("FUNCTION_BLOCK T (* @ts 1ms *) VAR_INPUT X : ARRAY[0..4] OF LREAL; END_VAR VAR_OUTPUT Y : LREAL; "
                   "END_VAR\nY := SUM(X); END_FUNCTION_BLOCK"));
  EXPECT_NE(step.find(" = in->x[0];\n  for (uint32_t k = 1U; k < 5U; ++k)"), std::string::npos) << step;
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
