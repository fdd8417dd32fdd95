// Sets of effects built anew.
#include "diagnosis/search/sets.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "diagnosis/model/task.hpp"
#include "tests/diagnosis/simulated_machine.hpp"

namespace hysteron::diagnosis {
namespace {

/// An axis with a constant force beside it, and a relaxation of its drive.
class RestOf : public testing::Test {
 protected:
  RestOf() {
    add("offset", "FORCE", {0.05});
    add("relaxation", "MASS.XOUT", {24.0, 0.02});
  }

  void add(const std::string& effect, const std::string& edge, const std::vector<double>& values) {
    std::vector<Candidate> list = candidates_of(whole_.variant, "AXIS", {.effects = {effect}});
    std::erase_if(list, [&](const Candidate& one) { return one.own().edge != edge; });
    std::vector<Unknown> further = whole_.variant.further;
    whole_.variant = list.front().variant;
    whole_.variant.further = std::move(further);
    for (std::size_t j = 0; j < values.size(); ++j) {
      whole_.variant.further.push_back({.path = whole_.variant.effects.back().paths[j],
                                        .start = values[j],
                                        .lower = 0.1 * values[j],
                                        .upper = 10.0 * values[j],
                                        .deviation = std::numeric_limits<double>::infinity()});
    }
  }
  /// The set with this gain of the diagram, without the relaxation.
  [[nodiscard]] Explanation rest(double gain) {
    Model model(task_, *whole_.variant.program, whole_.variant.further);
    whole_.fit.x = model.start();
    whole_.fit.x[0] = gain;
    return Sets(task_, "AXIS", options_).rest_of(whole_, 1, bare_, VectorXd::Constant(1, 0.5));
  }

  DiagnosisInput input_ =
      test::input_of(test::axis(), test::axis_parameters,
                     {test::measured(test::program_of(test::axis({"HY_OFFSET := (BIAS := 0.05)", "FORCE"})),
                                     test::record_of("FORCE", test::rich_force()), 0.001)});
  Task task_ = task_of(input_);
  CandidateOptions options_{};
  Variant bare_{.text = input_.text, .program = std::make_shared<const Program>(input_.program)};
  Explanation whole_{.variant = bare_};
};

TEST_F(RestOf, StandsWhereTheWholeStood) {
  const Explanation found = rest(0.5001);
  ASSERT_EQ(found.names(), std::vector<std::string>{"offset"});
  EXPECT_EQ(found.fit.x[0], 0.5001);
  EXPECT_EQ(found.fit.x[1], 0.05);
}

TEST_F(RestOf, HasTheGainAsTunedWhereTheMissingEffectHadTakenItOver) {
  const Explanation found = rest(0.5 / 24.0);
  ASSERT_EQ(found.names(), std::vector<std::string>{"offset"});
  EXPECT_EQ(found.fit.x[0], 0.5);
  EXPECT_EQ(found.fit.x[1], 0.05);
}

TEST(Sets, KeepTheFormulaOfAnEffectThatHasSeveral) {
  const DiagnosisInput input = test::input_of(
      test::stack({}, "HY_HYSTERESIS_GENERAL"), test::stack_parameters,
      {test::measured(test::program_of(test::stack()), test::record_of("U", test::rich_voltage()), 0.02)});
  const Task task = task_of(input);
  const Variant bare{.text = input.text, .program = std::make_shared<const Program>(input.program)};
  const std::vector<Candidate> formulas = candidates_of(bare, "STACK", {.effects = {"curve_shape"}});
  const auto is_shape = [](const Candidate& one) { return one.own().paths.front() == "HYST.SHAPE"; };
  ASSERT_TRUE(std::ranges::any_of(formulas, is_shape));
  ASSERT_FALSE(std::ranges::all_of(formulas, is_shape));
  for (const Candidate& formula : formulas) {
    Explanation whole{.variant = candidates_of(formula.variant, "STACK", {.effects = {"offset"}}).front().variant};
    for (const Applied& effect : whole.variant.effects) {
      whole.variant.further.push_back({.path = effect.paths.front(),
                                       .lower = 0.0,
                                       .upper = 0.4,
                                       .deviation = std::numeric_limits<double>::infinity()});
    }
    whole.fit.x = Model(task, *whole.variant.program, whole.variant.further).start();
    const Explanation rest = Sets(task, "STACK", {}).without(whole, 1, bare, 0);
    ASSERT_TRUE(std::isfinite(rest.fit.cost)) << formula.own().paths.front();
    ASSERT_EQ(rest.variant.further.size(), 1U);
    EXPECT_EQ(rest.variant.further.front().path, formula.own().paths.front());
  }
}

/// A Stribeck friction holds a Coulomb friction, and a relaxation none.
TEST(Sets, TakeASimplerFormulaFromTheValuesOfTheOneThatHoldsIt) {
  const std::string truth =
      test::axis({"HY_COULOMB_FRICTION := (LEVEL := 0.3, PRESLIDE := 0.0001)", "MASS.XOUT", ", V := LATE.XOUT"});
  const DiagnosisInput input =
      test::input_of(test::axis(), test::axis_parameters,
                     {test::measured(test::program_of(truth), test::record_of("FORCE", test::rich_force()), 0.001)});
  Task task = task_of(input);
  task.scales = {0.001};
  const Variant bare{.text = input.text, .program = std::make_shared<const Program>(input.program)};
  std::vector<Candidate> list = candidates_of(bare, "AXIS", {.effects = {"stribeck_friction"}});
  std::erase_if(list, [](const Candidate& one) { return one.own().edge != "MASS.XOUT"; });
  ASSERT_FALSE(list.empty());
  Explanation whole{.variant = list.front().variant};
  for (const std::string& path : whole.variant.effects.front().paths) {
    const bool is_level = path.ends_with("LEVEL");
    whole.variant.further.push_back({.path = path,
                                     .start = is_level                     ? 0.29
                                              : path.ends_with("STICTION") ? 0.01
                                              : path.ends_with("PRESLIDE") ? 1e-4
                                                                           : 0.5,
                                     .lower = 0.0,
                                     .upper = 10.0,
                                     .typical = 0.1,
                                     .deviation = std::numeric_limits<double>::infinity()});
  }
  Model model(task, *whole.variant.program, whole.variant.further);
  whole.fit.x = model.start();
  const CandidateOptions options{};
  const std::vector<Explanation> simpler = Sets(task, "AXIS", options).in_simpler_formulas(whole, 0, bare);
  ASSERT_EQ(simpler.size(), 1U);
  EXPECT_EQ(simpler.front().names(), std::vector<std::string>{"coulomb_friction"});
  const std::optional<Index> level = place_in_fit(task, simpler.front(), simpler.front().variant.further.front().path);
  ASSERT_TRUE(level);
  EXPECT_NEAR(simpler.front().fit.x[*level], 0.3, 0.01);
  EXPECT_LT(simpler.front().fit.cost, 1.1 * 0.5 * 2000.0);
}

}  // namespace
}  // namespace hysteron::diagnosis
