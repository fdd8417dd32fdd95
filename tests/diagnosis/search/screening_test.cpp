// What one candidate could explain, from a few runs of the diagram.
#include "diagnosis/search/screening.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "diagnosis/effects/drivers.hpp"
#include "diagnosis/model/task.hpp"
#include "tests/diagnosis/simulated_machine.hpp"

namespace hysteron::diagnosis {
namespace {

/// An axis that turns freely, its position measured: Y follows the integral of the integral of U.
std::string free_axis(const std::string& limit) {
  const bool limited = !limit.empty();
  return "FUNCTION_BLOCK AXIS  (* @ts 5ms *) VAR_INPUT U : LREAL; END_VAR VAR_OUTPUT Y : LREAL; END_VAR\n"
         "  VAR MOTOR : HY_GAIN := (K := 3.0); DAMPING : HY_GAIN := (K := 2.0); VEL : HY_INTEGRAL_FORWARD; "
         "POS : HY_INTEGRAL; " +
         (limited ? "CLIP : HY_LIMIT := (" + limit + "); " : std::string()) + "END_VAR\n" +
         (limited ? "  CLIP(XIN := U);\n  MOTOR(XIN := CLIP.XOUT);\n" : "  MOTOR(XIN := U);\n") +
         "  DAMPING(XIN := VEL.XOUT);\n  VEL(XIN := MOTOR.XOUT - DAMPING.XOUT);\n  POS(XIN := VEL.XOUT);\n  Y := "
         "POS.XOUT;\nEND_FUNCTION_BLOCK\n";
}

/// The share of the residual that the best start of a saturation of U explains, of a machine with this limit.
double explained(const std::string& limit) {
  DiagnosisInput input = test::input_of(
      free_axis(""), "[parameters.MOTOR]\nK = 3.0\n[parameters.DAMPING]\nK = 2.0\n",
      {test::measured(test::program_of(free_axis(limit)), test::record_of("U", test::rich_force()), 1e-3)});
  Task task = task_of(input);
  task.scales = {1e-3};
  const Variant bare{.text = input.text, .program = std::make_shared<const Program>(input.program)};
  Model model(task, *bare.program);
  Fit at{.x = model.start()};
  EXPECT_TRUE(model.residuals(at.x, at.residuals, &at.jacobian));
  const Background background(model, at);
  std::vector<Candidate> candidates = candidates_of(bare, "AXIS", {.effects = {"saturation"}});
  std::erase_if(candidates, [](const Candidate& one) { return one.own().edge != "U"; });
  const Drivers drivers(task, candidates, at.x, 1);
  const Driven* const signals = candidates.size() == 1 ? drivers.find(candidates.front()) : nullptr;
  if (signals == nullptr) {
    ADD_FAILURE() << "no candidate at U";
    return 0.0;
  }
  const Grids grids = grids_of(candidates.front(), signals->input, nullptr, hints_of(task, at.residuals), {});
  const Screened found =
      screened(task, candidates.front(), thinned(candidates.front().own(), grids, 3), at.x, background, 3);
  return found.gain() / background.unexplained();
}

// One limit alone lets the position run away, and a pair that cuts as much on either side of a signal that is not
// symmetric does, too: of the residual such starts explain a tenth.
TEST(Screening, FindsLimitsThatAreAlikeBeforeAnIntegrator) {
  for (const double level : {2.9, 2.6, 2.3, 2.0, 1.7, 1.4}) {
    const std::string limit = fmt::format("MN := {:.3f}, MX := {:.3f}", -level, level);
    EXPECT_GT(explained(limit), 0.9) << limit;
  }
}

}  // namespace
}  // namespace hysteron::diagnosis
