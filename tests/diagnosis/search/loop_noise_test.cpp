// Noise that a loop carries on: it is found where the controller saw it, and what it smooths is named by its own name.
#include "diagnosis/search/loop_noise.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "diagnosis/model/task.hpp"
#include "tests/diagnosis/simulated_machine.hpp"

namespace hysteron::diagnosis {
namespace {

using testing::AllOf;
using testing::Ge;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

/// A position under a PD controller; `sensor` is what the controller reads, `amplifier` a block more, which reads
/// `amplified`, and `drive` what moves the motor.
std::string loop(const std::string& sensor, const std::string& measured = "POS.XOUT", const std::string& input = "",
                 const std::string& amplifier = "", const std::string& drive = "U",
                 const std::string& amplified = "U") {
  return fmt::format(
      "FUNCTION_BLOCK LOOP  (* @ts 1ms *)\n"
      "  VAR_INPUT REF : LREAL;  (* @unit rad *) {} END_VAR\n"
      "  VAR_OUTPUT Y : LREAL;  (* @unit rad *) U : LREAL; END_VAR\n"
      "  VAR\n    MOTOR : HY_GAIN := (K := 30.0);\n    VEL : HY_INTEGRAL_FORWARD;\n    POS : HY_INTEGRAL;\n"
      "    DAMPING : HY_GAIN := (K := 3.0);\n    KP : HY_GAIN := (K := 40.0);\n    KD : HY_GAIN := (K := 1.5);\n    "
      "SPEED : HY_DERIVATIVE;\n{}  END_VAR\n"
      "  POS(XIN := VEL.XOUT);\n  Y := {};\n  KP(XIN := REF - {});\n  SPEED(XIN := {});\n  KD(XIN := SPEED.XOUT);\n"
      "  U := KP.XOUT - KD.XOUT;\n{}  MOTOR(XIN := {});\n  DAMPING(XIN := VEL.XOUT);\n  VEL(XIN := MOTOR.XOUT - "
      "DAMPING.XOUT);\n"
      "END_FUNCTION_BLOCK\n",
      input, amplifier.empty() ? "" : "    AMP : " + amplifier + ";\n", measured, sensor, sensor,
      amplifier.empty() ? "" : "  AMP(XIN := " + amplified + ");\n", drive);
}

constexpr std::string_view parameters =
    "[parameters.MOTOR]\nK = 30.5\n[fit.MOTOR]\nK = {}\n[tune]\noutputs = [\"Y\", \"U\"]\n";
constexpr double deviation = 4e-3;

std::vector<double> sensor_noise() {
  return test::Noise(11).white(3000, deviation);
}

std::vector<double> reference() {
  std::vector<double> values;
  for (int k = 0; k < 3000; ++k) {
    const double t = 1e-3 * k;
    values.push_back(0.8 * std::sin(test::two_pi * 0.6 * t) + 0.3 * std::sin(test::two_pi * 1.7 * t));
  }
  return values;
}

/// The machine's controller reads the noise, which is in the record's Y as well.
records::Record with_noise_in_the_loop(const std::string& amplifier = "", const std::string& drive = "U") {
  const std::string machine = loop("Y", "POS.XOUT + N", "N : LREAL;", amplifier, drive);
  records::Record driven = test::record_of("REF", reference(), 1e-3);
  driven.add({.name = "N", .values = sensor_noise()});
  records::Record record = test::record_of("REF", reference(), 1e-3);
  auto outputs = simulate(test::program_of(machine), driven);
  test::Noise logger(12);
  for (double& value : outputs[1]) {
    value += 0.5 * logger();
  }
  record.add({.name = "Y", .values = outputs[0]});
  record.add({.name = "U", .values = outputs[1]});
  return record;
}

/// Its logger adds the noise, and its controller never saw it.
records::Record with_noise_of_a_logger() {
  records::Record record = test::measured(test::program_of(loop("Y")), test::record_of("REF", reference(), 1e-3), 0.0);
  return test::changed(record, "Y", [](std::vector<double>& values) {
    const std::vector<double> noise = sensor_noise();
    for (std::size_t k = 0; k < values.size(); ++k) {
      values[k] += noise[k];
    }
  });
}

struct Prepared {
  explicit Prepared(records::Record record) : input(test::input_of(loop("Y"), parameters, {std::move(record)})) {
    task.scales = {deviation, 1.0};
  }
  DiagnosisInput input;
  Task task = task_of(input);
  Variant base{.text = input.text, .program = std::make_shared<const Program>(input.program)};
};

double rms(const std::vector<double>& values) {
  double squares = 0.0;
  for (const double value : values) {
    squares += value * value;
  }
  return std::sqrt(squares / static_cast<double>(values.size()));
}

TEST(NoisyOutput, IsWhatItsReadersWouldGetFromASumInTheText) {
  const Program noisy =
      compile_text(loop("Y"), {.top = "LOOP", .any_order = true, .noisy_outputs = {{.output = "Y", .input = "N"}}});
  const Program written = test::program_of(loop("(Y + N)", "POS.XOUT", "N : LREAL;"));
  records::Record record = test::record_of("REF", reference(), 1e-3);
  record.add({.name = "N", .values = sensor_noise()});
  EXPECT_EQ(simulate(noisy, record), simulate(written, record));
  EXPECT_THAT(compile_text(loop("Y"), {.top = "LOOP", .noisy_outputs = {{.output = "KP", .input = "N"}}}).graph.inputs,
              SizeIs(1))
      << "an instance is no output";
}

TEST(LoopNoise, IsTheNoiseThatTheControllerRead) {
  Prepared prepared(with_noise_in_the_loop());
  const LoopNoise found = with_loop_noise(prepared.task, prepared.base, "LOOP");
  EXPECT_THAT(found.remark, AllOf(HasSubstr("The noise of Y goes around"), HasSubstr(" rad RMS"), HasSubstr("of U,")));
  ASSERT_THAT(found.base.noisy_outputs, SizeIs(1));
  std::vector<double> difference = prepared.task.records[0].column("Y_NOISE").values;
  const std::vector<double> noise = sensor_noise();
  for (std::size_t k = 0; k < noise.size(); ++k) {
    difference[k] -= noise[k];
  }
  // A parabola through 21 samples has a ninth of the noise's energy.
  EXPECT_LT(rms(difference), 0.4 * deviation);

  Explanation one{.variant = found.base};
  EXPECT_THAT(one.variant.program->graph.inputs, SizeIs(2));
  EXPECT_THAT(without_noise(one, "LOOP").variant.program->graph.inputs, SizeIs(1));
}

TEST(LoopNoise, OfALoggerIsNone) {
  Prepared prepared(with_noise_of_a_logger());
  const LoopNoise found = with_loop_noise(prepared.task, prepared.base, "LOOP");
  EXPECT_THAT(found.remark, IsEmpty());
  EXPECT_THAT(found.base.noisy_outputs, IsEmpty());
  EXPECT_EQ(prepared.task.records[0].find("Y_NOISE"), nullptr);
}

TEST(LoopNoise, IsNotWhatASensorRoundsOff) {
  const std::string machine = loop("Y", "AMP.XOUT", "", "HY_QUANTIZER := (QUANTUM := 0.05)", "U", "POS.XOUT");
  Prepared prepared(test::measured(test::program_of(machine), test::record_of("REF", reference(), 1e-3), 0.0));
  EXPECT_THAT(with_loop_noise(prepared.task, prepared.base, "LOOP").remark, IsEmpty());
}

TEST(LoopNoise, IsRenewedWhereTheNoiseWasAnother) {
  Prepared prepared(with_noise_in_the_loop());
  const LoopNoise found = with_loop_noise(prepared.task, prepared.base, "LOOP");
  const auto residuals = [&] {
    Model model(prepared.task, *found.base.program);
    Explanation best{.variant = found.base};
    best.fit.x = model.start();
    EXPECT_TRUE(model.residuals(best.fit.x, best.fit.residuals));
    return best;
  };
  const Explanation as_found = residuals();
  EXPECT_FALSE(renew_loop_noise(prepared.task, as_found)) << "it is the same one";
  const std::vector<double> noise = prepared.task.records[0].column("Y_NOISE").values;
  std::vector<double> another = test::Noise(5).white(noise.size(), 5.0 * deviation);
  prepared.task.records[0].replace("Y_NOISE", another);
  const Explanation misled = residuals();
  EXPECT_TRUE(renew_loop_noise(prepared.task, misled));
  EXPECT_LT(residuals().fit.residuals.squaredNorm(), 0.7 * misled.fit.residuals.squaredNorm());
}

TEST(LoopNoise, DoesNotHideTheDeadZoneThatItSmooths) {
  // The noise moves the command about as far as the dead band is wide.
  const DiagnosisInput input =
      test::input_of(loop("Y"), parameters, {with_noise_in_the_loop("HY_DEAD_BAND := (WIDTH := 12.0)", "AMP.XOUT")});
  const Diagnosis found = diagnose(input, {.effects = {"dead_zone", "odd_nonlinearity", "lag", "saturation"}});
  ASSERT_THAT(found.effects, SizeIs(Ge(1)));
  EXPECT_EQ(found.effects[0].id, "dead_zone");
  EXPECT_LT(found.gap.improved, 1.2 * deviation);
  EXPECT_EQ(found.improved_text.find("NOISE"), std::string::npos);
  EXPECT_THAT(found.warnings, testing::Contains(HasSubstr("goes around in the loop")));
}

}  // namespace
}  // namespace hysteron::diagnosis
