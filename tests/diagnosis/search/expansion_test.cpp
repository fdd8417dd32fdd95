// What every expansion of a set stands on.
#include "diagnosis/search/expansion.hpp"

#include <gtest/gtest.h>

#include <memory>

#include "diagnosis/model/task.hpp"
#include "tests/diagnosis/simulated_machine.hpp"

namespace hysteron::diagnosis {
namespace {

/// Of an axis that was tuned to K = 0.5, where the machine has another gain and a load.
Footing footing_of_axis(double gain, double load) {
  const std::string text = test::axis();
  std::string machine =
      test::axis({fmt::format("HY_LOAD := (SIZE := {:f}, T_ON := 3.0, T_OFF := 6.0)", load), "FORCE"});
  const std::string tuned = "K := 0.5";
  machine.replace(machine.find(tuned), tuned.size(), fmt::format("K := {:f}", gain));
  const DiagnosisInput input =
      test::input_of(text, test::axis_parameters,
                     {test::measured(test::program_of(machine), test::record_of("FORCE", test::rich_force()), 0.001)});
  Task task = task_of(input);
  task.scales = {0.001};
  return footing_of(task, {.text = text, .program = std::make_shared<Program>(input.program)});
}

TEST(Footing, IsNearWhereTheCalibrationLeavesLittleOfWhatThePoorTuningLeft) {
  EXPECT_TRUE(footing_of_axis(0.53, 0.002).is_near);
}

TEST(Footing, IsNotNearWhereTheTuningWasGoodOrTheCalibrationBendsFarAway) {
  EXPECT_FALSE(footing_of_axis(0.5, 0.002).is_near);
  EXPECT_FALSE(footing_of_axis(0.53, 1.0).is_near) << "the load is the larger part";
  EXPECT_FALSE(footing_of_axis(0.75, 0.002).is_near) << "by more than a deviation of its prior";
}

}  // namespace
}  // namespace hysteron::diagnosis
