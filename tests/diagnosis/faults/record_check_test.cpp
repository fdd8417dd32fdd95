// Bad records: refused or warned with the reason, and never given a confident name.
#include "diagnosis/faults/record_check.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "tests/diagnosis/simulated_machine.hpp"

namespace hysteron::diagnosis {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

records::Record stack_record(std::size_t count = 1000) {
  auto voltage = test::rich_voltage(2000);
  voltage.resize(count);
  return test::measured(test::program_of(test::stack()), test::record_of("U", voltage), 0.05);
}

records::Record axis_record() {
  return test::measured(test::program_of(test::axis()), test::record_of("FORCE", test::rich_force(1000)), 0.002);
}

Diagnosis of_stack(const records::Record& record) {
  return diagnose(test::input_of(test::stack(), test::stack_parameters, {record}), {.effects = {"offset"}});
}

Diagnosis of_axis(const records::Record& record) {
  return diagnose(test::input_of(test::axis(), test::axis_parameters, {record}), {.effects = {"offset"}});
}

void expect_refused(const Diagnosis& found, const char* reason) {
  EXPECT_THAT(found.refusals, Contains(HasSubstr(reason)));
  EXPECT_THAT(found.effects, IsEmpty());
  EXPECT_THAT(found.rivals, IsEmpty());
  EXPECT_EQ(found.verdict, Verdict::Unknown);
  EXPECT_EQ(found.confidence, 0.0);
  EXPECT_THAT(found.summary, HasSubstr("No diagnosis"));
  EXPECT_THAT(found.improved_text, IsEmpty());
}

TEST(RecordCheck, AGoodRecordPasses) {
  EXPECT_THAT(of_stack(stack_record()).refusals, IsEmpty());
  const Diagnosis found = of_axis(axis_record());
  EXPECT_THAT(found.refusals, IsEmpty());
  EXPECT_EQ(found.verdict, Verdict::None);
}

TEST(RecordCheck, TooShort) {
  expect_refused(of_stack(stack_record(99)), "99 samples");
  expect_refused(of_stack(stack_record(20)), "20 samples");
  expect_refused(of_stack(stack_record(2)), "2 samples");
}

TEST(RecordCheck, OneSample) {
  expect_refused(of_stack(stack_record(1)), "1 samples");
}

TEST(RecordCheck, SeveralShortRecordsAddUp) {
  EXPECT_THAT(diagnose(test::input_of(test::stack(), test::stack_parameters, {stack_record(300), stack_record(300)}),
                       {.effects = {"offset"}})
                  .refusals,
              IsEmpty());
}

TEST(RecordCheck, ConstantInput) {
  expect_refused(of_stack(test::measured(test::program_of(test::stack()),
                                         test::record_of("U", std::vector<double>(1000, 1.5)), 0.05)),
                 "No input moves");
}

TEST(RecordCheck, StuckSensor) {
  expect_refused(of_stack(test::changed(stack_record(), "Y", [](auto& y) { std::ranges::fill(y, 3.0); })),
                 "never changes");
}

TEST(RecordCheck, ClippedSensor) {
  const auto clip = [](std::vector<double>& y) {
    for (double& v : y) {
      v = std::min(v, 25.0);
    }
  };
  const Diagnosis found = of_stack(test::changed(stack_record(), "Y", clip));
  EXPECT_THAT(found.warnings, Contains(HasSubstr("clipped")));
  EXPECT_LT(found.confidence, 0.9);  // an offset explains no clipping
}

TEST(RecordCheck, MirroredSign) {
  expect_refused(of_stack(test::changed(stack_record(), "Y",
                                        [](auto& y) {
                                          for (double& v : y) {
                                            v = -v;
                                          }
                                        })),
                 "mirrored");
  expect_refused(of_axis(test::changed(axis_record(), "FORCE",
                                       [](auto& f) {
                                         for (double& v : f) {
                                           v = -v;
                                         }
                                       })),
                 "mirrored");
}

TEST(RecordCheck, UnitsAPowerOfTenApart) {
  for (const double factor : {1e-6, 1e-3, 1e-2, 1e3, 1e6}) {
    SCOPED_TRACE(factor);
    const auto scale = [&](std::vector<double>& values) {
      for (double& v : values) {
        v *= factor;
      }
    };
    const Diagnosis output = of_stack(test::changed(stack_record(), "Y", scale));
    expect_refused(output, "units");
    EXPECT_THAT(output.refusals, Contains(HasSubstr("um")));
    expect_refused(of_axis(test::changed(axis_record(), "FORCE", scale)), "units");
  }
}

TEST(RecordCheck, AMillivoltRecordOfAHystereticStackGetsNoName) {
  const auto millivolts = [](std::vector<double>& u) {
    for (double& v : u) {
      v *= 1e3;
    }
  };
  const Diagnosis found = of_stack(test::changed(stack_record(), "U", millivolts));
  EXPECT_FALSE(found.refusals.empty()) << found.summary;
}

TEST(RecordCheck, ColumnsSwapped) {
  const records::Record good = stack_record();
  records::Record swapped = test::record_of("U", good.column("Y").values);
  swapped.add({.name = "Y", .values = good.column("U").values});
  expect_refused(of_stack(swapped), "exchanged");
}

TEST(RecordCheck, AnAbsurdSampleIsNamed) {
  for (const char* column : {"U", "Y"}) {
    for (const double value : {1e300, -1e15}) {
      const Diagnosis found = of_stack(test::changed(stack_record(), column, [&](auto& v) { v[500] = value; }));
      expect_refused(found, "slip of the logger");
      ASSERT_EQ(found.refusals.size(), 1U);
      EXPECT_THAT(found.refusals.front(), AllOf(HasSubstr(std::string(column) + " is "), HasSubstr("at t = 2.5 s"),
                                                HasSubstr("sample 501"), HasSubstr("Take it out")));
    }
  }
  const auto scaled = [](double factor) {
    return of_stack(test::changed(stack_record(), "Y", [&](auto& y) {
      for (double& v : y) {
        v *= factor;
      }
    }));
  };
  expect_refused(scaled(1e200), "no sensor gives such a value");
  expect_refused(scaled(1e20), "the units of record and diagram differ");
}

TEST(RecordCheck, AGlitchSaysNothingOfTheRest) {
  const Diagnosis found = of_stack(test::changed(stack_record(), "Y", [](auto& y) { y[500] = 1e6; }));
  EXPECT_THAT(found.refusals, IsEmpty());
  EXPECT_THAT(found.warnings, Contains(HasSubstr("single samples of Y")));
  EXPECT_THAT(found.warnings, Not(Contains(HasSubstr("little in common"))));
}

TEST(RecordCheck, AModelThatDoesNotMove) {
  // The reset stands: all inputs of the record move, and the model does not.
  const std::string held =
      "FUNCTION_BLOCK HELD (* @ts 5ms *) VAR_INPUT U : LREAL; END_VAR VAR_OUTPUT Y : LREAL; END_VAR VAR G : "
      "HY_GAIN; S : HY_INTEGRAL; END_VAR G(XIN := U); S(XIN := G.XOUT, RUN := FALSE); Y := S.XOUT; END_FUNCTION_BLOCK";
  records::Record record = test::record_of("U", test::rich_voltage(1000));
  record.add({.name = "Y", .values = test::rich_voltage(1000)});
  const Diagnosis found = diagnose(test::input_of(held, "", {record}), {.effects = {"offset"}});
  expect_refused(found, "does not move");
}

TEST(RecordCheck, AnotherStartIsFoundOut) {
  const std::string body =
      "FUNCTION_BLOCK BODY (* @ts 5ms *) VAR_INPUT U : LREAL; END_VAR VAR_OUTPUT Y : LREAL; (* @unit K *) END_VAR VAR "
      "L : HY_LAG := (T1 := 0.05{}); END_VAR L(XIN := U, X0 := 30.0); Y := L.XOUT; END_FUNCTION_BLOCK";
  const auto text = [&](const char* settled) {
    std::string result = body;
    return result.replace(result.find("{}"), 2, settled);
  };
  const records::Record record = test::measured(test::program_of(text(", SETTLED := FALSE")),
                                                test::record_of("U", test::rich_voltage(1000)), 0.01);
  const Diagnosis found =
      diagnose(test::input_of(text(""), "[parameters.L]\nT1 = 0.05\n", {record}), {.effects = {"offset"}});
  EXPECT_THAT(found.warnings, Contains(AllOf(HasSubstr("another state"), HasSubstr("L.RATE1"))));
  EXPECT_THAT(found.effects, IsEmpty()) << found.summary;
}

TEST(RecordCheck, WithoutRepeatsAndDwellsTheFloorIsInDoubt) {
  std::vector<double> chirp;
  for (int k = 0; k < 1000; ++k) {
    const double t = 0.005 * k;
    chirp.push_back(2.0 + 2.0 * std::sin(t + 0.6 * t * t));
  }
  const Diagnosis found = of_stack(test::measured(test::program_of(test::stack()), test::record_of("U", chirp), 0.05));
  EXPECT_THAT(found.warnings, Contains(HasSubstr("no input repeats or dwells")));
  EXPECT_EQ(found.gap.floor.evidence, "differences");
}

TEST(RecordCheck, ASensorThatSticksForAWhileIsLeftOut) {
  const auto stuck = [](std::size_t first, std::size_t last) {
    return of_stack(test::changed(stack_record(), "Y", [&](auto& y) {
      std::fill(y.begin() + static_cast<std::ptrdiff_t>(first), y.begin() + static_cast<std::ptrdiff_t>(last),
                y[first]);
    }));
  };
  const Diagnosis a_while = stuck(750, 850);
  EXPECT_THAT(a_while.warnings, Contains(AllOf(HasSubstr("stuck"), HasSubstr("from 3.75 to 4.245 s"))));
  EXPECT_THAT(a_while.effects, IsEmpty());
  EXPECT_EQ(a_while.verdict, Verdict::None) << a_while.summary;
  expect_refused(stuck(600, 1000), "stuck");
}

TEST(RecordCheck, DropoutsAreLeftOut) {
  const Diagnosis found =
      of_stack(test::changed(stack_record(), "Y", [](auto& y) { std::fill(y.begin() + 400, y.begin() + 430, -40.0); }));
  EXPECT_THAT(found.warnings, Contains(AllOf(HasSubstr("drop out"), HasSubstr("from 2 to 2.145 s"))));
  EXPECT_EQ(found.verdict, Verdict::None) << found.summary;
}

TEST(RecordCheck, APieceThatIsMissingIsWarnedOf) {
  const records::Record whole = stack_record(2000);
  records::Record record = records::Record::even(0.0, whole.sample_time(), 1300);
  for (records::Column column : whole.columns()) {
    column.values.erase(column.values.begin() + 400, column.values.begin() + 1100);
    record.add(std::move(column));
  }
  EXPECT_THAT(of_stack(record).warnings, Contains(AllOf(HasSubstr("leaps"), HasSubstr("at 2 s"))));
}

/// A body with a lag, 20 degC where nothing heats it.
Diagnosis of_body(double gain, double offset) {
  const std::string body =
      "FUNCTION_BLOCK BODY (* @ts 5ms *) VAR_INPUT U : LREAL; AMB : LREAL := 20.0; (* @param @unit degC *) END_VAR "
      "VAR_OUTPUT Y : LREAL; (* @unit degC *) END_VAR VAR G : HY_GAIN := (K := 15.0); L : HY_LAG := (T1 := 0.05); "
      "END_VAR G(XIN := U); L(XIN := G.XOUT); Y := L.XOUT + AMB; END_FUNCTION_BLOCK";
  const auto record = test::measured(test::program_of(body), test::record_of("U", test::rich_voltage(1000)), 0.05);
  const auto converted = test::changed(record, "Y", [&](auto& y) {
    for (double& v : y) {
      v = gain * v + offset;
    }
  });
  return diagnose(test::input_of(body, "[parameters.L]\nT1 = 0.05\n[fit]\nAMB = {}\n[fit.L]\nT1 = {}\n", {converted}),
                  {.effects = {"offset"}});
}

TEST(RecordCheck, TemperaturesInAnotherUnit) {
  expect_refused(of_body(1.0, 273.15), "taken to be in K");
  expect_refused(of_body(1.8, 32.0), "Fahrenheit");
  EXPECT_THAT(of_body(1.0, 0.0).refusals, IsEmpty());
  EXPECT_THAT(of_body(1.0, 5.0).refusals, IsEmpty());
}

TEST(RecordCheck, AParameterThatRunsFarOffIsWarnedOf) {
  EXPECT_THAT(of_body(1.0, 60.0).warnings, Contains(AllOf(HasSubstr("AMB goes from 20"), HasSubstr("in the refit"))));
  EXPECT_THAT(of_body(1.0, 5.0).warnings, Not(Contains(HasSubstr("in the refit"))));
}

TEST(RecordCheck, RowsInDisorderAreUnknown) {
  const Diagnosis found = of_stack(test::changed(stack_record(), "Y", [](auto& y) {
    test::Noise random(5);
    for (std::size_t k = y.size() - 1; k > 0; --k) {
      std::swap(y[k], y[static_cast<std::size_t>(random.uniform() * static_cast<double>(k + 1))]);
    }
  }));
  EXPECT_EQ(found.verdict, Verdict::Unknown) << found.summary;
  EXPECT_EQ(found.unknown_score, 1.0);
  EXPECT_THAT(found.warnings, Contains(HasSubstr("rows in order")));
}

TEST(RecordCheck, ARecordOfAnotherMachineGetsNoName) {
  records::Record record = test::record_of("U", test::rich_voltage(1000));
  record.add({.name = "Y", .values = test::Noise(8).white(1000, 10.0)});
  const Diagnosis found = of_stack(record);
  EXPECT_THAT(found.warnings, Contains(HasSubstr("little in common")));
  EXPECT_THAT(found.effects, IsEmpty()) << found.summary;
}

/// A table on a stiff guide: its model is its gain at rest, and it rings at every step of a wide-band command.
records::Record ringing_table(std::uint64_t commands) {
  constexpr std::string_view machine =
      "FUNCTION_BLOCK TABLE  (* @ts 1ms *)\n  VAR_INPUT U : LREAL; END_VAR\n  VAR_OUTPUT Y : LREAL; END_VAR\n"
      "  VAR\n    MODE : HY_SECOND_ORDER := (T := 0.0006, ZETA := 0.01);\n  END_VAR\n"
      "  MODE(XIN := U);\n  Y := MODE.XOUT;\nEND_FUNCTION_BLOCK\n";
  return test::measured(test::program_of(std::string(machine)),
                        test::record_of("U", test::Noise(commands).white(2000, 1.0), 0.001), 1.0);
}

Diagnosis of_table(const records::Record& record) {
  return diagnose(test::input_of("FUNCTION_BLOCK TABLE  (* @ts 1ms *)\n  VAR_INPUT U : LREAL; END_VAR\n"
                                 "  VAR_OUTPUT Y : LREAL; END_VAR\n  VAR\n    GUIDE : HY_GAIN := (K := 1.0);\n"
                                 "  END_VAR\n  GUIDE(XIN := U);\n  Y := GUIDE.XOUT;\nEND_FUNCTION_BLOCK\n",
                                 "[fit.GUIDE]\nK = {}\n", {record}),
                  {});
}

TEST(RecordCheck, AnEffectMayBeAllThatTheRecordShows) {
  const Diagnosis found = of_table(ringing_table(3));
  EXPECT_THAT(found.warnings, Contains(HasSubstr("little in common")));
  ASSERT_FALSE(found.effects.empty()) << found.summary;
  EXPECT_EQ(found.effects.front().id, "resonance") << found.summary;
}

TEST(RecordCheck, NoEffectIsNamedForTheCommandsOfAnotherRun) {
  const Diagnosis found =
      of_table(test::changed(ringing_table(3), "U", [](auto& u) { u = test::Noise(4).white(u.size(), 1.0); }));
  EXPECT_THAT(found.effects, IsEmpty()) << found.summary;
  EXPECT_EQ(found.unknown_score, 1.0);
}

std::vector<double> sine(double amplitude, std::size_t period, std::size_t count) {
  std::vector<double> values;
  for (std::size_t k = 0; k < count; ++k) {
    values.push_back(amplitude *
                     std::sin(2.0 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(period)));
  }
  return values;
}

/// Whether the diagnosis remarks that the inputs make one motion only.
bool one_motion(const std::vector<double>& voltage) {
  const auto record = test::measured(test::program_of(test::stack()), test::record_of("U", voltage), 0.05);
  const Diagnosis found = of_stack(record);
  const auto said = Contains(HasSubstr("one motion only"));
  if (testing::Matches(said)(found.cannot_tell)) {
    EXPECT_LE(found.confidence, 0.8);
    return true;
  }
  return false;
}

TEST(RecordCheck, OneSineOrOneStepIsRemarked) {
  EXPECT_TRUE(one_motion(sine(3.0, 150, 1000)));
  std::vector<double> step(1000, 0.0);
  std::fill(step.begin() + 100, step.end(), 2.0);
  EXPECT_TRUE(one_motion(step));
}

TEST(RecordCheck, TwoAmplitudesOrTwoRatesAreMoreThanOneMotion) {
  std::vector<double> amplitudes = sine(3.0, 150, 600);
  const std::vector<double> smaller = sine(1.5, 150, 600);
  amplitudes.insert(amplitudes.end(), smaller.begin(), smaller.end());
  EXPECT_FALSE(one_motion(amplitudes));
  std::vector<double> rates = sine(3.0, 150, 600);
  const std::vector<double> faster = sine(3.0, 60, 600);
  rates.insert(rates.end(), faster.begin(), faster.end());
  EXPECT_FALSE(one_motion(rates));
  EXPECT_FALSE(one_motion(test::rich_voltage(1000)));
}

TEST(RecordCheck, AMissingColumnIsAnError) {
  const records::Record record = test::record_of("U", test::rich_voltage(1000));
  EXPECT_THROW((void)of_stack(record), InputError);
}

}  // namespace
}  // namespace hysteron::diagnosis
