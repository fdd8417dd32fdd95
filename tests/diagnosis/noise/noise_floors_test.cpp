// A machine that still rings while its inputs rest.
#include "diagnosis/noise/noise_floors.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "diagnosis/model/task.hpp"
#include "tests/diagnosis/simulated_machine.hpp"

namespace hysteron::diagnosis {
namespace {

constexpr double noise = 0.01;

/// A mass on a spring, 20 Hz, little damped, with a backlash before it.
std::string stage(double damping, double backlash = 0.0) {
  return fmt::format(
      "FUNCTION_BLOCK STAGE (* @ts 1ms *) VAR_INPUT U : LREAL; END_VAR VAR_OUTPUT Y : LREAL; END_VAR VAR GAP : "
      "HY_BACKLASH := (WIDTH := {:.3f}); FLEX : HY_SECOND_ORDER := (T := 0.008, ZETA := {:.3f}); END_VAR GAP(XIN := "
      "U); "
      "FLEX(XIN := GAP.XOUT); Y := FLEX.XOUT; END_FUNCTION_BLOCK",
      backlash, damping);
}

/// Steps to random levels with rests of 60 to 140 samples.
records::Record stepped() {
  test::Noise random(3);
  std::vector<double> levels;
  while (levels.size() < 4000) {
    const double level = 4.0 * random.uniform() - 2.0;
    levels.insert(levels.end(), 60 + static_cast<std::size_t>(80.0 * random.uniform()), level);
  }
  levels.resize(4000);
  return test::record_of("U", std::move(levels), 0.001);
}

TEST(NoiseFloors, RingingInDwellsIsNoNoise) {
  for (const double backlash : {0.0, 0.1}) {
    const records::Record record = test::measured(test::program_of(stage(0.1, backlash)), stepped(), noise);
    const auto input = test::input_of(stage(0.101), "[parameters.FLEX]\nT = 0.0081\n", {record});
    const Task task = task_of(input);
    const Model model(task, input.program);
    EXPECT_EQ(noise_floor(model.problem().experiments, 0).dwells, 0.0) << "what goes on smoothly is set aside at once";
    const std::vector<NoiseFloor> floors = noise_floors(task, input.program, {});
    ASSERT_EQ(floors.size(), 1U);
    EXPECT_GT(floors.front().value, 0.9 * noise);
    EXPECT_LT(floors.front().value, 2.0 * noise) << "with a backlash of " << backlash;
  }
}

TEST(NoiseFloors, AModelThatIsWrongDoesNotRaiseThem) {
  const records::Record record = test::measured(test::program_of(stage(0.7)), stepped(), noise);
  const auto input = test::input_of(stage(0.02), "[fit.FLEX]\nT = {}\n", {record});
  const Task task = task_of(input);
  const Model model(task, input.program);
  EXPECT_LE(noise_floors(task, input.program, {}).front().value, noise_floor(model.problem().experiments, 0).value);
}

}  // namespace
}  // namespace hysteron::diagnosis
