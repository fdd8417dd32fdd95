// The whole diagnosis on simulated machines: an effect that was put in is the one that is named.
#include "diagnosis/diagnose.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <ostream>
#include <string>
#include <vector>

#include "diagnosis/report/verdict_json.hpp"
#include "tests/diagnosis/simulated_machine.hpp"

namespace hysteron::diagnosis {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

/// A machine with one effect, and the effects that are tried.
struct Injected {
  std::string name{};
  std::string machine{};
  std::string nominal{};
  std::string_view parameters{};
  std::vector<std::string> tried{};
  std::vector<std::string> edges{};  ///< those that are right; empty: any

  [[nodiscard]] bool is_stack() const { return nominal == test::stack(); }
};

void PrintTo(const Injected& one, std::ostream* out) {
  *out << one.name;
}

Injected on_stack(std::string name, const test::Effect& effect, std::vector<std::string> rivals,
                  std::vector<std::string> edges) {
  rivals.push_back(name);
  return {std::move(name),        test::stack(effect), test::stack(),
          test::stack_parameters, std::move(rivals),   std::move(edges)};
}

Injected on_axis(std::string name, const test::Effect& effect, std::vector<std::string> rivals,
                 std::vector<std::string> edges) {
  rivals.push_back(name);
  return {std::move(name),       test::axis(effect), test::axis(),
          test::axis_parameters, std::move(rivals),  std::move(edges)};
}

records::Record record_of(const Injected& one, std::uint64_t seed = 1) {
  const Program machine = test::program_of(one.machine);
  return one.is_stack() ? test::measured(machine, test::record_of("U", test::rich_voltage()), 0.02, seed)
                        : test::measured(machine, test::record_of("FORCE", test::rich_force()), 0.001, seed);
}

Diagnosis diagnosed(const Injected& one, std::uint64_t seed = 1) {
  return diagnose(test::input_of(one.nominal, one.parameters, {record_of(one, seed)}), {.effects = one.tried});
}

class NamedFirst : public testing::TestWithParam<Injected> {};

TEST_P(NamedFirst, WithItsEdgeAndTheGapClosed) {
  const Injected& truth = GetParam();
  const Diagnosis found = diagnosed(truth);
  ASSERT_THAT(found.refusals, IsEmpty());
  ASSERT_FALSE(found.effects.empty()) << found.summary;
  const EffectFinding& first = found.effects.front();
  EXPECT_EQ(first.id, truth.name) << found.summary;
  ASSERT_FALSE(found.rivals.empty());
  EXPECT_THAT(found.rivals.front().effects, ElementsAre(truth.name));
  EXPECT_TRUE(found.verdict == Verdict::Named || found.verdict == Verdict::Group) << name_of(found.verdict);
  std::vector<std::string> said = first.same_edges;
  said.push_back(first.edge);
  EXPECT_THAT(truth.edges, Contains(testing::AnyOfArray(said))) << first.edge;
  EXPECT_GT(found.gap.closed, 0.95);
  EXPECT_LE(found.gap.closed_low, found.gap.closed);
  EXPECT_GE(found.gap.closed_high, found.gap.closed);
  EXPECT_LT(found.gap.improved, 1.15 * (truth.is_stack() ? 0.02 : 0.001));
  EXPECT_GT(found.gap.calibrated, found.gap.improved);
  EXPECT_GT(first.share, 0.9);
}

INSTANTIATE_TEST_SUITE_P(Stack, NamedFirst,
                         testing::Values(on_stack("creep", {"HY_CREEP := (GAIN := 0.05, T_ONSET := 0.05)", "HYST.XOUT"},
                                                  {"relaxation", "lag", "offset", "drift"}, {"HYST.XOUT"}),
                                         on_stack("delay", {"HY_DEAD_TIME := (DEAD_TIME := 0.03)", "U"},
                                                  {"lag", "creep", "backlash", "rate_limit"},
                                                  {"U", "AMP.XOUT", "HYST.XOUT"}),
                                         on_stack("backlash", {"HY_BACKLASH := (WIDTH := 0.2)", "U"},
                                                  {"delay", "lag", "creep", "asymmetry"}, {"U"}),
                                         on_stack("drift", {"HY_DRIFT := (RATE := 0.08)", "HYST.XOUT"},
                                                  {"thermal_drift", "creep", "offset", "gain_drift"}, {"HYST.XOUT"})),
                         [](const auto& instance) { return instance.param.name; });

INSTANTIATE_TEST_SUITE_P(
    Axis, NamedFirst,
    testing::Values(on_axis("coulomb_friction",
                            {"HY_COULOMB_FRICTION := (LEVEL := 0.4, PRESLIDE := 0.001)", "FORCE", ", V := LATE.XOUT"},
                            {"viscous_friction", "dead_zone", "load", "backlash"}, {"FORCE", "MASS.XOUT"}),
                    on_axis("viscous_friction",
                            {"HY_VISCOUS_FRICTION := (COEFFICIENT := 0.4)", "FORCE", ", V := LATE.XOUT"},
                            {"coulomb_friction", "dead_zone", "lag", "drift"}, {"FORCE", "MASS.XOUT"}),
                    on_axis("load", {"HY_LOAD := (SIZE := 0.3, T_ON := 4.0)", "FORCE"},
                            {"drift", "offset", "coulomb_friction", "gain_drift"}, {"FORCE", "MASS.XOUT"}),
                    on_axis("dead_zone", {"HY_DEAD_BAND := (WIDTH := 0.3)", "FORCE"},
                            {"coulomb_friction", "backlash", "odd_nonlinearity", "saturation"},
                            {"FORCE", "MASS.XOUT"})),
    [](const auto& instance) { return instance.param.name; });

TEST(Diagnosis, AsymmetryIsARicherBlock) {
  Injected truth =
      on_stack("asymmetry", {}, {"return_point_memory", "even_nonlinearity", "backlash", "curve_shape"}, {"HYST.XOUT"});
  truth.machine = test::stack({}, "HY_HYSTERESIS_GENERAL");
  truth.machine.replace(truth.machine.find("C1 := 5.0"), 9, "ASYMMETRY := 0.15, C1 := 5.0");
  const Diagnosis found = diagnosed(truth);
  ASSERT_FALSE(found.effects.empty()) << found.summary;
  EXPECT_EQ(found.effects.front().id, "asymmetry") << found.summary;
  EXPECT_EQ(found.effects.front().edge, "HYST.XOUT");
  EXPECT_THAT(found.improved_text, HasSubstr("HYST : HY_HYSTERESIS_GENERAL"));
  ASSERT_FALSE(found.effects.front().parameters.empty());
  const ParameterFinding& asymmetry = found.effects.front().parameters.front();
  EXPECT_LE(asymmetry.low, 0.16);
  EXPECT_GE(asymmetry.high, 0.14);
}

TEST(Diagnosis, AQuantumOfAHundredStepsInsideIsFound) {
  // A quantum that is off by a percent is out of step at the far end of the range, and fits no better than any other.
  constexpr double quantum = 0.0317;
  const Diagnosis found =
      diagnosed(on_stack("quantization", {fmt::format("HY_QUANTIZER := (QUANTUM := {})", quantum), "AMP.XOUT"},
                         {"branch_chatter", "backlash"}, {}));
  ASSERT_EQ(found.effects.size(), 1U) << found.summary;
  EXPECT_EQ(found.effects.front().id, "quantization");
  ASSERT_FALSE(found.effects.front().parameters.empty());
  EXPECT_NEAR(found.effects.front().parameters.front().value, quantum, 0.002 * quantum);
}

/// A heated body; rounded, its output has no derivative by what lies before.
std::string heater(std::string_view sensor) {
  return fmt::format(
      "FUNCTION_BLOCK HEATER (* @ts 5ms *) VAR_INPUT FORCE : LREAL; END_VAR VAR_OUTPUT Y : LREAL; END_VAR VAR GAIN : "
      "HY_GAIN := (K := 3.0); BODY : HY_LAG := (T1 := 0.4); {} END_VAR GAIN(XIN := FORCE); BODY(XIN := GAIN.XOUT); {} "
      "END_FUNCTION_BLOCK",
      sensor, sensor.empty() ? "Y := BODY.XOUT;" : "ADC(XIN := BODY.XOUT); Y := ADC.XOUT;");
}

/// With tuned values that are two percent off.
Diagnosis heater_diagnosed(std::vector<records::Record> log) {
  return diagnose(
      test::input_of(
          heater(""),
          "[parameters.GAIN]\nK = 2.95\n[parameters.BODY]\nT1 = 0.407\n[fit.GAIN]\nK = {}\n[fit.BODY]\nT1 = {}\n",
          std::move(log)),
      {.effects = {"quantization", "cogging", "backlash", "odd_nonlinearity"}});
}

/// A record of the heater behind a sensor that rounds, with noise of this share of the quantum.
records::Record rounded_heater(double quantum, double noise) {
  const Program machine = test::program_of(heater(fmt::format("ADC : HY_QUANTIZER := (QUANTUM := {});", quantum)));
  return test::measured(machine, test::record_of("FORCE", test::rich_force()), noise * quantum);
}

TEST(Diagnosis, ALoadThatIsOverBetweenTwoPartsOfAGridIsFound) {
  const Program machine = test::program_of(heater("ADC : HY_LOAD := (SIZE := 0.6, T_ON := 3.37, T_OFF := 3.61);"));
  const Diagnosis found =
      diagnose(test::input_of(heater(""), "[parameters.GAIN]\nK = 2.95\n[fit.GAIN]\nK = {}\n",
                              {test::measured(machine, test::record_of("FORCE", test::rich_force()), 0.01)}),
               {.effects = {"load", "drift", "lag", "offset", "odd_nonlinearity"}});
  ASSERT_EQ(found.effects.size(), 1U) << found.summary;
  EXPECT_EQ(found.effects.front().id, "load");
  ASSERT_EQ(found.effects.front().parameters.size(), 3U);
  EXPECT_NEAR(found.effects.front().parameters[1].value, 3.37, 0.005);
  EXPECT_NEAR(found.effects.front().parameters[2].value, 3.61, 0.005);
}

TEST(Diagnosis, ACoarseSensorHidesNoParameterOfWhatLiesBeforeIt) {
  constexpr double quantum = 0.2137;  // some twenty steps
  const Diagnosis found = heater_diagnosed({rounded_heater(quantum, 0.01)});
  ASSERT_EQ(found.effects.size(), 1U) << found.summary;
  EXPECT_EQ(found.effects.front().id, "quantization");
  EXPECT_NEAR(found.effects.front().parameters.at(0).value, quantum, 1e-3 * quantum);
  EXPECT_LT(found.gap.improved, 2.0 * 0.01 * quantum);
}

TEST(Diagnosis, AFineQuantumIsFoundBehindNoiseOfItsOwnSize) {
  constexpr double quantum = 0.0137;
  const Diagnosis found = heater_diagnosed({rounded_heater(quantum, 0.28)});
  ASSERT_EQ(found.effects.size(), 1U) << found.summary;
  EXPECT_EQ(found.effects.front().id, "quantization");
  EXPECT_NEAR(found.effects.front().parameters.at(0).value, quantum, 1e-3 * quantum);
}

TEST(Diagnosis, UnevenStepsAreAQuantiserAndNoRipple) {
  // The codes of a converter begin some tenth of a step too early or too late; the quantiser's even steps explain less
  // than the first wave of a ripple does.
  constexpr double quantum = 0.1137;
  const Program machine = test::program_of(heater(""));
  const records::Record smooth = test::measured(machine, test::record_of("FORCE", test::rich_force()), 0.0);
  const std::vector<double> late = test::Noise(11).white(4000, 0.08);
  const std::vector<double> noise = test::Noise(12).white(smooth.size(), 0.02 * quantum);
  const records::Record log = test::changed(smooth, "Y", [&](std::vector<double>& values) {
    for (std::size_t k = 0; k < values.size(); ++k) {
      const double code = std::floor(values[k] / quantum);
      const double threshold = 0.5 + late.at(static_cast<std::size_t>(code + 2000.0));
      values[k] = quantum * (values[k] / quantum - code > threshold ? code + 1.0 : code) + noise[k];
    }
  });
  const Diagnosis found = heater_diagnosed({log});
  ASSERT_FALSE(found.effects.empty()) << found.summary;
  EXPECT_EQ(found.effects.front().id, "quantization");
  EXPECT_NEAR(found.effects.front().parameters.at(0).value, quantum, 2e-3 * quantum);
  EXPECT_NE(found.verdict, Verdict::Partial) << found.summary;
  EXPECT_LT(found.unknown_score, 0.3);
  EXPECT_THAT(found.warnings, Contains(HasSubstr("unequal widths")));
}

TEST(Diagnosis, AWarmUpIsNotTakenForWhatFitsAGridBetter) {
  const Diagnosis found =
      diagnosed(on_axis("thermal_drift", {"HY_THERMAL_DRIFT := (SIZE := 0.05, T1 := 2.9)", "SPEED.XOUT"},
                        {"cogging", "drift", "offset", "load", "relaxation"}, {}));
  ASSERT_EQ(found.effects.size(), 1U) << found.summary;
  EXPECT_EQ(found.effects.front().id, "thermal_drift");
  EXPECT_NEAR(found.effects.front().parameters.at(1).value, 2.9, 0.15);
}

TEST(Diagnosis, ACubeIsAboutZeroWhereTheRecordReachesALittleFarther) {
  // Up to a hundredth farther to one side: about the middle of that, the cube would be a square too.
  auto force = test::rich_force();
  for (double& value : force) {
    value *= value > 0.0 ? 1.02 : 1.0;
  }
  const std::string machine = test::axis({"HY_ODD_NONLINEARITY := (SIZE := 0.4, REFERENCE := 1.0)", "FORCE"});
  const Diagnosis found =
      diagnose(test::input_of(test::axis(), test::axis_parameters,
                              {test::measured(test::program_of(machine), test::record_of("FORCE", force), 0.001)}),
               {.effects = {"odd_nonlinearity", "saturation"}});
  ASSERT_EQ(found.effects.size(), 1U) << found.summary;
  EXPECT_EQ(found.effects.front().id, "odd_nonlinearity");
  EXPECT_LT(found.gap.improved, 1.05 * 0.001);
}

TEST(Diagnosis, NoiseOfALoggedInputIsNoQuantiserOfTheMachine) {
  // A quantiser before the loop quiets the detector too, and where the voltage rests on multiples of its quantum it
  // leaves less than a dead band does, whose extremes the noise has shifted.
  std::vector<double> voltage = test::rich_voltage();
  std::ranges::for_each(voltage, [](double& level) { level = 0.5 * std::round(2.0 * level); });
  for (std::size_t k = 1; k < voltage.size(); ++k) {
    voltage[k] = std::clamp(voltage[k], voltage[k - 1] - 0.05, voltage[k - 1] + 0.05);
  }
  const records::Record quiet =
      test::measured(test::program_of(test::stack()), test::record_of("U", std::move(voltage)), 0.005);
  test::Noise noise(7);
  const records::Record logged = test::changed(quiet, "U", [&](std::vector<double>& values) {
    std::ranges::for_each(values, [&](double& value) { value += 0.001 * noise(); });
  });
  const Diagnosis found = diagnose(test::input_of(test::stack(), test::stack_parameters, {logged}),
                                   {.effects = {"quantization", "backlash", "branch_chatter", "dead_zone"}});
  ASSERT_EQ(found.effects.size(), 1U) << found.summary;
  EXPECT_EQ(found.effects.front().id, "branch_chatter") << found.summary;
  ASSERT_FALSE(found.rivals.empty());
  EXPECT_THAT(found.rivals.front().effects, ElementsAre("branch_chatter"));
}

TEST(Diagnosis, AConstantBeforeAnIntegratorIsNoDriftBehindIt) {
  // Both are the same to the last digits.
  const Diagnosis found = diagnosed(
      on_axis("offset", {"HY_OFFSET := (BIAS := 0.05)", "FORCE"}, {"drift", "thermal_drift", "even_nonlinearity"}, {}));
  ASSERT_FALSE(found.effects.empty()) << found.summary;
  EXPECT_EQ(found.effects.front().id, "offset") << found.summary;
}

TEST(Diagnosis, ALimitOnOneSideIsFound) {
  // The other bound is infinite, and has to stay so through fit, parameter file, verdict and next experiment.
  const Diagnosis found =
      diagnosed(on_axis("saturation", {"HY_LIMIT := (MX := 1.1)", "FORCE"}, {"odd_nonlinearity", "drift"}, {"FORCE"}));
  ASSERT_EQ(found.effects.size(), 1U) << found.summary;
  EXPECT_EQ(found.effects.front().id, "saturation");
  ASSERT_EQ(found.effects.front().parameters.size(), 1U);
  EXPECT_EQ(found.effects.front().parameters.front().name, "MX");
  EXPECT_NEAR(found.effects.front().parameters.front().value, 1.1, 0.01);
  EXPECT_TRUE(std::isfinite(found.next.separation));
  EXPECT_THAT(found.improved_file.values,
              Not(Contains(testing::Field(&parameters::ParameterValue::path, HasSubstr("MN")))));
}

TEST(Diagnosis, AnIntegralThatStopsIsFoundWithItsBound) {
  // A tank with a brim: what overflows is lost, so that no limit of a signal does the same.
  const auto tank = [](std::string_view level) {
    return fmt::format(
        "FUNCTION_BLOCK TANK (* @ts 5ms *) VAR_INPUT FORCE : LREAL; END_VAR VAR_OUTPUT Y : LREAL; END_VAR VAR PUMP : "
        "HY_GAIN := (K := 0.5); LEVEL : {}; DRAIN : HY_GAIN := (K := 0.8); END_VAR DRAIN(XIN := LEVEL.XOUT); PUMP(XIN "
        ":= FORCE); LEVEL(XIN := PUMP.XOUT - DRAIN.XOUT); Y := LEVEL.XOUT; END_FUNCTION_BLOCK",
        level);
  };
  records::Record record = test::measured(test::program_of(tank("HY_INTEGRAL_FORWARD_BOUNDED := (MX := 0.25)")),
                                          test::record_of("FORCE", test::rich_force()), 0.001);
  const Diagnosis found = diagnose(
      test::input_of(tank("HY_INTEGRAL_FORWARD"), "[fit.PUMP]\nK = {}\n[fit.DRAIN]\nK = {}\n", {std::move(record)}),
      {.effects = {"saturation", "load", "odd_nonlinearity", "rate_limit"}});
  ASSERT_EQ(found.effects.size(), 1U) << found.summary;
  EXPECT_EQ(found.effects.front().id, "saturation");
  EXPECT_THAT(found.improved_text, HasSubstr("HY_INTEGRAL_FORWARD_BOUNDED"));
  ASSERT_EQ(found.effects.front().parameters.size(), 1U);
  EXPECT_NEAR(found.effects.front().parameters.front().value, 0.25, 0.001);
}

TEST(Diagnosis, ParametersComeBackWithTheirIntervals) {
  const Injected truth = on_stack("drift", {"HY_DRIFT := (RATE := 0.08)", "HYST.XOUT"}, {"offset"}, {});
  const Diagnosis found = diagnosed(truth);
  ASSERT_EQ(found.effects.size(), 1U);
  const ParameterFinding& rate = found.effects[0].parameters.at(0);
  EXPECT_EQ(rate.name, "RATE");
  EXPECT_EQ(rate.unit, "um/s");
  EXPECT_NEAR(rate.value, 0.08, 0.002);
  EXPECT_LT(rate.high - rate.low, 0.01);
  EXPECT_LT(rate.low, rate.value);
  EXPECT_GT(rate.high, rate.value);
}

TEST(Diagnosis, NothingIsNamedWhereNothingIsMissing) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const Diagnosis stack = diagnosed(on_stack("creep", {}, {"backlash", "lag", "drift", "asymmetry"}, {}), seed);
    EXPECT_EQ(stack.verdict, Verdict::None) << stack.summary;
    EXPECT_THAT(stack.effects, IsEmpty());
    EXPECT_NEAR(stack.gap.improved, 0.02, 0.002);
    const Diagnosis axis = diagnosed(on_axis("load", {}, {"coulomb_friction", "lag", "drift", "dead_zone"}, {}), seed);
    EXPECT_EQ(axis.verdict, Verdict::None) << axis.summary;
    EXPECT_THAT(axis.effects, IsEmpty());
  }
}

TEST(Diagnosis, WrongParametersAreCalibration) {
  Injected stack = on_stack("creep", {}, {"backlash", "lag", "odd_nonlinearity", "asymmetry"}, {});
  stack.parameters = "[parameters.AMP]\nT1 = 0.022\n[parameters.HYST]\nC1 = 5.3\nC2 = 3.7\nC3 = 0.85\n";
  const Diagnosis found = diagnosed(stack);
  EXPECT_EQ(found.verdict, Verdict::Calibration) << found.summary;
  EXPECT_THAT(found.effects, IsEmpty());
  EXPECT_GT(found.gap.nominal, 3.0 * found.gap.calibrated);
  EXPECT_NEAR(found.gap.calibrated, 0.02, 0.002);
  for (const ParameterFinding& one : found.calibration) {
    const double truth = one.name == "AMP.T1" ? 0.02 : one.name == "HYST.C1" ? 5.0 : one.name == "HYST.C2" ? 4.0 : 0.8;
    EXPECT_NEAR(one.value, truth, 0.02 * truth) << one.name;
  }
  EXPECT_EQ(found.calibration.size(), 4U);
}

TEST(Diagnosis, AnEffectBesideWrongParametersIsNamed) {
  Injected stack = on_stack("backlash", {"HY_BACKLASH := (WIDTH := 0.2)", "U"}, {"lag", "creep", "drift"}, {"U"});
  stack.parameters = "[parameters.AMP]\nT1 = 0.021\n[parameters.HYST]\nC1 = 5.2\nC2 = 3.8\nC3 = 0.82\n";
  const Diagnosis found = diagnosed(stack);
  ASSERT_FALSE(found.effects.empty()) << found.summary;
  EXPECT_EQ(found.effects[0].id, "backlash") << found.summary;
}

TEST(Diagnosis, WithAllEffectsTriedTheOneIsNamed) {
  Injected truth = on_stack("backlash", {"HY_BACKLASH := (WIDTH := 0.25)", "U"}, {}, {"U"});
  truth.tried.clear();
  const Diagnosis found =
      diagnose(test::input_of(truth.nominal, truth.parameters, {record_of(truth)}), {.most_effects = 1, .seed = 3});
  ASSERT_FALSE(found.effects.empty()) << found.summary;
  EXPECT_EQ(found.effects[0].id, "backlash") << found.summary;
  EXPECT_GT(found.tried, 60U);
}

TEST(Diagnosis, AnEffectOfTheUsersOwnIsNamed) {
  const std::string sag =
      "FUNCTION_BLOCK SAG (* @effect sag *) VAR_INPUT XIN : LREAL; SIZE : LREAL := 0.0; (* @neutral 0 *) END_VAR "
      "VAR_OUTPUT XOUT : LREAL; END_VAR XOUT := XIN - SIZE * XIN * XIN * XIN / (4.0 + XIN * XIN); END_FUNCTION_BLOCK\n";
  Injected truth = on_axis("sag", {"SAG := (SIZE := 0.4)", "FORCE"}, {"saturation", "drift", "offset"}, {"FORCE"});
  truth.machine = sag + truth.machine;
  truth.nominal = sag + truth.nominal;
  records::Record record = test::measured(compile_text(truth.machine, {.top = "AXIS", .any_order = true}),
                                          test::record_of("FORCE", test::rich_force()), 0.001);
  DiagnosisInput input{.program = compile_text(truth.nominal, {.top = "AXIS"}), .text = truth.nominal};
  input.file = parameters::parse_parameter_file("p.toml", truth.parameters);
  input.records = {record};
  const Diagnosis found = diagnose(input, {.effects = truth.tried});
  ASSERT_FALSE(found.effects.empty()) << found.summary;
  EXPECT_EQ(found.effects[0].id, "sag") << found.summary;
  EXPECT_NEAR(found.effects[0].parameters.at(0).value, 0.4, 0.05);
}

TEST(Diagnosis, AnotherColumnThatCouplesIsNamed) {
  const Diagnosis found = diagnose(test::input_of(test::axis(), test::axis_parameters, {test::warm_sensor()}),
                                   {.effects = {"cross_coupling", "drift", "load", "viscous_friction"}});
  ASSERT_FALSE(found.effects.empty()) << found.summary;
  EXPECT_EQ(found.effects[0].id, "cross_coupling") << found.summary;
  EXPECT_EQ(found.effects[0].edge, "SPEED.XOUT");
  EXPECT_THAT(found.improved_text, HasSubstr("TEMP"));
}

TEST(Diagnosis, ACouplingActsFromWhereTheOtherSignalStood) {
  // In degrees Celsius, and before an integral: 20 of them at once would be a step of the force.
  std::string machine = test::axis({"HY_CROSS_COUPLING := (GAIN := 0.3, Z_REFERENCE := 20.0)", "FORCE", ", Z := TEMP"});
  machine.replace(machine.find("FORCE : LREAL;"), 14, "TEMP : LREAL; FORCE : LREAL;");
  records::Record record = test::record_of("FORCE", test::rich_force());
  std::vector<double> temperature;
  for (int k = 0; k < 2000; ++k) {
    temperature.push_back(20.0 + std::sin(0.005 * k * 1.9) + 0.5 * std::sin(0.005 * k * 4.3));
  }
  record.add({.name = "temp", .values = temperature});
  record = test::measured(test::program_of(machine), record, 0.001);
  const Diagnosis found = diagnose(test::input_of(test::axis(), test::axis_parameters, {record}),
                                   {.effects = {"cross_coupling", "drift", "load", "offset"}});
  ASSERT_FALSE(found.effects.empty()) << found.summary;
  EXPECT_EQ(found.effects[0].id, "cross_coupling") << found.summary;
  EXPECT_EQ(found.effects.size(), 1U) << found.summary;
  EXPECT_GT(found.gap.closed, 0.99);
}

TEST(Diagnosis, AnUnknownEffectIsNotGivenAName) {
  // Force that depends on the square of a slow copy of itself, among effects that know nothing of the sort.
  const std::string machine =
      "FUNCTION_BLOCK AXIS (* @ts 5ms *) VAR_INPUT FORCE : LREAL; END_VAR VAR_OUTPUT V : LREAL; END_VAR VAR MASS : "
      "HY_GAIN := (K := 0.5); SPEED : HY_INTEGRAL; SLOW : HY_LAG := (T1 := 0.3); END_VAR SLOW(XIN := FORCE); MASS(XIN "
      ":= FORCE); SPEED(XIN := MASS.XOUT); V := SPEED.XOUT + 0.03 * SLOW.XOUT * SLOW.XOUT; END_FUNCTION_BLOCK";
  const records::Record record =
      test::measured(test::program_of(machine), test::record_of("FORCE", test::rich_force()), 0.001);
  const Diagnosis found = diagnose(test::input_of(test::axis(), test::axis_parameters, {record}),
                                   {.effects = {"backlash", "delay", "drift"}});
  EXPECT_TRUE(found.verdict == Verdict::Unknown || found.verdict == Verdict::Partial) << found.summary;
  EXPECT_LT(found.confidence, 0.9);
  EXPECT_GT(found.unknown_score, 0.3);
}

TEST(Diagnosis, TheFloorDoesNotDependOnTheModel) {
  const Injected truth = on_stack("creep", {"HY_CREEP := (GAIN := 0.05)", "HYST.XOUT"}, {}, {});
  Injected poor = truth;
  poor.parameters = "[parameters.AMP]\nT1 = 0.05\n[parameters.HYST]\nC1 = 4.0\nC2 = 4.4\nC3 = 0.7\n";
  const double good = diagnosed(truth).gap.floor.value;
  EXPECT_EQ(good, diagnosed(poor).gap.floor.value);
  EXPECT_NEAR(good, 0.02, 0.003);
}

TEST(Diagnosis, IsTheSameForASeedOnOneCoreAndOnTwo) {
  const Injected truth = on_axis("load", {"HY_LOAD := (SIZE := 0.3, T_ON := 4.0)", "FORCE"}, {"drift", "lag"}, {});
  const auto run = [&](unsigned threads) {
    auto found = diagnose(test::input_of(truth.nominal, truth.parameters, {record_of(truth)}),
                          {.effects = truth.tried, .seed = 5, .threads = threads});
    found.seconds = 0.0;
    return verdict_json(found);
  };
  const std::string one = run(1);
  EXPECT_EQ(one, run(2));
  EXPECT_EQ(nlohmann::json::parse(one)["verdict"], "named");
}

TEST(Diagnosis, TellsHowFarItIs) {
  const Injected truth = on_axis("load", {"HY_LOAD := (SIZE := 0.3, T_ON := 4.0)", "FORCE"}, {"drift"}, {});
  std::vector<std::string> said;
  double last = 0.0;
  (void)diagnose(test::input_of(truth.nominal, truth.parameters, {record_of(truth)}),
                 {.effects = truth.tried, .threads = 1, .progress = [&](double fraction, std::string_view text) {
                    EXPECT_GE(fraction, last - 1e-12);
                    EXPECT_LE(fraction, 1.0 + 1e-12);
                    last = fraction;
                    said.emplace_back(text);
                  }});
  EXPECT_THAT(said, Contains(HasSubstr("load at FORCE")));
}

TEST(Diagnosis, TheSizeThatMattersSilencesASmallEffect) {
  const Injected truth = on_stack("drift", {"HY_DRIFT := (RATE := 0.01)", "HYST.XOUT"}, {"offset"}, {});
  const DiagnosisInput input = test::input_of(truth.nominal, truth.parameters, {record_of(truth)});
  EXPECT_EQ(diagnose(input, {.effects = truth.tried}).verdict, Verdict::Named);
  const Diagnosis found = diagnose(input, {.material = 0.5, .effects = truth.tried});
  EXPECT_EQ(found.verdict, Verdict::None) << found.summary;
}

}  // namespace
}  // namespace hysteron::diagnosis
