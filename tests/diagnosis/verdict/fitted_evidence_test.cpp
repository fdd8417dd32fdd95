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

/// A stack behind an amplifier that cannot follow: what is missing is a bound on a rate, and no law.
class FittedRivals : public testing::Test {
 protected:
  FittedRivals() {
    const DiagnosisInput input = test::input_of(
        test::stack(), test::stack_parameters,
        {test::measured(test::program_of(test::stack({"HY_RATE_LIMIT := (RISE := 12.0, FALL := 12.0)", "U"})),
                        test::record_of("U", test::rich_voltage()), 0.005)});
    task_ = task_of(input);
    task_.scales = {0.005};
    SearchOptions options;
    options.candidates.effects = {"rate_limit", "relaxation"};
    options.ends_with_singles = [](const std::vector<Explanation>&) { return true; };
    search_ = search(task_, {.text = input.text, .program = std::make_shared<const Program>(input.program)}, "STACK",
                     0.5 * 2000.0, options);
  }

  /// The best set with this effect alone.
  [[nodiscard]] const Explanation& alone(const std::string& effect) const {
    return *std::ranges::find_if(
        search_.explanations, [&](const Explanation& one) { return one.names() == std::vector<std::string>{effect}; });
  }

  Task task_{};
  Search search_{};
};

TEST_F(FittedRivals, ASetThatPredictsBetterThanTheLawsIsTold) {
  const auto found = fitted_evidence(task_, search_, alone("relaxation"), {}, Rules());
  ASSERT_TRUE(found.has_value());
  EXPECT_THAT(found->chosen->names(), ElementsAre("rate_limit"));
  ASSERT_FALSE(found->evidence.sets.empty());
  const SetFinding& first = found->evidence.sets.front();
  EXPECT_EQ(first.laws.front().effect, "rate_limit");
  EXPECT_GT(first.closed, 0.9);
  EXPECT_NEAR(first.laws.front().closed, first.closed, 1e-12);
  EXPECT_EQ(found->evidence.families.front().family, "rate_limit");
  EXPECT_GT(found->evidence.families.front().probability, 0.9);
  double sum = 0.0;
  for (const SetFinding& set : found->evidence.sets) {
    sum += set.probability;
  }
  EXPECT_NEAR(sum, 1.0, 1e-9);
}

TEST_F(FittedRivals, TheLawsStandWhereNoFitLeavesLess) {
  EXPECT_FALSE(fitted_evidence(task_, search_, alone("rate_limit"), {}, Rules()).has_value());
}

TEST_F(FittedRivals, IsTheSameWithAnyNumberOfThreads) {
  const auto one = fitted_evidence(task_, search_, alone("relaxation"), {.threads = 1}, Rules());
  const auto four = fitted_evidence(task_, search_, alone("relaxation"), {.threads = 4}, Rules());
  ASSERT_TRUE(one && four);
  ASSERT_EQ(one->evidence.sets.size(), four->evidence.sets.size());
  for (std::size_t i = 0; i < one->evidence.sets.size(); ++i) {
    EXPECT_EQ(one->evidence.sets[i].probability, four->evidence.sets[i].probability);
    EXPECT_EQ(one->evidence.sets[i].closed, four->evidence.sets[i].closed);
  }
}

}  // namespace
}  // namespace hysteron::diagnosis
