// Whether a record excites what is to be fitted, against closed forms.
#include "tuning/excitation.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "codegen/parameters/parameter_file.hpp"
#include "tests/tuning/measured_machines.hpp"

namespace hysteron {
namespace {

using namespace measured_machines;
using ::testing::HasSubstr;

constexpr std::size_t excitation_rows = 400;
constexpr double excitation_step = 1e-3;

OutputErrorProblem excited_problem(const std::string& blocks, const std::string& calls, const std::string& fit,
                                   double (*drive)(double)) {
  const std::string diagram =
      "FUNCTION_BLOCK P (* @ts 1ms *)\n  VAR_INPUT U : LREAL; (* @unit V *) END_VAR\n"
      "  VAR_OUTPUT Y : LREAL; (* @unit um *) END_VAR\n  VAR " +
      blocks + " END_VAR\n" + calls + "\nEND_FUNCTION_BLOCK\n";
  records::Record record = inputs("U", excitation_step, excitation_rows, drive);
  record.add({.name = "Y", .values = std::vector<double>(excitation_rows, 0.0)});
  const auto file = parameters::parse_parameter_file("p.toml", fit);
  return output_error_problem(program_of(diagram), file, std::vector<records::Record>{record});
}

double fast_sine(double t) {
  return std::sin(60.0 * t);
}
double standing(double) {
  return 1.0;
}

/// y = K·u with noise of σ: the standard error of K is σ/√Σu².
TEST(Excitation, OfAGainIsItsClosedForm) {
  const auto problem =
      excited_problem("A : HY_GAIN := (K := 2.0);", "  A(XIN := U);\n  Y := A.XOUT;", "[fit.A]\nK = {}\n", fast_sine);
  double squares = 0.0;
  for (std::size_t k = 0; k < excitation_rows; ++k) {
    squares += std::pow(fast_sine(excitation_step * static_cast<double>(k)), 2);
  }
  const Excitation found = excitation_of(problem, {0.05});
  ASSERT_EQ(found.parameters.size(), 1U);
  EXPECT_EQ(found.parameters[0].name, "A.K");
  EXPECT_EQ(found.parameters[0].value, 2.0);
  EXPECT_NEAR(found.parameters[0].standard_error, 0.05 / std::sqrt(squares), 1e-9);
  EXPECT_EQ(found.parameters[0].excited, Excited::Well);
  EXPECT_TRUE(found.notes.empty());
}

/// More noise, less told: the word follows the standard error over the value.
TEST(Excitation, NoiseDecidesTheWord) {
  const auto problem =
      excited_problem("A : HY_GAIN := (K := 2.0);", "  A(XIN := U);\n  Y := A.XOUT;", "[fit.A]\nK = {}\n", fast_sine);
  const double of_unit_noise = excitation_of(problem, {1.0}).parameters[0].standard_error;
  EXPECT_EQ(excitation_of(problem, {0.04 * 2.0 / of_unit_noise}).parameters[0].excited, Excited::Well);
  EXPECT_EQ(excitation_of(problem, {0.3 * 2.0 / of_unit_noise}).parameters[0].excited, Excited::Weakly);
  EXPECT_EQ(excitation_of(problem, {0.7 * 2.0 / of_unit_noise}).parameters[0].excited, Excited::No);
}

TEST(Excitation, ALagIsNotSeenWhereNothingMoves) {
  const std::string blocks = "A : HY_GAIN := (K := 2.0); S : HY_LAG := (T1 := 0.01);";
  const std::string calls = "  A(XIN := U);\n  S(XIN := A.XOUT);\n  Y := S.XOUT;";
  const std::string fit = "[fit.A]\nK = {}\n[fit.S]\nT1 = {min = 1e-4}\n";
  const Excitation still = excitation_of(excited_problem(blocks, calls, fit, standing), {0.01});
  EXPECT_EQ(still.parameters[0].excited, Excited::Well);
  EXPECT_EQ(still.parameters[1].excited, Excited::No);
  EXPECT_TRUE(std::isinf(still.parameters[1].standard_error));
  const Excitation moving = excitation_of(excited_problem(blocks, calls, fit, fast_sine), {0.01});
  EXPECT_EQ(moving.parameters[1].excited, Excited::Well);
}

TEST(Excitation, TwoGainsInARowActTogetherAlone) {
  const auto problem = excited_problem("A : HY_GAIN := (K := 2.0); B : HY_GAIN := (K := 1.0);",
                                       "  A(XIN := U);\n  B(XIN := A.XOUT);\n  Y := B.XOUT;",
                                       "[fit.A]\nK = {}\n[fit.B]\nK = {}\n", fast_sine);
  const Excitation found = excitation_of(problem, {0.01});
  EXPECT_EQ(found.parameters[0].excited, Excited::No);
  EXPECT_EQ(found.parameters[1].excited, Excited::No);
  ASSERT_EQ(found.notes.size(), 1U);
  EXPECT_THAT(found.notes[0], HasSubstr("A.K and B.K cannot be told apart"));
}

}  // namespace
}  // namespace hysteron
