// Records that begin in another state than the model: the start is found out, and no effect stands for it.
#include "diagnosis/verdict/start_state.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <string>
#include <vector>

#include "diagnosis/model/task.hpp"
#include "tests/diagnosis/simulated_machine.hpp"

namespace hysteron::diagnosis {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

/// A body that is heated: power, gain, lag. `sensor` follows the body, as ":= (T1 := 0.02)" of a lag.
std::string heater(std::string_view sensor = {}, std::string_view effect = {}) {
  return fmt::format(
      "FUNCTION_BLOCK HEATER (* @ts 5ms *) VAR_INPUT P : LREAL; (* @unit W *) END_VAR "
      "VAR_OUTPUT TEMP : LREAL; (* @unit degC *) END_VAR "
      "VAR G : HY_GAIN := (K := 0.5); L : HY_LAG := (T1 := 0.4); {}{} END_VAR "
      "G(XIN := P); L(XIN := G.XOUT); {}{} TEMP := {}; END_FUNCTION_BLOCK",
      sensor.empty() ? std::string() : fmt::format("SENSOR : HY_LAG {};", sensor),
      effect.empty() ? std::string() : fmt::format("E : {};", effect), sensor.empty() ? "" : "SENSOR(XIN := L.XOUT);",
      effect.empty() ? "" : "E(XIN := L.XOUT);",
      !effect.empty()  ? "E.XOUT"
      : sensor.empty() ? "L.XOUT"
                       : "SENSOR.XOUT");
}

constexpr std::string_view heater_parameters =
    "[parameters.G]\nK = 0.5\n[parameters.L]\nT1 = 0.4\n[fit.G]\nK = {}\n[fit.L]\nT1 = {}\n";

/// Steps of power, with dwells.
std::vector<double> power(std::size_t count = 2400) {
  std::vector<double> values;
  for (std::size_t k = 0; k < count; ++k) {
    static const std::vector<double> levels{0.0, 60.0, 20.0, 90.0, 40.0, 0.0, 75.0, 10.0};
    values.push_back(levels[(k / 300) % levels.size()]);
  }
  return values;
}

/// What is left of a record behind its first rows.
records::Record cut(const records::Record& whole, std::size_t first) {
  records::Record result = records::Record::even(0.0, whole.sample_time(), whole.size() - first);
  for (const records::Column& column : whole.columns()) {
    result.add({.name = column.name,
                .values = {column.values.begin() + static_cast<std::ptrdiff_t>(first), column.values.end()}});
  }
  return result;
}

records::Record record_of_heater(const std::string& text) {
  return test::measured(test::program_of(text), test::record_of("P", power()), 0.05);
}

std::vector<std::string> effects_of(const Diagnosis& found) {
  std::vector<std::string> names;
  for (const EffectFinding& effect : found.effects) {
    names.push_back(effect.id);
  }
  return names;
}

const DiagnosisOptions few{
    .effects = {"thermal_drift", "drift", "offset", "creep", "lag", "delay", "viscous_friction", "saturation"}};

TEST(StartState, ARecordFromMidMotionHasNoEffectForItsStart) {
  const auto record = cut(record_of_heater(heater()), 340);  // the body is far from where the power would keep it
  const Diagnosis found = diagnose(test::input_of(heater(), heater_parameters, {record}), few);
  EXPECT_THAT(effects_of(found), IsEmpty()) << found.summary;
  EXPECT_THAT(found.warnings, Contains(HasSubstr("L.RATE1")));
  EXPECT_NEAR(found.gap.calibrated, 0.05, 0.005);
}

TEST(StartState, BesideItTheEffectIsNamed) {
  const auto record = cut(record_of_heater(heater(":= (T1 := 0.06)")), 340);
  const Diagnosis found = diagnose(test::input_of(heater(), heater_parameters, {record}), few);
  EXPECT_THAT(effects_of(found), ElementsAre("lag")) << found.summary;
  EXPECT_THAT(found.warnings, Contains(HasSubstr("L.RATE1")));
}

TEST(StartState, TheImprovedFileCarriesIt) {
  const auto record = cut(record_of_heater(heater()), 340);
  const Diagnosis found = diagnose(test::input_of(heater(), heater_parameters, {record}), few);
  ASSERT_FALSE(found.improved_file.initial.empty());
  EXPECT_EQ(found.improved_file.initial.front().path, "L.RATE1");
  ASSERT_FALSE(found.improved_file.tune.initial_states.empty());
  EXPECT_EQ(found.improved_file.tune.initial_states.front().text, "L.RATE1");
  // A second diagnosis begins where this one ended.
  const Diagnosis again = diagnose({.program = compile_text(found.improved_text),
                                    .text = found.improved_text,
                                    .file = found.improved_file,
                                    .records = {record}},
                                   few);
  EXPECT_EQ(again.verdict, Verdict::None) << again.summary;
  EXPECT_NEAR(again.gap.nominal, 0.05, 0.005);
}

TEST(StartState, SlowEffectsKeepTheirNames) {
  for (const auto& [id, block] : std::vector<std::pair<std::string, std::string>>{
           {"offset", "HY_OFFSET := (BIAS := 1.0)"},
           {"drift", "HY_DRIFT := (RATE := 0.2)"},
           {"thermal_drift", "HY_THERMAL_DRIFT := (SIZE := 2.0, T1 := 4.0)"}}) {
    SCOPED_TRACE(id);
    const Diagnosis found =
        diagnose(test::input_of(heater(), heater_parameters, {record_of_heater(heater({}, block))}), few);
    EXPECT_THAT(effects_of(found), ElementsAre(id)) << found.summary;
    EXPECT_THAT(found.warnings, Not(Contains(HasSubstr("another state")))) << found.summary;
  }
}

TEST(StartState, AnIntegralsStartIsAnOffset) {
  for (const auto& [id, block] : std::vector<std::pair<std::string, std::string>>{
           {"offset", "HY_OFFSET := (BIAS := 0.05)"}, {"drift", "HY_DRIFT := (RATE := 0.01)"}}) {
    SCOPED_TRACE(id);
    const auto machine = test::program_of(test::axis({.block = block, .edge = "SPEED.XOUT"}));
    const auto record = test::measured(machine, test::record_of("FORCE", test::rich_force(1000)), 0.002);
    const Diagnosis found = diagnose(test::input_of(test::axis(), test::axis_parameters, {record}),
                                     {.effects = {"offset", "drift", "lag", "delay"}});
    EXPECT_THAT(effects_of(found), ElementsAre(id)) << found.summary;
    EXPECT_THAT(found.warnings, Not(Contains(HasSubstr("another state")))) << found.summary;
  }
}

TEST(StartState, AStartThatNothingExplainsIsTold) {
  // The effects that could stand for it are not tried, and no block has a state.
  const std::string gain =
      "FUNCTION_BLOCK BARE (* @ts 5ms *) VAR_INPUT P : LREAL; END_VAR VAR_OUTPUT TEMP : LREAL; END_VAR "
      "VAR G : HY_GAIN := (K := 0.5); END_VAR G(XIN := P); TEMP := G.XOUT; END_FUNCTION_BLOCK";
  const auto record = test::changed(record_of_heater(gain), "TEMP", [](auto& y) {
    for (std::size_t k = 0; k < 200; ++k) {
      y[k] += 20.0 * std::exp(-0.03 * static_cast<double>(k));
    }
  });
  const Diagnosis found = diagnose(test::input_of(gain, "[parameters.G]\nK = 0.5\n", {record}), {.effects = {"delay"}});
  EXPECT_THAT(found.warnings, Contains(HasSubstr("no state of a block"))) << found.summary;
  EXPECT_LE(found.confidence, 0.5);
}

TEST(StartState, OnlyStatesThatDecayAreVisible) {
  const auto visible = [](const std::string& text, std::string_view parameters, const records::Record& record) {
    const Task task = [&] {
      Task one = task_of(test::input_of(text, parameters, {record}));
      one.scales = {1.0};
      return one;
    }();
    Explanation calibrated{.variant = {.text = text, .program = std::make_shared<Program>(compile_text(text))}};
    Model model(task, *calibrated.variant.program);
    calibrated.fit.x = model.start();
    return visible_states(task, calibrated);
  };
  EXPECT_THAT(visible(heater(), heater_parameters, record_of_heater(heater())), ElementsAre("L.RATE1"));
  EXPECT_THAT(visible(heater(":= (T1 := 0.06)"), heater_parameters, record_of_heater(heater(":= (T1 := 0.06)"))),
              ElementsAre("L.RATE1", "SENSOR.RATE1"));
  const auto axis =
      test::measured(test::program_of(test::axis()), test::record_of("FORCE", test::rich_force(1000)), 0.002);
  EXPECT_THAT(visible(test::axis(), test::axis_parameters, axis), IsEmpty());
}

}  // namespace
}  // namespace hysteron::diagnosis
