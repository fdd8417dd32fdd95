// The table [goal]: what it holds, what is said of what it cannot hold, and that it is written as it was read.
#include "codegen/parameters/goal_reader.hpp"

#include <gtest/gtest.h>

#include "codegen/parameters/parameter_file.hpp"
#include "support/errors.hpp"
#include "tests/codegen/parameters/refusal.hpp"

namespace hysteron::parameters {
namespace {

constexpr std::string_view whole_goal = R"([fit.PID]
KP = {min = 0.0}

[goal]
input = "SP"
output = "Y"
signal = "ramp"
from = 1.0
size = -2.0
duration = 3.0
rise_time = 0.25
order = 2.0
damping = 0.8
dead_time = 0.1
loop = "PID.XOUT"
effort = "LIMIT.XOUT"
effort_weight = 0.01
plants = ["light.toml", "a folder/heavy.toml"]
robust = "mean"

[goal.limits]
effort = 10.0
effort_rate = 100.0
gain_margin_db = 6.0
phase_margin_deg = 45.0
sensitivity = 1.7
)";

TEST(GoalReader, ReadsAllOfIt) {
  const GoalSettings goal = parse_parameter_file("p.toml", whole_goal).goal;
  ASSERT_TRUE(goal.is_given());
  EXPECT_EQ(goal.place.line, 4U);
  EXPECT_EQ(goal.input->text, "SP");
  EXPECT_EQ(goal.output->text, "Y");
  EXPECT_EQ(goal.signal, GoalSettings::Signal::Ramp);
  EXPECT_EQ(goal.from->value, 1.0);
  EXPECT_EQ(goal.size->value, -2.0);
  EXPECT_EQ(goal.duration->value, 3.0);
  EXPECT_EQ(goal.rise_time->value, 0.25);
  EXPECT_EQ(goal.order->value, 2.0);
  EXPECT_EQ(goal.damping->value, 0.8);
  EXPECT_EQ(goal.dead_time->value, 0.1);
  EXPECT_EQ(goal.loop->text, "PID.XOUT");
  EXPECT_EQ(goal.effort->text, "LIMIT.XOUT");
  EXPECT_EQ(goal.effort_weight->value, 0.01);
  ASSERT_EQ(goal.plants.size(), 2U);
  EXPECT_EQ(goal.plants[1].text, "a folder/heavy.toml");
  EXPECT_EQ(goal.robust, GoalSettings::Robust::Mean);
  EXPECT_EQ(goal.largest_effort->value, 10.0);
  EXPECT_EQ(goal.largest_rate->value, 100.0);
  EXPECT_EQ(goal.gain_margin->value, 6.0);
  EXPECT_EQ(goal.phase_margin->value, 45.0);
  EXPECT_EQ(goal.sensitivity->value, 1.7);
  EXPECT_FALSE(goal.largest_overshoot);
}

TEST(GoalReader, IsWrittenAsItWasRead) {
  const std::string text = parameter_text(parse_parameter_file("p.toml", whole_goal));
  EXPECT_EQ(text, whole_goal);
  constexpr std::string_view recorded = "[goal]\nsignal = \"record\"\nwished = \"Y wished\"\n";
  EXPECT_EQ(parameter_text(parse_parameter_file("p.toml", recorded)), recorded);
}

TEST(GoalReader, AFileWithoutIsAsBefore) {
  EXPECT_FALSE(parse_parameter_file("p.toml", "[parameters.P]\nK = 1.0\n").goal.is_given());
}

struct RefusedGoal {
  std::string_view goal;
  int number;
};

class GoalRefusals : public ::testing::TestWithParam<RefusedGoal> {};

TEST_P(GoalRefusals, AreSaid) {
  const auto& [goal, number] = GetParam();
  const Diagnostics refused = refusals_of("[goal]\n" + std::string(goal));
  EXPECT_EQ(refused.all().front().number, number) << goal;
  EXPECT_GE(refused.all().front().place.line, 1U);
  EXPECT_FALSE(refused.all().front().mend.empty());
}

INSTANTIATE_TEST_SUITE_P(
    All, GoalRefusals,
    ::testing::Values(RefusedGoal{"", error::goal_lacks}, RefusedGoal{"loop = \"P.XOUT\"\n", error::goal_lacks},
                      RefusedGoal{"settling_time = 1.0\nrise_time = 1.0\n", error::contradicting_range},
                      RefusedGoal{"settling_time = 1.0\nwished = \"Y\"\nsignal = \"record\"\n",
                                  error::contradicting_range},
                      RefusedGoal{"wished = \"Y\"\n", error::contradicting_range},
                      RefusedGoal{"settling_time = 0.0\n", error::contradicting_range},
                      RefusedGoal{"settling_time = -1.0\n", error::contradicting_range},
                      RefusedGoal{"settling_time = inf\n", error::parameter_not_finite},
                      RefusedGoal{"settling_time = \"1 s\"\n", error::wrong_value_type},
                      RefusedGoal{"settling_tim = 1.0\n", error::unknown_key},
                      RefusedGoal{"settling_time = 1.0\nsize = 0\n", error::contradicting_range},
                      RefusedGoal{"settling_time = 1.0\norder = 3\n", error::contradicting_range},
                      RefusedGoal{"settling_time = 1.0\norder = 1\ndamping = 0.7\n", error::contradicting_range},
                      RefusedGoal{"settling_time = 1.0\nsignal = \"sine\"\n", error::wrong_value_type},
                      RefusedGoal{"settling_time = 1.0\nsignal = \"record\"\nsize = 1.0\n", error::contradicting_range},
                      RefusedGoal{"settling_time = 1.0\nloop = \"a b\"\n", error::wrong_value_type},
                      RefusedGoal{"settling_time = 1.0\nplants = \"a.toml\"\n", error::wrong_value_type},
                      RefusedGoal{"settling_time = 1.0\nplants = [\"a.toml\", \"a.toml\"]\n", error::duplicate_key},
                      RefusedGoal{"settling_time = 1.0\nlimits = 3\n", error::wrong_value_type},
                      RefusedGoal{"settling_time = 1.0\neffort_weight = 0.1\n", error::goal_lacks},
                      RefusedGoal{"settling_time = 1.0\n[goal.limits]\nphase_margin_deg = 50\n", error::goal_lacks},
                      RefusedGoal{"settling_time = 1.0\n[goal.limits]\neffort = 5\n", error::goal_lacks},
                      RefusedGoal{"settling_time = 1.0\n[goal.limits]\nphase_margin = 50\n", error::unknown_key},
                      RefusedGoal{"settling_time = 1.0\nloop = \"P.XOUT\"\n[goal.limits]\nsensitivity = 1.0\n",
                                  error::contradicting_range},
                      RefusedGoal{"settling_time = 1.0\nloop = \"P.XOUT\"\n[goal.limits]\nphase_margin_deg = 180\n",
                                  error::contradicting_range},
                      RefusedGoal{"settling_time = 1.0\nsignal = \"ramp\"\n[goal.limits]\novershoot_percent = 5\n",
                                  error::contradicting_range}));

}  // namespace
}  // namespace hysteron::parameters
