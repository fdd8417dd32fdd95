// The diagnosis on measured records that may not be shipped: an oscillator with a cubic spring, two tanks that
// overflow, a mirror on three stacks. Each is cut so that it takes seconds. Where there is no folder of measured data
// they are skipped; where there is one, a missing record is a failure.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <span>
#include <string>
#include <vector>

#include "codegen/compile.hpp"
#include "codegen/parameters/parameter_file.hpp"
#include "diagnosis/diagnose.hpp"
#include "records/data_folder.hpp"
#include "records/read.hpp"
#include "tests/support/measured_records.hpp"
#include "tuning/output_error.hpp"

namespace hysteron::diagnosis {
namespace {

using testing::AnyOf;
using testing::Contains;
using testing::Eq;
using testing::HasSubstr;

/// Names that would call a memory what is none.
const std::vector<std::string> hysteretic{"backlash", "coulomb_friction", "stribeck_friction", "creep"};

class RealRecords : public test::OnMeasuredRecords<> {
 protected:
  static records::Record record(const std::string& file, std::size_t first, std::size_t rows) {
    const auto path = records::find_record(file, HYSTERON_SOURCE_DIR);
    EXPECT_TRUE(path) << "the data folder lacks " << file;
    return records::read_record(path.value().string()).slice({.first = first, .last = first + rows});
  }

  /// Tunes what the settings mark, then diagnoses.
  static Diagnosis tuned_and_diagnosed(const std::string& text, const std::string& settings,
                                       const records::Record& measured, const DiagnosisOptions& options) {
    const Program program = compile_text(text);
    const auto file = parameters::parse_parameter_file("settings.toml", settings);
    const OutputErrorProblem problem = output_error_problem(program, file, std::span(&measured, 1));
    const Diagnosis found = diagnose({.program = program,
                                      .text = text,
                                      .file = tuned_file(file, problem, fit_output_error(problem)),
                                      .records = {measured}},
                                     options);
    std::printf("%s\n", found.summary.c_str());  // docs/diagnosis.md shows it
    return found;
  }

  static void expect_no_hysteresis(const Diagnosis& found) {
    for (const EffectFinding& effect : found.effects) {
      EXPECT_THAT(hysteretic, testing::Not(Contains(effect.id))) << found.summary;
    }
  }
};

// Mass, damper and spring as a difference equation: the position is the one behind the speed's integral, so that the
// force of the spring stands on an edge of its own.
constexpr const char* oscillator = R"(
FUNCTION_BLOCK OSCILLATOR  (* @ts 1638.4us *)
  VAR_INPUT
    U    : LREAL;         (* @unit V *)
    ZERO : LREAL := 0.0;  (* @param @unit V *)
  END_VAR
  VAR_OUTPUT
    Y : LREAL;  (* @unit V *)
  END_VAR
  VAR
    DRIVE    : HY_GAIN := (K := 175000.0);
    DAMPER   : HY_GAIN := (K := 350.0);
    SPRING   : HY_GAIN := (K := 175000.0);
    SPEED    : HY_INTEGRAL_FORWARD;
    POSITION : HY_INTEGRAL;
  END_VAR

  DAMPER(XIN := SPEED.XOUT);
  DRIVE(XIN := U + ZERO);
  POSITION(XIN := SPEED.XOUT);
  SPRING(XIN := POSITION.XOUT);
  SPEED(XIN := DRIVE.XOUT - DAMPER.XOUT - SPRING.XOUT);
  Y := POSITION.XOUT;
END_FUNCTION_BLOCK
)";

TEST_F(RealRecords, SilverboxHasACubicSpring) {
  // From a gap between two multisines, where it rests.
  const Diagnosis found = tuned_and_diagnosed(oscillator, R"(
[fit]
ZERO = {scale = 0.01}
[fit.DRIVE]
K = {}
[fit.DAMPER]
K = {}
[fit.SPRING]
K = {}
)",
                                              record("silverbox/snls80mv.csv", 49238, 2000), {.most_effects = 1});
  ASSERT_FALSE(found.effects.empty()) << found.summary;
  EXPECT_EQ(found.effects.front().id, "odd_nonlinearity") << found.summary;
  EXPECT_THAT(found.effects.front().edge, AnyOf(Eq("SPRING.XIN"), Eq("SPRING.XOUT")));
  EXPECT_GT(found.effects.front().parameters.front().value, 0.0) << "it hardens";
  EXPECT_LT(found.gap.improved, 0.25 * found.gap.calibrated);
  expect_no_hysteresis(found);
}

constexpr const char* tanks = R"(
FUNCTION_BLOCK TANKS  (* @ts 4s *)
  VAR_INPUT
    U      : LREAL;
    FIRST1 : LREAL := 5.0;  (* @param @min 0 *)
    FIRST2 : LREAL := 5.2;  (* @param @min 0 *)
  END_VAR
  VAR_OUTPUT
    Y : LREAL;
  END_VAR
  VAR
    PUMP  : HY_GAIN := (K := 0.05);
    HOLE1 : HY_GAIN := (K := 0.05);
    HOLE2 : HY_GAIN := (K := 0.05);
    UPPER : HY_INTEGRAL_FORWARD;
    LOWER : HY_INTEGRAL_FORWARD;
  END_VAR

  PUMP(XIN := U);
  HOLE1(XIN := SQRT(MAX(0.0001, UPPER.XOUT + FIRST1)));
  HOLE2(XIN := SQRT(MAX(0.0001, LOWER.XOUT + FIRST2)));
  Y := LOWER.XOUT + FIRST2;
  UPPER(XIN := PUMP.XOUT - HOLE1.XOUT);
  LOWER(XIN := HOLE1.XOUT - HOLE2.XOUT);
END_FUNCTION_BLOCK
)";

// Of all effects tried alone, an upper tank that runs over closes the most, and yet only a ninth of the gap: the laws
// of the holes matter more, and none of the effects is one. So the stop is seen in the record, and nothing is named
// with confidence.
TEST_F(RealRecords, TanksOverflowIsSeenAsAStop) {
  const Diagnosis found = tuned_and_diagnosed(
      tanks, R"(
[fit]
FIRST1 = {}
FIRST2 = {}
[fit.PUMP]
K = {}
[fit.HOLE1]
K = {}
[fit.HOLE2]
K = {}
)",
      record("cascaded-tanks/tanks_est.csv", 0, 1024),
      {.effects = {"backlash", "coulomb_friction", "delay", "drift", "lag", "odd_nonlinearity", "saturation"},
       .most_effects = 1});
  EXPECT_THAT(found.warnings, Contains(HasSubstr("a clipped sensor, or a stop")));
  EXPECT_TRUE(found.confidence < 0.9 || found.effects.empty() || found.effects.front().id == "saturation")
      << found.summary;
  expect_no_hysteresis(found);
}

constexpr const char* mirror = R"(
FUNCTION_BLOCK MIRROR  (* @ts 156.25us *)
  VAR_INPUT
    U1 : LREAL;  (* @unit V *)
    U2 : LREAL;  (* @unit V *)
    U3 : LREAL;  (* @unit V *)
  END_VAR
  VAR_OUTPUT
    Y1 : LREAL;  (* @unit um *)
  END_VAR
  VAR
    STACK1 : HY_GAIN := (K := -2.71);
    STACK2 : HY_GAIN := (K := 0.42);
    STACK3 : HY_GAIN := (K := -3.29);
  END_VAR

  STACK1(XIN := U1);
  STACK2(XIN := U2);
  STACK3(XIN := U3);
  Y1 := STACK1.XOUT + STACK2.XOUT + STACK3.XOUT;
END_FUNCTION_BLOCK
)";

// The gains are those at rest, from the record behind a low-pass; all else is dynamics with many modes. The mode that
// stands out is softer at three times the voltage: its authors' amplitude dependence.
TEST_F(RealRecords, MirrorResonatesAndSoftens) {
  const auto mode = [](const char* file) {
    const records::Record measured = record(file, 0, 2048);
    const Diagnosis found =
        diagnose({.program = compile_text(mirror), .text = mirror, .records = {measured}}, {.most_effects = 1});
    std::printf("%s\n", found.summary.c_str());  // docs/diagnosis.md shows it
    EXPECT_LT(found.gap.improved, 0.9 * found.gap.calibrated);
    expect_no_hysteresis(found);
    if (found.effects.empty() || found.effects.front().id != "resonance") {
      ADD_FAILURE() << found.summary;
      return ParameterFinding{};
    }
    return *std::ranges::find(found.effects.front().parameters, "T", &ParameterFinding::name);
  };
  const ParameterFinding small = mode("piezo-fsm-cubespec/train_100mV_r1.csv");
  const ParameterFinding large = mode("piezo-fsm-cubespec/train_300mV_r1.csv");
  EXPECT_LT(small.high, large.low) << "1/ω in s";
}

}  // namespace
}  // namespace hysteron::diagnosis
