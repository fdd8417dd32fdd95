// A fit is never called converged where a constant is as near to the record, or where its output runs away.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "tests/tuning/goal/loops.hpp"
#include "tests/tuning/measured_machines.hpp"
#include "tuning/output_error.hpp"

namespace hysteron {
namespace {

/// Of a loop with K = 8 about an integrator, stable for 0 < K < 200.
records::Record steps_of_the_loop() {
  const records::Record steps =
      measured_machines::inputs("sp", 0.01, 300, [](double t) { return std::fmod(t, 1.0) < 0.5 ? 0.0 : 1.0; });
  Program program = compile_text(loops::integrator());
  program.graph.parameters[static_cast<std::size_t>(find_parameter(program.graph, "P.K"))].value = {8.0};
  return measured_machines::measured(program, steps);
}

TEST(NoSolution, WhateverTheStartConvergedMeansNearerThanAConstant) {
  const records::Record record = steps_of_the_loop();
  double sum = 0.0;
  const std::vector<double>& y = record.column("y").values;
  for (const double value : y) {
    sum += value / static_cast<double>(y.size());
  }
  double deviation = 0.0;
  for (const double value : y) {
    deviation += (value - sum) * (value - sum) / static_cast<double>(y.size());
  }
  int converged = 0;
  int refused = 0;
  for (const double start : {0.5, 5.0, 30.0, 150.0, 199.0, 201.0, 205.0, 230.0, 300.0, 450.0}) {
    const auto fit = fit_output_error(measured_machines::problem_of(
        loops::integrator(), fmt::format("[parameters.P]\nK = {}\n[fit.P]\nK = {{min = 0.0}}\n", start), {record}));
    if (fit.solution.converged()) {
      ++converged;
      EXPECT_LT(fit.scores[0].train, std::sqrt(deviation)) << start;
      EXPECT_NEAR(fit.solution.x[0], 8.0, 1e-3) << start;
    } else {
      ++refused;
      EXPECT_EQ(fit.solution.message.find("converged."), std::string::npos) << fit.solution.message;
    }
  }
  EXPECT_GE(converged, 4);
  EXPECT_EQ(converged + refused, 10);
}

TEST(NoSolution, AModelThatIsFartherThanAConstantIsNone) {
  // The gain is held between 3 and 4, and the record has −1: the best is on the bound, and worse than a constant.
  const auto record = measured_machines::inputs("u", 0.01, 200, [](double t) { return std::sin(6.0 * t); });
  std::vector<double> y = record.column("u").values;
  for (double& value : y) {
    value = -value;
  }
  records::Record log = record;
  log.add({.name = "y", .values = std::move(y)});
  const auto fit = fit_output_error(measured_machines::problem_of(
      "FUNCTION_BLOCK G  (* @ts 10ms *)\n  VAR_INPUT U : LREAL; END_VAR\n  VAR_OUTPUT Y : LREAL; END_VAR\n"
      "  VAR A : HY_GAIN := (K := 3.5); END_VAR\n  A(XIN := U);\n  Y := A.XOUT;\nEND_FUNCTION_BLOCK\n",
      "[fit.A]\nK = {min = 3.0, max = 4.0}\n", {log}));
  EXPECT_EQ(fit.solution.status, FitStatus::WorseThanConstant) << fit.solution.message;
}

}  // namespace
}  // namespace hysteron
