// The verdict: sets are weighed as finely as the data are worth, and no finer than formulas are true.
#include "diagnosis/verdict/verdict.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "diagnosis/diagnose.hpp"
#include "diagnosis/model/task.hpp"
#include "tests/diagnosis/simulated_machine.hpp"

namespace hysteron::diagnosis {
namespace {

using testing::Contains;
using testing::ElementsAre;

std::vector<std::vector<std::string>> sets_of(const std::vector<Rival>& rivals) {
  std::vector<std::vector<std::string>> sets;
  for (const Rival& rival : rivals) {
    sets.push_back(rival.effects);
  }
  return sets;
}

/// How many samples weigh sets that explain a constant force of this size, and how many there are.
struct Weight {
  double samples = 0.0;
  double effective = 0.0;
  double gap = 0.0;  ///< that calibration leaves, in energies of the noise
};
Weight weight_of(double force) {
  const std::string effect = fmt::format("HY_OFFSET := (BIAS := {:.4f})", force);
  const DiagnosisInput input = test::input_of(test::axis(), test::axis_parameters,
                                              {test::measured(test::program_of(test::axis({effect, "FORCE"})),
                                                              test::record_of("FORCE", test::rich_force()), 0.01)});
  Task task = task_of(input);
  task.scales = {0.01};
  constexpr double floor_cost = 0.5 * 2000;
  SearchOptions options{.threads = 1, .most_effects = 1};
  options.candidates.effects = {"offset"};
  const Search found = search(task, {.text = input.text, .program = std::make_shared<const Program>(input.program)},
                              "AXIS", floor_cost, options);
  const Judgement judgement = judge(task, found, floor_cost);
  EXPECT_EQ(judgement.chosen->names(), std::vector<std::string>{"offset"});
  return {.samples = judgement.weighing_samples,
          .effective = judgement.effective_samples,
          .gap = found.calibrated.fit.cost / floor_cost - 1.0};
}

/// An explanation by effects whose parameters have these names.
Explanation explanation_of(const std::vector<std::pair<std::string, std::vector<std::string>>>& effects) {
  Explanation result{};
  for (const auto& [effect, names] : effects) {
    Applied& one = result.variant.effects.emplace_back();
    one.effect = effect;
    one.simpler = effect == "stribeck_friction" ? "coulomb_friction" : "";
    for (const std::string& name : names) {
      one.parameters.push_back({.name = name});
    }
  }
  return result;
}

TEST(Verdict, ASimplerFormulaOfTheSameCauseIsNoDoubt) {
  const Explanation richer = explanation_of({{"stribeck_friction", {"LEVEL", "STICTION"}}, {"lag", {"T1"}}});
  const Explanation simpler = explanation_of({{"lag", {"T1"}}, {"coulomb_friction", {"LEVEL"}}});
  const Explanation other = explanation_of({{"stribeck_friction", {"LEVEL", "STICTION"}}, {"delay", {"DEAD_TIME"}}});
  const Explanation alone = explanation_of({{"lag", {"T1"}}});
  Judgement judgement{.chosen = &richer,
                      .rivals = {{.explanation = &richer}, {.explanation = &simpler, .support = 1.0}}};
  EXPECT_NEAR(probability_of_cause(judgement), 1.0, 1e-12);
  judgement.rivals.push_back({.explanation = &other});
  judgement.rivals.push_back({.explanation = &alone, .support = -std::log(2.0)});
  EXPECT_NEAR(probability_of_cause(judgement), 2.0 / 3.5, 1e-12);
  judgement.rivals.clear();
  EXPECT_EQ(probability_of_cause(judgement), 1.0);
}

TEST(Verdict, WeighsNoFinerThanFormulasAreTrue) {
  const Weight small = weight_of(0.002);
  EXPECT_GT(small.effective, 1000.0);
  EXPECT_EQ(small.samples, std::min(small.effective, 2000.0)) << "noise hides what a formula misses";
  const Weight large = weight_of(0.02);
  EXPECT_GT(large.effective, 1000.0);
  EXPECT_NEAR(large.samples * large.gap, 8.0 / (0.03 * 0.03), 1.0) << "eight values of 3 % of the effect";
  EXPECT_EQ(weight_of(2.0).samples, 60.0) << "sixty at least";
}

TEST(Verdict, WhatClosesLittleBesideAnotherMayBeItsFormula) {
  // Two lags for one: a delay beside the longer one stands in for the shorter.
  constexpr std::string_view machine =
      "FUNCTION_BLOCK STACK (* @ts 5ms *) VAR_INPUT U : LREAL; (* @unit V *) END_VAR VAR_OUTPUT Y : LREAL; (* @unit um "
      "*) END_VAR VAR AMP : HY_LAG := (T1 := 0.02); HYST : HY_HYSTERESIS_RO := (C1 := 5.0, C2 := 4.0, C3 := 0.8); "
      "ONE : HY_LAG := (T1 := 0.1); OTHER : HY_LAG := (T1 := 0.012); END_VAR AMP(XIN := U); HYST(XIN := AMP.XOUT); "
      "ONE(XIN := HYST.XOUT); OTHER(XIN := ONE.XOUT); Y := OTHER.XOUT; END_FUNCTION_BLOCK";
  const records::Record record =
      test::measured(test::program_of(std::string(machine)), test::record_of("U", test::rich_voltage()), 0.02);
  const Diagnosis found = diagnose(test::input_of(test::stack(), test::stack_parameters, {record}),
                                   {.effects = {"lag", "delay", "drift", "offset"}});
  ASSERT_FALSE(found.effects.empty()) << found.summary;
  EXPECT_EQ(found.effects[0].id, "lag") << found.summary;
  EXPECT_THAT(sets_of(found.rivals), Contains(ElementsAre("lag"))) << found.summary;
  // Ruled out by their likelihood alone, and said to be something else than equal.
  const auto whole = std::ranges::find(found.rivals, std::vector<std::string>{"lag"}, &Rival::effects);
  EXPECT_EQ(whole->support<-rival_within, found.effects.size()> 1);
}

}  // namespace
}  // namespace hysteron::diagnosis
