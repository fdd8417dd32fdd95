// What means something else elsewhere (HY217): one test for each row of the table, and the page that shows it.
#include "codegen/graph/portability.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "codegen/compile.hpp"
#include "codegen/interpreter/machine.hpp"
#include "support/errors.hpp"

namespace hysteron::testing {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::string formula_text(const std::string& type, const std::string& expression) {
  return fmt::format(
      "FUNCTION_BLOCK T (* @ts 1ms *)\nVAR_INPUT X, Z : LREAL; N, M : DINT; B : BOOL; END_VAR\nVAR_OUTPUT Y : {}; "
      "END_VAR\nVAR CONSTANT E : LREAL := 0.1; LAST : DINT := 2; END_VAR\nY := {};\nEND_FUNCTION_BLOCK\n",
      type, expression);
}

std::vector<Diagnostic> findings_of_formula(const std::string& type, const std::string& expression) {
  Diagnostics diagnostics;
  check(std::make_shared<const language::SourceFile>(language::parse("t", formula_text(type, expression), diagnostics)),
        diagnostics);
  return diagnostics.all();
}

/// Told once, as a warning, with a cause and a mend that hold these words.
void expect_other_meaning(const std::string& type, const std::string& expression, const std::string& cause,
                          const std::string& mend) {
  const auto found = findings_of_formula(type, expression);
  ASSERT_EQ(found.size(), 1U) << expression;
  EXPECT_EQ(found[0].number, error::other_meaning_elsewhere) << found[0].cause;
  EXPECT_EQ(found[0].severity, Severity::Warning);
  EXPECT_THAT(found[0].cause, HasSubstr(cause)) << expression;
  EXPECT_THAT(found[0].mend, HasSubstr(mend)) << expression;
}

void expect_one_meaning(const std::string& type, const std::string& expression) {
  for (const Diagnostic& one : findings_of_formula(type, expression)) {
    ADD_FAILURE() << expression << ": " << one.cause;
  }
}

/// The value of an expression for some inputs.
double formula_value(const std::string& type, const std::string& expression, double x, int n, int m) {
  Machine<double> machine(compile_text(formula_text(type, expression)));
  machine.set_input(0, x);
  machine.set_input(2, n);
  machine.set_input(3, m);
  machine.step();
  return machine.output(0);
}

TEST(Portability, ANumberWithoutATypeBesideTrunc) {
  expect_other_meaning("BOOL", "TRUNC(X) > 5", "MATIEC infers ULINT", "DINT#5");
  expect_other_meaning("BOOL", "-3 <= TRUNC(X) + 1", "TRUNC gives a DINT", "DINT#-3");
  expect_other_meaning("DINT", "MAX(1, TRUNC(X))", "MATIEC infers ULINT", "DINT#1");
  expect_other_meaning("DINT", "LIMIT(0, TRUNC(X), 9)", "MATIEC infers ULINT", "DINT#0");
  expect_other_meaning("BOOL", "TRUNC(X) = TRUNC(Z)", "MATIEC infers ULINT", "variable of type DINT");
  expect_one_meaning("BOOL", "TRUNC(X) > DINT#5");
  expect_one_meaning("DINT", "MAX(DINT#1, TRUNC(X))");
  expect_one_meaning("BOOL", "TRUNC(X) > N");
  expect_one_meaning("BOOL", "TRUNC(X) + N > 5");
  expect_one_meaning("DINT", "TRUNC(X) + 5");
  expect_one_meaning("BOOL", "N > 5");
  for (const double x : {-7.5, -1.5, 5.5, 6.5}) {
    EXPECT_EQ(formula_value("BOOL", "TRUNC(X) > DINT#5", x, 0, 0), formula_value("BOOL", "TRUNC(X) > 5", x, 0, 0));
  }
}

TEST(Portability, BoundsOfLimitThatCross) {
  expect_other_meaning("DINT", "LIMIT(5, N, 2)", "the lower bound of LIMIT is above the upper one",
                       "MIN(MAX(IN, MN), MX)");
  expect_other_meaning("LREAL", "LIMIT(MN := 1.0, IN := X, MX := -E)", "above the upper one", "in their order");
  expect_one_meaning("DINT", "LIMIT(2, N, 5)");
  expect_one_meaning("LREAL", "LIMIT(-E, X, E)");
  expect_one_meaning("DINT", "MIN(MAX(N, 5), 2)");
  for (const int n : {-7, 3, 9}) {
    EXPECT_EQ(formula_value("DINT", "LIMIT(5, N, 2)", 0, n, 0), formula_value("DINT", "MIN(MAX(N, 5), 2)", 0, n, 0));
  }
}

TEST(Portability, AnIndexOfMuxThatMayLieOutside) {
  expect_other_meaning("LREAL", "MUX(N, X, Z, 1.0)", "may lie outside of 0 … 2", "MUX(LIMIT(0, N, 2), …)");
  expect_other_meaning("LREAL", "MUX(5, X, Z, 1.0)", "may lie outside", "LIMIT(0, 5, 2)");
  expect_other_meaning("LREAL", "MUX(LIMIT(0, N, 3), X, Z, 1.0)", "may lie outside", "LIMIT(0, ");
  expect_one_meaning("LREAL", "MUX(LIMIT(0, N, LAST), X, Z, 1.0)");
  expect_one_meaning("LREAL", "MUX(LAST, X, Z, 1.0)");
  expect_one_meaning("LREAL", "MUX(BOOL_TO_DINT(B), X, Z)");
  for (const int n : {-1, 0, 2, 5}) {
    EXPECT_EQ(formula_value("LREAL", "MUX(N, X, 2.0 * X, 1.0)", 3.0, n, 0),
              formula_value("LREAL", "MUX(LIMIT(0, N, 2), X, 2.0 * X, 1.0)", 3.0, n, 0));
  }
}

TEST(Portability, HalvesThatAreRounded) {
  expect_other_meaning("DINT", "LREAL_TO_DINT(X)", "STruC++: away from zero: 3", "TRUNC(X + SEL(X < 0.0, 0.5, -0.5))");
  expect_other_meaning("DINT", "LREAL_TO_DINT(-2.5)", "away from zero", "TRUNC");
  expect_one_meaning("DINT", "LREAL_TO_DINT(2.25) + LREAL_TO_DINT(DINT_TO_LREAL(N))");
  expect_one_meaning("DINT", "TRUNC(X + SEL(X < 0.0, 0.5, -0.5))");
  const std::string away = "TRUNC(X + SEL(X < 0.0, 0.5, -0.5))";
  for (const double x : {-3.5, -2.5, -0.4, 0.0, 0.5, 1.4, 2.5}) {
    EXPECT_EQ(formula_value("DINT", away, x, 0, 0), std::round(x)) << "away from zero, as the page says";
  }
}

TEST(Portability, AnExponentThatARealDoesNotHold) {
  expect_other_meaning("LREAL", "EXPT(X, 0.1)", "MATIEC reads the literal as a REAL", "EXPONENT : LREAL := 0.1;");
  expect_other_meaning("LREAL", "X ** (-0.3)", "2e-9 off", "VAR CONSTANT");
  expect_one_meaning("LREAL", "EXPT(X, E)");
  expect_one_meaning("LREAL", "EXPT(X, 0.5) + EXPT(X, 3) + X ** 2.25");
}

TEST(Portability, ArgumentsWithNamesOutOfTheirOrder) {
  expect_other_meaning("LREAL", "SEL(IN1 := X, IN0 := Z, G := B)", "STruC++: by their positions", "SEL(G, IN0, IN1)");
  expect_other_meaning("LREAL", "LIMIT(IN := X, MN := 0.0, MX := 1.0)", "not in their order", "LIMIT(MN, IN, MX)");
  expect_one_meaning("LREAL", "SEL(G := B, IN0 := Z, IN1 := X)");
  expect_one_meaning("LREAL", "LIMIT(MN := 0.0, IN := X, MX := 1.0)");
}

TEST(Portability, ADivisorThatMayBeZero) {
  expect_other_meaning("DINT", "N MOD 0", "a DINT is divided by 0", "SEL");
  expect_other_meaning("DINT", "N MOD M", "M may be 0", "SEL(M = 0, M, 1)");
  expect_other_meaning("DINT", "N / (M - 1)", "(M - 1) may be 0", "SEL");
  expect_one_meaning("DINT", "SEL(M = 0, N MOD SEL(M = 0, M, 1), 0)");
  expect_one_meaning("DINT", "N MOD 3 + N / LAST + N / MAX(1, M) + N / LIMIT(1, M, 9)");
  expect_one_meaning("LREAL", "X / Z");
  for (const int m : {-3, 0, 2}) {
    EXPECT_EQ(formula_value("DINT", "SEL(M = 0, N MOD SEL(M = 0, M, 1), 0)", 0, 7, m),
              formula_value("DINT", "N MOD M", 0, 7, m));
  }
}

/// They are results of `check`; a run, a fit and a generation say nothing of other compilers.
TEST(Portability, IsToldByCheckAlone) {
  Diagnostics diagnostics;
  compile(
      std::make_shared<const language::SourceFile>(language::parse("t", formula_text("DINT", "N MOD M"), diagnostics)),
      {}, diagnostics);
  EXPECT_THAT(diagnostics.all(), IsEmpty());
}

TEST(Portability, ThePageShowsTheTable) {
  std::ifstream file(HYSTERON_SOURCE_DIR "/docs/reference/portability.md");
  std::stringstream page;
  page << file.rdbuf();
  for (const OtherMeaning& one : other_meanings()) {
    EXPECT_THAT(page.str(), HasSubstr(fmt::format("| `{}` | {} | {} | {} |", one.construct, one.here, one.elsewhere,
                                                  one.portable)));
  }
}

}  // namespace
}  // namespace hysteron::testing
