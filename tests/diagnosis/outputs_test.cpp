// What the diagnosis says of each output, and of what is left out: numbers that agree with each other and with the
// diagram that it leaves.
#include <gmock/gmock.h>

#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include "diagnosis/diagnose.hpp"
#include "tests/diagnosis/simulated_machine.hpp"

namespace hysteron::diagnosis {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

records::Record drifting_stack(double rate) {
  const std::string drift = fmt::format("HY_DRIFT := (RATE := {:.3f})", rate);
  return test::measured(test::program_of(test::stack({drift, "HYST.XOUT"})), test::record_of("U", test::rich_voltage()),
                        0.02);
}

void add_glitches(records::Record& record, double size) {
  record = test::changed(record, "Y", [&](std::vector<double>& values) {
    for (const std::size_t k : {400U, 450U, 500U, 950U, 1000U, 1450U}) {
      values[k] += size;
    }
  });
}

double sum_of(const Diagnosis& found) {
  return std::accumulate(found.effects.begin(), found.effects.end(), 0.0,
                         [](double sum, const EffectFinding& effect) { return sum + effect.share; });
}

TEST(GlitchShare, IsThatOfTheirEnergyInTheGap) {
  records::Record record = drifting_stack(0.08);
  add_glitches(record, 4.0);
  const Diagnosis found = diagnose(test::input_of(test::stack(), test::stack_parameters, {record}),
                                   {.effects = {"drift", "offset", "glitches"}});
  ASSERT_EQ(found.effects.size(), 2U) << found.summary;
  EXPECT_EQ(found.effects[0].id, "glitches");  // the larger share first
  const double glitches = 6.0 * 16.0;
  const double rest = 2000.0 * (std::pow(found.gap.calibrated, 2) - std::pow(found.gap.improved, 2));
  EXPECT_NEAR(found.effects[0].share, glitches / (glitches + rest), 0.01);
  EXPECT_NEAR(sum_of(found) + found.split.open, 1.0, 1e-9);
  EXPECT_NEAR(found.split.input_output + found.split.plant + found.split.open, 1.0, 1e-9);
}

TEST(GlitchShare, IsTheWholeGapWhereNothingElseIs) {
  records::Record record = drifting_stack(0.0);
  add_glitches(record, 4.0);
  const Diagnosis found =
      diagnose(test::input_of(test::stack(), test::stack_parameters, {record}), {.effects = {"drift", "glitches"}});
  ASSERT_EQ(found.effects.size(), 1U) << found.summary;
  EXPECT_EQ(found.verdict, Verdict::Named);
  EXPECT_GT(found.effects[0].share, 0.98);
  EXPECT_NEAR(sum_of(found) + found.split.open, 1.0, 1e-9);
  EXPECT_EQ(found.rivals.at(0).improved_rms, found.gap.improved);
}

TEST(GlitchShare, ThoseThatALagHidesShowBesideIt) {
  std::vector<double> force(2000);
  for (std::size_t k = 0; k < force.size(); ++k) {
    const double t = 0.005 * static_cast<double>(k);
    const double sines = std::sin(test::two_pi * 20.0 * t) + 0.7 * std::sin(test::two_pi * 13.0 * t);
    force[k] = 40.0 * std::abs(std::sin(0.63 * t)) * sines;
  }
  records::Record record = test::measured(test::program_of(test::axis({"HY_LAG := (T1 := 0.01)", "SPEED.XOUT"})),
                                          test::record_of("FORCE", std::move(force)), 0.001);
  record = test::changed(record, "V", [](std::vector<double>& values) {
    for (const std::size_t k : {250U, 420U, 700U, 985U, 997U, 1010U, 1300U, 1500U, 1700U}) {
      values[k] += 0.05;
    }
  });
  const Diagnosis found = diagnose(test::input_of(test::axis(), test::axis_parameters, {record}),
                                   {.effects = {"lag", "resonance", "offset", "glitches"}});
  ASSERT_EQ(found.effects.size(), 2U) << found.summary;
  EXPECT_EQ(found.effects[0].id, "lag");
  EXPECT_EQ(found.effects[1].id, "glitches");
  EXPECT_NEAR(sum_of(found) + found.split.open, 1.0, 1e-9);
}

TEST(GlitchShare, ASingleSampleOfTheInputIsNone) {
  constexpr std::string_view plant =
      "FUNCTION_BLOCK P (* @ts 5ms *) VAR_INPUT U : LREAL; END_VAR VAR_OUTPUT Y : LREAL; END_VAR VAR G : HY_GAIN := (K "
      ":= 2.0); {} END_VAR G(XIN := U); {} END_FUNCTION_BLOCK";
  std::vector<double> pulsed = test::rich_voltage();
  for (std::size_t k = 100; k < pulsed.size(); k += 170) {
    pulsed[k] += 60.0;
  }
  const std::string machine =
      fmt::format(fmt::runtime(plant), "D : HY_DRIFT := (RATE := 0.4);", "D(XIN := G.XOUT); Y := D.XOUT;");
  const std::string model = fmt::format(fmt::runtime(plant), "", "Y := G.XOUT;");
  records::Record record = test::measured(test::program_of(machine), test::record_of("U", pulsed), 0.05);
  const auto diagnosed = [&] {
    return diagnose(test::input_of(model, "[fit.G]\nK = {}\n", {record}), {.effects = {"drift", "glitches"}});
  };
  const Diagnosis answered = diagnosed();
  ASSERT_EQ(answered.effects.size(), 1U) << answered.summary;
  EXPECT_EQ(answered.effects[0].id, "drift");
  EXPECT_THAT(answered.warnings, Not(Contains(HasSubstr("single samples"))));

  add_glitches(record, 40.0);
  const Diagnosis both = diagnosed();
  ASSERT_EQ(both.effects.size(), 2U) << both.summary;
  EXPECT_THAT(both.warnings, Contains(HasSubstr("6 single samples of Y")));
}

TEST(ImprovedRms, IsThatOfTheDiagramThatIsLeft) {
  const Diagnosis found = diagnose(test::input_of(test::stack(), test::stack_parameters, {drifting_stack(0.08)}),
                                   {.material = 2.0, .effects = {"drift", "offset"}});
  EXPECT_EQ(found.verdict, Verdict::None) << found.summary;
  EXPECT_THAT(found.improved_text, Not(HasSubstr("DRIFT")));
  EXPECT_GT(found.gap.calibrated, 0.1);
  EXPECT_EQ(found.gap.improved, found.gap.calibrated);
  const double floor = found.gap.floor.value * found.gap.floor.value;
  const double left = (std::pow(found.gap.improved, 2) - floor) / (std::pow(found.gap.nominal, 2) - floor);
  EXPECT_LT(found.gap.closed, 1.0 - left + 0.01);
  EXPECT_EQ(found.traces.at(0).improved, found.traces.at(0).calibrated);
  EXPECT_THAT(found.summary, AllOf(HasSubstr("below the size that matters"), Not(HasSubstr("down to its noise"))));
}

/// Two outputs behind one gain.
std::string pair_of(std::string_view first, std::string_view second) {
  return fmt::format(
      "FUNCTION_BLOCK PAIR (* @ts 5ms *) VAR_INPUT U : LREAL; END_VAR VAR_OUTPUT A : LREAL; (* @unit mm *) B : LREAL; "
      "(* @unit mm *) END_VAR VAR G : HY_GAIN := (K := 2.0); END_VAR G(XIN := U); A := {}; B := {}; END_FUNCTION_BLOCK",
      first, second);
}

const Diagnosis& bent_pair() {
  static const Diagnosis found = [] {
    const records::Record record = test::measured(test::program_of(pair_of("1.2 * G.XOUT", "0.1 * G.XOUT")),
                                                  test::record_of("U", test::rich_voltage()), 0.002);
    return diagnose(test::input_of(pair_of("G.XOUT", "0.1 * G.XOUT"), "[fit.G]\nK = {}\n", {record}),
                    {.effects = {"drift"}});
  }();
  return found;
}

TEST(Outputs, ARefitThatMakesOneWorseIsSaid) {
  const Diagnosis& found = bent_pair();
  ASSERT_EQ(found.gaps.size(), 2U);
  ASSERT_GT(found.gaps[1].calibrated, 5.0 * found.gaps[1].nominal);
  const std::string numbers =
      fmt::format("makes B worse, {:.3g} → {:.3g} mm RMS", found.gaps[1].nominal, found.gaps[1].calibrated);
  EXPECT_THAT(found.warnings, Contains(HasSubstr(numbers)));
  EXPECT_THAT(found.warnings, Not(Contains(HasSubstr("makes A worse"))));
}

TEST(Outputs, TracesHaveTheUnitsOfTheDiagram) {
  ASSERT_EQ(bent_pair().traces.size(), 2U);
  EXPECT_EQ(bent_pair().traces[0].unit, "mm");
  EXPECT_EQ(bent_pair().traces[1].unit, "mm");
}

}  // namespace
}  // namespace hysteron::diagnosis
