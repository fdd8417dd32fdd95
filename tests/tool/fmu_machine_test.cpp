// A machine with an FMU among its blocks, in this process: equal bits, derivatives, resets.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "codegen/cosimulation/fmu.hpp"
#include "codegen/cosimulation/session.hpp"
#include "codegen/interpreter/machine.hpp"
#include "tests/codegen/backends/recorded_run.hpp"
#include "tests/codegen/random_program.hpp"
#include "tests/tool/motor_bench.hpp"
#include "tool/fmu.hpp"
#include "tuning/machine_dual.hpp"

namespace hysteron {
namespace {

using hysteron::testing::RandomDiagram;
using hysteron::testing::RecordedRun;
using test::motor_loop;
using test::MotorBench;

/// The tests run in a program of their own; the worker is beside the tool.
const bool worker_is_known = [] {
  cosimulation::set_worker_program(std::filesystem::path(HYSTERON_TOOL).parent_path() / "hysteron-fmu-worker");
  return true;
}();

/// A diagram that has nothing but an FMU, whose pins are those of a random diagram.
std::string around(const std::filesystem::path& fmu) {
  return fmt::format(R"(FUNCTION_BLOCK AROUND  (* @ts 1ms *)
  VAR_INPUT X1 : LREAL; X2 : LREAL; X3 : LREAL; B1 : BOOL; B2 : BOOL; N1 : DINT; END_VAR
  VAR_OUTPUT Y0 : LREAL; Y1 : LREAL; Y2 : LREAL; Y3 : LREAL; Q : BOOL; N : DINT; END_VAR
  VAR PLANT : HY_FMU;  (* @file {} *) END_VAR
  Y0 := PLANT.Y0; Y1 := PLANT.Y1; Y2 := PLANT.Y2; Y3 := PLANT.Y3; Q := PLANT.Q; N := PLANT.N;
  PLANT(X1 := X1, X2 := X2, X3 := X3, B1 := B1, B2 := B2, N1 := N1);
END_FUNCTION_BLOCK
)",
                     fmu.string());
}

std::filesystem::path packed(const test::ScratchFolder& folder, const Program& program, FmiVersion version) {
  Diagnostics warnings;
  return folder.write(fmt::format("{}.fmu", program.graph.name),
                      tool::pack_fmu(program, {.version = version}, warnings).text);
}

TEST(FmuMachine, RandomDiagramsAsFmusHaveTheirBitsOneStepLater) {
  const test::ScratchFolder folder;
  constexpr std::size_t steps = 300;
  std::size_t total = 0;
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    const Program program = RandomDiagram(seed + 7300, fmt::format("R{}", seed), 20).program();
    const RecordedRun run = hysteron::testing::record<double>(program, steps, seed);
    Machine<double> machine(
        compile_text(around(packed(folder, program, seed % 2 == 0 ? FmiVersion::Two : FmiVersion::Three))));
    std::size_t compared = 0;
    // From the first output on that is no finite number, a block refuses the FMU.
    const auto finite = std::ranges::find_if_not(run.outputs, [](double y) { return std::isfinite(y); });
    const std::size_t most =
        std::min(steps / 2, static_cast<std::size_t>(finite - run.outputs.begin()) / RecordedRun::columns);
    for (std::size_t k = 0; k < most; ++k) {
      for (std::size_t i = 0; i < RecordedRun::columns; ++i) {
        machine.set_input(i, run.inputs[k * RecordedRun::columns + i]);
      }
      try {
        machine.step();
      } catch (const cosimulation::FmuRefusal&) {
        break;  // a division by 0 before the first inputs
      }
      for (std::size_t i = 0; k > 0 && i < RecordedRun::columns; ++i) {
        ASSERT_TRUE(hysteron::testing::same_bits(machine.output(i), run.outputs[(k - 1) * RecordedRun::columns + i]))
            << "seed " << seed << " step " << k << " output " << i;
        ++compared;
      }
    }
    total += compared;
  }
  EXPECT_GT(total, 300U);  // of some, the first infinity comes early
}

constexpr std::string_view drive = R"(FUNCTION_BLOCK DRIVE  (* @ts 1ms *)
  VAR_INPUT
    U : LREAL;
    GAIN : LREAL := 3.0;   (* @param *)
    SLOPE : LREAL := 0.5;  (* @param *)
  END_VAR
  VAR_OUTPUT Y : LREAL; END_VAR
  VAR LAG : HY_LAG := (T1 := 0.02); SUM : HY_INTEGRAL; END_VAR
  LAG(XIN := GAIN * U);
  SUM(XIN := SIN(SLOPE * LAG.XOUT));
  Y := SUM.XOUT;
END_FUNCTION_BLOCK
)";

/// The same, with GAIN before the FMU and SLOPE within it, and the step of delay that an FMU has.
TEST(FmuMachine, DerivativesAreThoseOfTheDiagramThatTheFmuIsMadeOf) {
  const test::ScratchFolder folder;
  const Program inside = compile_text(std::string(drive));
  Diagnostics warnings;
  for (const FmiVersion version : {FmiVersion::Two, FmiVersion::Three}) {
    const std::string file = folder.write("DRIVE.fmu", tool::pack_fmu(inside, {.version = version}, warnings).text);
    const Program outside = compile_text(fmt::format(R"(FUNCTION_BLOCK OUTSIDE  (* @ts 1ms *)
  VAR_INPUT U : LREAL; BEFORE : LREAL := 2.0; (* @param *) END_VAR
  VAR_OUTPUT Y : LREAL; END_VAR
  VAR PLANT : HY_FMU := (GAIN := 3.0, SLOPE := 0.5);  (* @file {} *) END_VAR
  Y := PLANT.Y;
  PLANT(U := BEFORE * U);
END_FUNCTION_BLOCK
)",
                                                     file));
    using D = Dual<3>;
    Machine<D> exact(inside);
    Machine<D> differences(outside);
    const auto index = [](const Program& program, const char* path) {
      return static_cast<std::size_t>(find_parameter(program.graph, path));
    };
    // GAIN of the diagram stands for BEFORE·GAIN: d/dBEFORE = 3 · d/dGAIN.
    exact.set_parameter(index(inside, "GAIN"), D::variable(6.0, 0));
    exact.set_parameter(index(inside, "SLOPE"), D::variable(0.5, 1));
    differences.set_parameter(index(outside, "BEFORE"), D::variable(2.0, 0));
    differences.set_parameter(index(outside, "PLANT.SLOPE"), D::variable(0.5, 1));
    differences.use_directions(2);
    exact.reset();
    differences.reset();
    D before;
    for (int k = 0; k < 400; ++k) {
      const D u(std::sin(0.05 * k));
      exact.set_input(0, u);
      differences.set_input(0, u);
      exact.step();
      differences.step();
      const D y = differences.output(0);
      if (k > 0) {
        ASSERT_NEAR(y.value(), before.value(), 1e-12 * (1.0 + std::abs(before.value())));
        EXPECT_NEAR(y.derivative(0), 3.0 * before.derivative(0), 1e-4 * (1e-2 + std::abs(before.derivative(0))));
        EXPECT_NEAR(y.derivative(1), before.derivative(1), 1e-4 * (1e-2 + std::abs(before.derivative(1))));
      }
      EXPECT_EQ(y.derivative(2), 0.0);
      before = exact.output(0);
    }
  }
}

/// y(k) = k·TS·gain·u, also where each instance needs a process of its own.
TEST(FmuMachine, DerivativesOfInstancesInOneProcessAndInSeveral) {
  const MotorBench bench;
  for (const bool alone : {false, true}) {
    std::string xml(test::model_xml);
    const std::string_view step = "canHandleVariableCommunicationStepSize=\"false\"";
    xml.replace(xml.find(step), step.size(), alone ? "canBeInstantiatedOnlyOncePerProcess=\"true\"" : "");
    test::write_motor(bench.path() / (alone ? "alone.fmu" : "motor.fmu"), xml);
    std::string text(motor_loop);
    text.replace(text.find("motor.fmu"), 9, alone ? "alone.fmu" : "motor.fmu");
    Machine<Dual<3>> machine(compile_text(text, {.path = (bench.path() / "loop.st").string()}));
    machine.use_directions(1);
    for (const double gain : {2.0, 0.0, 1e-9}) {
      machine.set_parameter(0, Dual<3>::variable(gain, 0));
      machine.reset();
      for (int k = 0; k < 20; ++k) {
        machine.set_input(0, Dual<3>(1.5));
        machine.step();
        EXPECT_NEAR(machine.output(0).value(), 0.001 * k * gain * 1.5, 1e-12) << alone;
        EXPECT_NEAR(machine.output(0).derivative(0), 0.001 * k * 1.5, 1e-9) << alone << gain;
      }
    }
  }
}

TEST(FmuMachine, AMachineIsResetAndUsedAgain) {
  const MotorBench bench;
  const Program program = compile_text(std::string(motor_loop), {.path = (bench.path() / "loop.st").string()});
  Machine<double> machine(program);
  std::vector<double> first;
  for (int round = 0; round < 3; ++round) {
    machine.reset();
    for (int k = 0; k < 5; ++k) {
      machine.set_input(0, 1.0 + k);
      machine.step();
      if (round == 0) {
        first.push_back(machine.output(0));
      } else {
        EXPECT_EQ(machine.output(0), first[static_cast<std::size_t>(k)]);
      }
    }
  }
  EXPECT_GT(first.back(), 0.0);
}

}  // namespace
}  // namespace hysteron
