// A delay that varies about its mean.
#include "diagnosis/verdict/jitter.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "diagnosis/model/task.hpp"
#include "tests/diagnosis/simulated_machine.hpp"

namespace hysteron::diagnosis {
namespace {

/// No search here ends for its effort.
constexpr double unhurried = 100.0;

constexpr double sample_time = 0.005;
constexpr double mean_delay = 0.03;
constexpr double noise = 0.002;

/// A signal, late by the mean and by a part that is drawn anew every eight samples, straight between the draws.
std::vector<double> late(const std::vector<double>& signal, double deviation) {
  test::Noise random(7);
  std::vector<double> draws(signal.size() / 8 + 2);
  std::ranges::generate(draws, [&] { return deviation * random(); });
  std::vector<double> result;
  for (std::size_t k = 0; k < signal.size(); ++k) {
    const double part = static_cast<double>(k % 8) / 8.0;
    const double delay = mean_delay + std::lerp(draws[k / 8], draws[k / 8 + 1], part);
    const double at = std::max(0.0, static_cast<double>(k) - std::max(0.0, delay) / sample_time);
    const auto below = static_cast<std::size_t>(at);
    result.push_back(
        std::lerp(signal[below], signal[std::min(below + 1, signal.size() - 1)], at - static_cast<double>(below)));
  }
  return result;
}

/// A signal behind (1 − a s)/(1 + b s)², which goes the wrong way first: a zero in the right half-plane.
std::vector<double> wrong_way_first(const std::vector<double>& signal) {
  constexpr double a = 0.1;
  constexpr double b = 0.05;
  constexpr int substeps = 50;
  double first = 0.0;
  double second = 0.0;
  std::vector<double> result;
  for (const double value : signal) {
    result.push_back(second - a * (first - second) / b);
    for (int i = 0; i < substeps; ++i) {
      second += sample_time / substeps * (first - second) / b;
      first += sample_time / substeps * (value - first) / b;
    }
  }
  return result;
}

/// A record of the axis that gets `force` where its record says another.
records::Record axis_with(const std::vector<double>& force, const test::Effect& effect = {}) {
  const records::Record driven =
      test::measured(test::program_of(test::axis(effect)), test::record_of("FORCE", force), noise);
  records::Record record = test::record_of("FORCE", test::rich_force());
  record.add(driven.column("V"));
  return record;
}

/// A record of the axis whose force comes late.
records::Record late_axis(double deviation, const test::Effect& effect = {}) {
  return axis_with(late(test::rich_force(), deviation), effect);
}

/// The axis with a delay of its force, fitted.
struct DelayedAxis {
  explicit DelayedAxis(const records::Record& record) : task(task_of(test::input_of(test::axis(), "", {record}))) {
    task.scales = {noise};
    const std::string text = test::axis();
    const Variant bare{.text = text, .program = std::make_shared<const Program>(test::program_of(text))};
    std::vector<Candidate> list = candidates_of(bare, "AXIS", {.effects = {"delay"}});
    std::erase_if(list, [](const Candidate& other) { return other.own().edge != "FORCE"; });
    one.variant = list.front().variant;
    one.variant.further = {{.path = one.variant.effects.back().paths.front(),
                            .start = 0.02,
                            .lower = 0.0,
                            .upper = 1.0,
                            .typical = 0.01,
                            .deviation = std::numeric_limits<double>::infinity()}};
    Model model(task, *one.variant.program, one.variant.further);
    one.fit = fit(model, model.start(), {.iterations = 40});
  }
  [[nodiscard]] std::optional<Jitter> jitter() const {
    const std::optional<JitterResponse> response = response_to_jitter(task, "AXIS", one, 2);
    return response ? std::optional(jitter_of(task, *response, one.fit.residuals)) : std::nullopt;
  }
  Task task{};
  Explanation one{};
};

TEST(Jitter, OfKnownSize) {
  for (const double deviation : {0.004, 0.008}) {
    const DelayedAxis fitted(late_axis(deviation));
    const std::optional<Jitter> found = fitted.jitter();
    ASSERT_TRUE(found);
    EXPECT_GT(found->left, 2.0);
    // Knots six samples apart stand for draws eight apart, which move the speed more.
    EXPECT_GT(found->deviation, deviation);
    EXPECT_LT(found->deviation, 1.7 * deviation);
    EXPECT_LT(found->unexplained, 0.5 * found->left) << "of " << found->left;
    EXPECT_GT(found->unexplained, 1.0) << "each knot that is estimated is paid for";
    EXPECT_GT(found->evenness, 0.4);
    EXPECT_LT(found->evenness, 2.5);
    EXPECT_LT(found->filtered, 0.2);
  }
}

TEST(Jitter, NoneWhereTheDelayIsConstant) {
  const DelayedAxis fitted(late_axis(0.0));
  const std::optional<Jitter> found = fitted.jitter();
  ASSERT_TRUE(found);
  EXPECT_LT(found->deviation, 0.001);
  EXPECT_NEAR(found->unexplained, found->left, 0.02);
}

TEST(Jitter, IsNotWhatInputsForetell) {
  const DiagnosisOptions options{.effects = {"delay"}, .effort = unhurried};
  const DiagnosisInput constant = test::input_of(
      test::axis(), test::axis_parameters,
      {late_axis(0.0, {"HY_COULOMB_FRICTION := (LEVEL := 0.4, PRESLIDE := 0.001)", "FORCE", ", V := LATE.XOUT"})});
  EXPECT_THAT(diagnose(constant, options).warnings, testing::Not(testing::Contains(testing::HasSubstr("varies by"))));
  const Diagnosis jittered = diagnose(test::input_of(test::axis(), test::axis_parameters, {late_axis(0.008)}), options);
  EXPECT_THAT(jittered.warnings, testing::Contains(testing::HasSubstr("The delay at FORCE varies by")));
  EXPECT_NE(jittered.verdict, Verdict::Partial) << jittered.summary;
}

/// Behind the integrator what the variation leaves is a random walk, which a fit of constant delays bends a cube after.
TEST(Jitter, HidesNoEffectBesideIt) {
  const DiagnosisInput both =
      test::input_of(test::axis(), test::axis_parameters,
                     {late_axis(0.012, {"HY_ODD_NONLINEARITY := (SIZE := -0.3, REFERENCE := 3.0)", "FORCE"})});
  const Diagnosis found =
      diagnose(both, {.effects = {"delay", "odd_nonlinearity", "lag", "dead_zone", "saturation"}, .effort = unhurried});
  std::vector<std::string> names;
  for (const EffectFinding& one : found.effects) {
    names.push_back(one.id);
  }
  EXPECT_THAT(names, testing::UnorderedElementsAre("delay", "odd_nonlinearity")) << found.summary;
  EXPECT_THAT(found.warnings, testing::Contains(testing::HasSubstr("varies by")));
}

/// A position: the axis with another integrator behind its speed.
std::string position_axis() {
  std::string text = test::axis();
  const auto put = [&text](std::string_view old, std::string_view with) {
    text.replace(text.find(old), old.size(), with);
  };
  put("(* @unit m/s *)", "(* @unit m *)");
  put("SPEED : HY_INTEGRAL;", "SPEED : HY_INTEGRAL;\n    POS : HY_INTEGRAL;");
  put("V := SPEED.XOUT;", "POS(XIN := SPEED.XOUT);\n  V := POS.XOUT;");
  return text;
}

TEST(Jitter, IsNotAnotherFilterInTheDelaysPlace) {
  const std::vector<double> filtered = wrong_way_first(test::rich_force());
  const std::optional<Jitter> found = DelayedAxis(axis_with(filtered)).jitter();
  ASSERT_TRUE(found);
  EXPECT_GT(found->left, 3.0);
  EXPECT_GT(found->filtered, 0.5);
  records::Record record = test::record_of("FORCE", test::rich_force());
  record.add(test::measured(test::program_of(position_axis()), test::record_of("FORCE", filtered), 1e-3).column("V"));
  const Diagnosis diagnosis = diagnose(test::input_of(position_axis(), test::axis_parameters, {std::move(record)}),
                                       {.effects = {"delay", "viscous_friction"}, .effort = unhurried});
  EXPECT_THAT(diagnosis.warnings, testing::Not(testing::Contains(testing::HasSubstr("varies by"))))
      << diagnosis.summary;
}

/// Two axes, each with its own input and output.
constexpr const char* two_axes = R"(FUNCTION_BLOCK PAIR  (* @ts 5ms *)
  VAR_INPUT
    UX : LREAL;
    UY : LREAL;
  END_VAR
  VAR_OUTPUT
    X : LREAL;
    Y : LREAL;
  END_VAR
  VAR
    GX : HY_GAIN := (K := 2.0);
    GY : HY_GAIN := (K := 2.0);
    LX : HY_LAG := (T1 := 0.05);
    LY : HY_LAG := (T1 := 0.05);
  END_VAR
  GX(XIN := UX);
  GY(XIN := UY);
  LX(XIN := GX.XOUT);
  LY(XIN := GY.XOUT);
  X := LX.XOUT;
  Y := LY.XOUT;
END_FUNCTION_BLOCK
)";
constexpr const char* two_axes_parameters = R"([parameters.GX]
K = 2.0
[parameters.GY]
K = 2.0
[fit.GX]
K = {}
[fit.GY]
K = {}
[tune]
outputs = ["X", "Y"]
)";

/// A delay of one axis leaves that axis at its noise, as no delay does; the gap of the other is still there.
TEST(Jitter, CountsTheOutputsThatTheDelayDoesNotReach) {
  const std::vector<double> force = test::rich_force();
  const std::vector<double> late_force(force.rbegin(), force.rend());
  // Two backlashes: by one effect more than noise is left.
  std::string machine = two_axes;
  machine.replace(machine.find("    GX :"), 0,
                  "    WIDE : HY_BACKLASH := (WIDTH := 2.0);\n    NARROW : HY_BACKLASH := (WIDTH := 0.5);\n");
  machine.replace(machine.find("GX(XIN := UX)"), 13,
                  "WIDE(XIN := UX);\n  NARROW(XIN := UX);\n  GX(XIN := 0.5 * WIDE.XOUT + 0.5 * NARROW.XOUT)");
  records::Record record = test::record_of("UX", force);
  record.add({.name = "UY", .unit = "", .values = late_force});
  record = test::measured(test::program_of(machine), std::move(record), noise);
  const Diagnosis found = diagnose(test::input_of(two_axes, two_axes_parameters, {std::move(record)}),
                                   {.effects = {"backlash", "delay"}, .effort = unhurried});
  ASSERT_FALSE(found.effects.empty()) << found.summary;
  EXPECT_EQ(found.effects.front().id, "backlash") << found.summary;
  EXPECT_THAT(found.warnings, testing::Not(testing::Contains(testing::HasSubstr("varies by"))));
}

/// What varies adds up behind two integrators, further than any constant delay comes near; nothing else is there.
TEST(Jitter, IsADelayAloneWhereItAddsUp) {
  records::Record record = test::record_of("FORCE", test::rich_force());
  record.add(
      test::measured(test::program_of(position_axis()), test::record_of("FORCE", late(test::rich_force(), 0.012)), 1e-3)
          .column("V"));
  const Diagnosis found =
      diagnose(test::input_of(position_axis(), test::axis_parameters, {std::move(record)}),
               {.effects = {"delay", "odd_nonlinearity", "cogging", "relaxation", "load"}, .effort = unhurried});
  ASSERT_EQ(found.effects.size(), 1U) << found.summary;
  EXPECT_EQ(found.effects[0].id, "delay");
  EXPECT_GT(found.effects[0].share, 0.9) << "what its variation does counts as explained";
  EXPECT_NEAR(found.effects[0].parameters[0].value, mean_delay, 0.006);
  EXPECT_THAT(found.warnings, testing::Contains(testing::HasSubstr("varies by")));
}

/// Behind one integrator lines of a cogging follow the random walk that a varying delay leaves: the smaller set is the
/// better one, although it leaves no quarter of what they do.
TEST(Jitter, NeedsNoEffectBesideIt) {
  const Diagnosis found =
      diagnose(test::input_of(test::axis(), test::axis_parameters, {late_axis(0.006)}),
               {.effects = {"delay", "cogging", "periodic_disturbance", "load", "relaxation"}, .effort = unhurried});
  ASSERT_EQ(found.effects.size(), 1U) << found.summary;
  EXPECT_EQ(found.effects[0].id, "delay");
  EXPECT_NE(found.verdict, Verdict::Partial);
}

}  // namespace
}  // namespace hysteron::diagnosis
