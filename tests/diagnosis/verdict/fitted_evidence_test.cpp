#include "diagnosis/verdict/fitted_evidence.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "diagnosis/model/task.hpp"
#include "tests/diagnosis/simulated_machine.hpp"

namespace hysteron::diagnosis {
namespace {

using testing::ElementsAre;

/// A stack with an effect, and what a search of that effect and a relaxation fits.
class FittedRivals : public testing::Test {
 protected:
  void look(const std::string& effect, const test::Effect& in_the_machine) {
    const DiagnosisInput input = test::input_of(test::stack(), test::stack_parameters,
                                                {test::measured(test::program_of(test::stack(in_the_machine)),
                                                                test::record_of("U", test::rich_voltage()), 0.005)});
    task_ = task_of(input);
    task_.scales = {0.005};
    SearchOptions options;
    options.candidates.effects = {effect, "relaxation"};
    options.ends_with_singles = [](const std::vector<Explanation>&) { return true; };
    search_ = search(task_, {.text = input.text, .program = std::make_shared<const Program>(input.program)}, "STACK",
                     0.5 * 2000.0, options);
  }
  void look_behind_a_coarse_sensor() { look("quantization", {"HY_QUANTIZER := (QUANTUM := 1.0)", "HYST.XOUT"}); }
  [[nodiscard]] std::optional<FittedEvidence> against(const Explanation& of_laws, unsigned threads = 2) const {
    return fitted_evidence(task_, search_, of_laws, {.top = "STACK", .threads = threads}, Rules());
  }

  /// The best set with this effect alone.
  [[nodiscard]] const Explanation& alone(const std::string& effect) const {
    return *std::ranges::find_if(
        search_.explanations, [&](const Explanation& one) { return one.names() == std::vector<std::string>{effect}; });
  }

  Task task_{};
  Search search_{};
};

TEST_F(FittedRivals, ASensorsStepsAreToldWhereTheyPredictBetterThanALaw) {
  look_behind_a_coarse_sensor();
  const auto found = against(alone("relaxation"));
  ASSERT_TRUE(found.has_value());
  EXPECT_THAT(found->chosen->names(), ElementsAre("quantization"));
  ASSERT_FALSE(found->evidence.sets.empty());
  const SetFinding& first = found->evidence.sets.front();
  EXPECT_EQ(first.laws.front().effect, "quantization");
  EXPECT_GT(first.closed, 0.5);
  EXPECT_NEAR(first.laws.front().closed, first.closed, 1e-12);
  EXPECT_EQ(found->evidence.families.front().family, "logging");
  EXPECT_GT(found->evidence.families.front().probability, 0.9);
  double sum = 0.0;
  for (const SetFinding& set : found->evidence.sets) {
    sum += set.probability;
  }
  EXPECT_NEAR(sum, 1.0, 1e-9);
}

TEST_F(FittedRivals, LawsAreNotComparedAgain) {
  look("rate_limit", {"HY_RATE_LIMIT := (RISE := 12.0, FALL := 12.0)", "U"});
  ASSERT_LT(alone("rate_limit").fit.cost, alone("relaxation").fit.cost);
  EXPECT_FALSE(against(alone("relaxation")).has_value());
}

TEST_F(FittedRivals, TheLawsStandWhereNoFitLeavesLess) {
  look_behind_a_coarse_sensor();
  EXPECT_FALSE(against(alone("quantization")).has_value());
}

TEST_F(FittedRivals, IsTheSameWithAnyNumberOfThreads) {
  look_behind_a_coarse_sensor();
  const auto one = against(alone("relaxation"), 1);
  const auto four = against(alone("relaxation"), 4);
  ASSERT_TRUE(one && four);
  ASSERT_EQ(one->evidence.sets.size(), four->evidence.sets.size());
  for (std::size_t i = 0; i < one->evidence.sets.size(); ++i) {
    EXPECT_EQ(one->evidence.sets[i].probability, four->evidence.sets[i].probability);
    EXPECT_EQ(one->evidence.sets[i].closed, four->evidence.sets[i].closed);
  }
}

}  // namespace
}  // namespace hysteron::diagnosis
