// Coarse steps that the measured values show, with the diagram's own told from those of the machine.
#include "diagnosis/verdict/seen_steps.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "diagnosis/model/task.hpp"
#include "tests/diagnosis/simulated_machine.hpp"

namespace hysteron::diagnosis {
namespace {

std::string axis_with_steps(double quantum) {
  return test::axis({fmt::format("HY_QUANTIZER := (QUANTUM := {})", quantum), "SPEED.XOUT"});
}

/// Of a machine, explained by a diagram as it stands.
bool shown(const std::string& machine, const std::string& diagram, double noise, double floor = 0.01,
           const std::vector<double>& force = test::rich_force()) {
  const DiagnosisInput input =
      test::input_of(diagram, test::axis_parameters,
                     {test::measured(test::program_of(machine), test::record_of("FORCE", force), noise)});
  Task task = task_of(input);
  task.scales = {floor};
  Model model(task, input.program);
  Explanation explanation{};
  EXPECT_TRUE(model.residuals(model.start(), explanation.fit.residuals));
  return shows_steps(task, explanation);
}

TEST(SeenSteps, OfACoarseSensorUnlessTheDiagramHasThem) {
  constexpr double coarse = 0.08;  // a sixth of the range
  constexpr double fine = 0.004;
  EXPECT_TRUE(shown(axis_with_steps(coarse), test::axis(), 0.004));
  EXPECT_FALSE(shown(axis_with_steps(coarse), axis_with_steps(coarse), 0.004)) << "the diagram has them";
  EXPECT_FALSE(shown(axis_with_steps(fine), test::axis(), 0.0)) << "as any sensor's";
  EXPECT_TRUE(shown(axis_with_steps(fine), test::axis(), 0.0003, 0.0003)) << "which the noise behind it is not";
  EXPECT_FALSE(shown(axis_with_steps(coarse), test::axis(), 0.08)) << "noise hides them";
  EXPECT_FALSE(shown(test::axis(), test::axis(), 0.004));
}

TEST(SeenSteps, TwoLevelsAreNone) {
  std::vector<double> pushes(2000, 0.0);  // to a speed, and back to rest
  for (std::size_t k = 500; k < pushes.size(); k += 500) {
    pushes[k] = k % 1000 == 500 ? 400.0 : -400.0;
  }
  // The machine pushes less than the diagram: its levels are no steps of the diagram's.
  const std::string weaker = test::axis({"HY_GAIN := (K := 0.84)", "FORCE"});
  EXPECT_FALSE(shown(weaker, test::axis(), 0.0005, 0.0005, pushes));
}

}  // namespace
}  // namespace hysteron::diagnosis
