// What is said of a verdict: shares, the parts of the gap, sets with their edges, reasons.
#include "diagnosis/findings/findings.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "diagnosis/findings/left_out_findings.hpp"
#include "diagnosis/findings/shares.hpp"
#include "diagnosis/model/least_squares.hpp"
#include "diagnosis/model/task.hpp"
#include "tests/diagnosis/simulated_machine.hpp"

namespace hysteron::diagnosis {
namespace {

GapSplit split(const std::vector<EffectFinding>& effects) {
  return split_of(effects, test::read_text(test::stack(), "STACK").edges, {"U", "Y"});
}

TEST(GapSplit, ADelayOnAMeasuredWireIsOfInputAndOutput) {
  for (const char* id : {"delay", "clock", "quantization", "glitches"}) {
    const GapSplit found = split({{.id = id, .edge = "U", .share = 0.75}});
    EXPECT_DOUBLE_EQ(found.input_output, 0.75) << id;
    EXPECT_DOUBLE_EQ(found.plant, 0.0);
    EXPECT_DOUBLE_EQ(found.open, 0.25);
  }
  EXPECT_DOUBLE_EQ(split({{.id = "delay", .edge = "HYST.XOUT", .share = 0.5}}).input_output, 0.5) << "it is Y's wire";
}

TEST(GapSplit, WhatElseThereIsIsThePlants) {
  EXPECT_DOUBLE_EQ(split({{.id = "lag", .edge = "U", .share = 0.5}}).plant, 0.5);
  EXPECT_DOUBLE_EQ(split({{.id = "delay", .edge = "AMP.XOUT", .share = 0.5}}).plant, 0.5);
  const GapSplit both =
      split({{.id = "creep", .edge = "HYST.XOUT", .share = 0.6}, {.id = "delay", .edge = "U", .share = 0.3}});
  EXPECT_DOUBLE_EQ(both.plant, 0.6);
  EXPECT_DOUBLE_EQ(both.input_output, 0.3);
  EXPECT_NEAR(both.open, 0.1, 1e-15);
}

TEST(GapSplit, AnEdgeThatCannotBeToldFromAPortCountsAsOne) {
  EXPECT_DOUBLE_EQ(split({{.id = "delay", .edge = "AMP.XOUT", .same_edges = {"U"}, .share = 0.5}}).input_output, 0.5);
}

TEST(GapSplit, WithoutEffectsAllIsOpen) {
  EXPECT_DOUBLE_EQ(split({}).open, 1.0);
}

TEST(Rivals, EachEffectStandsBesideItsEdge) {
  // Found in the order lag, creep: the set is read in the order of the alphabet.
  const Task task{.outputs = {"A", "B"}, .scales = {1.0, 10.0}};
  Explanation set;
  set.variant.effects = {{.effect = "lag", .edge = "U"}, {.effect = "creep", .edge = "HYST.XOUT"}};
  set.fit.residuals = VectorXd::Constant(4, 1.0);
  const Rival rival = rival_of(task, 0, {.explanation = &set});
  EXPECT_EQ(rival.effects, (std::vector<std::string>{"creep", "lag"}));
  EXPECT_EQ(rival.edges, (std::vector<std::string>{"HYST.XOUT", "U"}));
}

TEST(Rivals, AnEdgeBesideAnotherEffectIsTheDiagrams) {
  const Task task{.outputs = {"Y"}, .scales = {1.0}};
  Explanation set;
  set.variant.effects = {{.effect = "load", .edge = "HYST.XOUT", .instance = "HYST_LOAD"},
                         {.effect = "lag", .edge = "HYST_LOAD.XOUT", .instance = "HYST_LOAD_LAG"},
                         {.effect = "offset", .edge = "HYST_LOAD_LAG.XIN", .instance = "HYST_LOAD_LAG_OFFSET"},
                         {.effect = "asymmetry", .edge = "HYST.XOUT", .is_own = true, .instance = "HYST"}};
  set.fit.residuals = VectorXd::Constant(4, 1.0);
  EXPECT_EQ(rival_of(task, 0, {.explanation = &set}).edges, (std::vector<std::string>(4, "HYST.XOUT")));
}

TEST(Rivals, LeaveWhatTheyLeaveOfTheOutputWithTheGap) {
  const Task task{.outputs = {"A", "B"}, .scales = {1.0, 10.0}};
  Explanation set;
  set.fit.residuals = VectorXd::Constant(4, 1.0);
  set.fit.residuals.tail(2).setConstant(2.0);
  EXPECT_DOUBLE_EQ(rival_of(task, 0, {.explanation = &set}).improved_rms, 1.0);
  EXPECT_DOUBLE_EQ(rival_of(task, 1, {.explanation = &set}).improved_rms, 20.0);
}

/// An unknown that was proposed has the unit of its block, 'x: what is told has that of the edge, or none.
TEST(EffectFindings, AParameterIsInTheUnitThatTheWiresGive) {
  for (const bool is_known : {true, false}) {
    std::string text = test::stack({"HY_LOAD := (SIZE := 2.0, T_ON := 1.0)", "HYST.XOUT"});
    for (const std::string unit : {"(* @unit V *)", "(* @unit um *)"}) {
      text.erase(is_known ? text.size() : text.find(unit), is_known ? 0 : unit.size());
    }
    const auto program = std::make_shared<const Program>(test::program_of(text));
    const records::Record log = test::measured(*program, test::record_of("U", test::rich_voltage()), 0.01);
    Task task = task_of(test::input_of(text, "[fit.AMP]\nT1 = {}\n", {log}));
    task.scales = {0.01};
    Explanation chosen{.variant = {.text = text, .program = program}};
    chosen.variant.effects = {{.effect = "load",
                               .edge = "HYST.XOUT",
                               .instance = "E",
                               .parameters = {{.name = "SIZE"}},
                               .paths = {"E.SIZE"}}};
    chosen.variant.further = {{.path = "E.SIZE", .unit = "'x", .start = 2.0, .lower = -10.0, .upper = 10.0}};
    Model model(task, *program, chosen.variant.further);
    chosen.fit = fit(model, model.start());
    Search search;
    search.calibrated = chosen;
    const Judgement judgement{.chosen = &chosen, .effective_samples = 2000.0};
    const auto found =
        effect_findings({.task = task, .search = search, .judgement = judgement, .kept = search.calibrated});
    ASSERT_EQ(found.size(), 1U);
    ASSERT_EQ(found[0].parameters.size(), 1U);
    EXPECT_EQ(found[0].parameters[0].unit, is_known ? "um" : "");
  }
}

TEST(Shares, WithAnEffectOutsideOfTheGapTheyAreOfBoth) {
  std::vector<EffectFinding> effects{{.id = "lag", .share = 0.8}, {.id = "drift", .share = 0.1}};
  EXPECT_DOUBLE_EQ(add_share(effects, 30.0, {.id = "glitches"}, 10.0), 40.0);
  EXPECT_DOUBLE_EQ(effects[0].share, 0.6);
  EXPECT_DOUBLE_EQ(effects[1].share, 0.075);
  EXPECT_DOUBLE_EQ(effects[2].share, 0.25);
  EXPECT_NEAR(split(effects).open, 0.075, 1e-12) << "what was open of the 30 stays open";
}

TEST(LeftOutOfFits, AThirdEffectHasToCloseANotablePart) {
  constexpr double gap = 1000.0;
  const Task task{.outputs = {"Y"}, .scales = {1.0}};
  Search search;
  search.calibrated.fit.cost = gap;
  search.calibrated.fit.residuals = VectorXd::Zero(200);
  const Judgement judgement{.chosen = &search.calibrated};
  const Findings findings{.task = task, .search = search, .judgement = judgement, .kept = search.calibrated};
  const std::vector<NoiseFloor> floors{{.value = 1.0}};
  const std::vector<double> noise{1.0};
  const std::vector<std::string> all;
  const auto effects_with = [&](std::vector<EffectFinding> others, double energy) {
    Diagnosis result;
    result.verdict = Verdict::Named;
    result.effects = std::move(others);
    result.gaps = {{.signal = "Y"}};
    const std::vector<LeftOut> glitches{
        {.effect = "glitches", .rms = std::sqrt(2.0 * energy / 200.0), .remark = "few"}};
    add_left_out(findings, {.left_out = glitches, .floors = floors, .noise = noise, .tried = all}, {}, result);
    EXPECT_EQ(result.warnings, std::vector<std::string>{"few"});
    return result.effects.size();
  };
  EXPECT_EQ(effects_with({}, 0.04 * gap), 1U);
  EXPECT_EQ(effects_with({{.id = "lag"}}, 0.04 * gap), 2U);
  EXPECT_EQ(effects_with({{.id = "lag"}, {.id = "drift"}}, 0.04 * gap), 2U);
  EXPECT_EQ(effects_with({{.id = "lag"}, {.id = "drift"}}, 0.06 * gap), 3U);
}

TEST(Reasons, ASlowPeriodIsNamedWhereSomethingStaysOpen) {
  const auto reasons = [](Verdict verdict, double duration) {
    return structural_reasons({.verdict = verdict}, 0.01, duration);
  };
  ASSERT_EQ(reasons(Verdict::Unknown, 60.0).size(), 1U);
  EXPECT_NE(reasons(Verdict::Partial, 60.0).front().find("slower than some 30 s"), std::string::npos);
  EXPECT_TRUE(reasons(Verdict::Named, 60.0).empty());
  EXPECT_TRUE(reasons(Verdict::Unknown, 0.0).empty()) << "it was not tried";
}

TEST(Reasons, ADelayWithinASampleMayBeTheModelsOwn) {
  const auto reasons = [](FieldRole role, double low) {
    const Diagnosis found{
        .effects = {{.id = "delay",
                     .edge = "BELT.XIN",
                     .parameters = {{.name = "LATE", .value = low, .low = low, .unit = "s", .role = role}}}}};
    return structural_reasons(found, 0.01, 0.0);
  };
  ASSERT_EQ(reasons(FieldRole::DeadTime, 0.005).size(), 1U);
  EXPECT_NE(
      reasons(FieldRole::DeadTime, 0.005).front().find("delay at BELT.XIN: it may be no more than a sample, 0.01 s"),
      std::string::npos);
  EXPECT_TRUE(reasons(FieldRole::DeadTime, 0.02).empty());
  EXPECT_TRUE(reasons(FieldRole::Number, 0.005).empty());
}

TEST(Findings, ASizeStandsBesideTheDistanceAtWhichItIs) {
  const std::string machine = test::axis({"HY_ODD_NONLINEARITY := (SIZE := -0.5, REFERENCE := 3.0)", "FORCE"});
  const Diagnosis found = diagnose(
      test::input_of(test::axis(), test::axis_parameters,
                     {test::measured(test::program_of(machine), test::record_of("FORCE", test::rich_force()), 0.001)}),
      {.effects = {"odd_nonlinearity"}});
  ASSERT_EQ(found.effects.size(), 1U) << found.summary;
  const EffectFinding& effect = found.effects.front();
  ASSERT_EQ(effect.settings.size(), 2U);
  EXPECT_EQ(effect.settings[0].name, "CENTRE");
  EXPECT_EQ(effect.settings[1].name, "REFERENCE");
  EXPECT_EQ(effect.settings[1].unit, "N");
  ASSERT_EQ(effect.parameters.size(), 1U);
  const double reference = effect.settings[1].value;
  EXPECT_NEAR(effect.parameters[0].value / (reference * reference * reference), -0.5 / 27.0, 0.002);
}

}  // namespace
}  // namespace hysteron::diagnosis
