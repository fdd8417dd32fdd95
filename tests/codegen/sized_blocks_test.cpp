// Blocks whose pins are vectors: against a simulation of matrices, against closed forms, against their elements written
// out; what their sizes may be, and that every scalar runs them alike.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <memory>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "codegen/compile.hpp"
#include "codegen/graph/discretise.hpp"
#include "codegen/graph/relations.hpp"
#include "codegen/interpreter/machine.hpp"
#include "codegen/trace/sized_block.hpp"
#include "support/errors.hpp"

namespace hysteron::testing {
namespace {

using ::testing::HasSubstr;

std::string in_list(const Eigen::MatrixXd& m) {
  std::string text;
  for (Eigen::Index i = 0; i < m.rows(); ++i) {
    for (Eigen::Index k = 0; k < m.cols(); ++k) {
      text +=
          fmt::format("{}({:.17g}{})", text.empty() ? "" : ", ", m(i, k), m(i, k) == std::floor(m(i, k)) ? ".0" : "");
    }
  }
  return "[" + text + "]";
}

std::string port_of(const std::string& name, Eigen::Index length) {
  return length == 1 ? fmt::format("{} : LREAL; ", name)
                     : fmt::format("{} : ARRAY[0..{}] OF LREAL; ", name, length - 1);
}

Eigen::MatrixXd random_matrix(std::mt19937_64& engine, Eigen::Index rows, Eigen::Index columns, double size) {
  Eigen::MatrixXd m(rows, columns);
  for (Eigen::Index i = 0; i < rows; ++i) {
    for (Eigen::Index k = 0; k < columns; ++k) {
      m(i, k) = size * (static_cast<double>(engine() >> 11U) * 0x1p-52 - 1.0);
    }
  }
  return m;
}

// x⁺ = A·x + B·u, y = C·x + D·u, by Eigen; with a reset in the middle.
TEST(StateSpace, IsTheSystemOfItsMatrices) {
  std::mt19937_64 engine(11);
  for (const auto& [n, m, p] :
       std::vector<std::array<Eigen::Index, 3>>{{1, 1, 1}, {2, 1, 1}, {3, 2, 2}, {5, 1, 3}, {16, 3, 4}}) {
    for (const bool direct : {false, true}) {
      const auto a = random_matrix(engine, n, n, 0.9 / static_cast<double>(n));
      const auto b = random_matrix(engine, n, m, 1.0);
      const auto c = random_matrix(engine, p, n, 1.0);
      const Eigen::MatrixXd d = direct ? random_matrix(engine, p, m, 1.0) : Eigen::MatrixXd::Zero(p, m).eval();
      const Eigen::VectorXd x0 = random_matrix(engine, n, 1, 1.0);
      Machine<double> machine(compile_text(fmt::format(
          "FUNCTION_BLOCK T (* @ts 1ms *) VAR_INPUT {} R : BOOL; END_VAR VAR_OUTPUT {} {} END_VAR VAR S : "
          "HY_STATE_SPACE := "
          "(A := {}, B := {}, C := {}{}, X0 := {}); END_VAR S(U := U, R1 := R); Y := S.Y; X := S.X; END_FUNCTION_BLOCK",
          port_of("U", m), port_of("Y", p), port_of("X", n), in_list(a), in_list(b), in_list(c),
          direct ? ", D := " + in_list(d) : "", in_list(x0))));
      Eigen::VectorXd x = x0;
      for (int k = 0; k < 60; ++k) {
        const Eigen::VectorXd u = random_matrix(engine, m, 1, 1.0);
        for (Eigen::Index i = 0; i < m; ++i) {
          machine.set_input(static_cast<std::size_t>(i), u(i));
        }
        machine.set_input(static_cast<std::size_t>(m), k == 30 ? 1.0 : 0.0);
        machine.step();
        x = k == 30 ? x0 : x;
        const Eigen::VectorXd y = c * x + d * u;
        for (Eigen::Index i = 0; i < p; ++i) {
          ASSERT_NEAR(machine.output(static_cast<std::size_t>(i)), y(i), 1e-12 * (1.0 + y.norm())) << n << " " << k;
        }
        for (Eigen::Index i = 0; i < n; ++i) {
          ASSERT_NEAR(machine.output(static_cast<std::size_t>(p + i)), x(i), 1e-12) << n << " " << k;
        }
        x = a * x + b * u;
      }
    }
  }
}

TEST(MatrixGain, IsTheProduct) {
  std::mt19937_64 engine(12);
  const auto k = random_matrix(engine, 3, 4, 2.0);
  Machine<double> machine(
      compile_text(fmt::format(
          "FUNCTION_BLOCK T VAR_INPUT U : ARRAY[0..3] OF LREAL; END_VAR VAR_OUTPUT Y : ARRAY[0..2] OF LREAL; END_VAR "
          "VAR G : HY_MATRIX_GAIN := (K := {}, ROWS := 3); END_VAR G(XIN := U); Y := G.XOUT; END_FUNCTION_BLOCK",
          in_list(k))),
      1e-3);
  const Eigen::VectorXd u = random_matrix(engine, 4, 1, 1.0);
  for (Eigen::Index i = 0; i < 4; ++i) {
    machine.set_input(static_cast<std::size_t>(i), u(i));
  }
  machine.step();
  for (Eigen::Index i = 0; i < 3; ++i) {
    EXPECT_NEAR(machine.output(static_cast<std::size_t>(i)), (k * u)(i), 1e-14);
  }
}

/// The answer of one block with XIN and XOUT to sin(0.7·k) + 0.3.
std::vector<double> answer(const std::string& type, const std::string& settings, std::size_t steps) {
  Machine<double> machine(
      compile_text(fmt::format("FUNCTION_BLOCK T (* @ts 1ms *) VAR_INPUT U : LREAL; END_VAR VAR_OUTPUT Y : LREAL; "
                               "END_VAR VAR G : {} := ({}); END_VAR "
                               "G(XIN := U); Y := G.XOUT; END_FUNCTION_BLOCK",
                               type, settings)));
  std::vector<double> values;
  for (std::size_t k = 0; k < steps; ++k) {
    machine.set_input(0, std::sin(0.7 * static_cast<double>(k)) + 0.3);
    machine.step();
    values.push_back(machine.output(0));
  }
  return values;
}

void hold_near(const std::vector<double>& values, const std::vector<double>& wanted) {
  ASSERT_EQ(values.size(), wanted.size());
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    EXPECT_NEAR(values[i], wanted[i], 1e-12 * (1.0 + std::abs(wanted[i]))) << i;
  }
}

// Printed by scipy 1.x: scipy.signal.lfilter([0, 1.0, 0.2], [2.0, -0.7, 0.1], u).
TEST(TransferFunction, IsTheFilterOfItsCoefficients) {
  hold_near(
      answer("HY_TRANSFER_FUNCTION", "NUM := [1.0, 0.2], DEN := [2.0, -0.7, 0.1]", 12),
      {0.0, 0.15, 0.5546088436188455, 0.9237597289845951, 1.0057351192869488, 0.7396343170440423, 0.2466924561718479,
       -0.2415055651678112, -0.4952454541708514, -0.3951392109000015, 0.011743835348484777, 0.5340419923247993});
}

// scipy.signal.cont2discrete(([2, 3], [0.0004, 0.02, 1]), 1e-3, 'bilinear'), then lfilter.
TEST(TransferFunctionS, IsTustinsFilter) {
  hold_near(answer("HY_TRANSFER_FUNCTION_S", "NUM := [2.0, 3.0], DEN := [0.0004, 0.02, 1.0]", 12),
            {0.7318098720292506, 3.7305492826093976, 8.982426551379907, 14.498729054446072, 18.133005435663993,
             18.591110395628867, 16.040450583570234, 12.03188966288036, 8.77103782827344, 8.081645793743629,
             10.548631436994011, 15.243783333966512});
}

// scipy.signal.tf2ss, cont2discrete(…, 'zoh'), dlsim.
TEST(TransferFunctionZoh, IsTheSystemOfAHeldInput) {
  hold_near(answer("HY_TRANSFER_FUNCTION_ZOH", "NUM := [2.0, 3.0], DEN := [0.0004, 0.02, 1.0]", 12),
            {0.0, 1.4636139867038411, 5.997425966081637, 11.96717884541984, 17.02963338466599, 19.235138419477597,
             17.945146445349604, 14.133148541226127, 9.927490203745784, 7.611084996933659, 8.548472451484932,
             12.544837873455458});
}

// The answer of a held input is exact at the samples: 1/(T·s + 1) has 1 − e^(−t/T) after a step, 1/s² has t²/2.
TEST(TransferFunctionZoh, HasTheClosedFormOfAStep) {
  for (const double time_constant : {1e-6, 0.02, 100.0}) {
    Machine<double> machine(
        compile_text(fmt::format("FUNCTION_BLOCK T (* @ts 1ms *) VAR_OUTPUT Y, Z : LREAL; END_VAR VAR G : "
                                 "HY_TRANSFER_FUNCTION_ZOH := (NUM := 1.0, DEN "
                                 ":= [{:.10f}, 1.0]); H : HY_TRANSFER_FUNCTION_ZOH := (NUM := [1.0], DEN := [1.0, 0.0, "
                                 "0.0]); END_VAR G(XIN := 1.0); "
                                 "H(XIN := 1.0); Y := G.XOUT; Z := H.XOUT; END_FUNCTION_BLOCK",
                                 time_constant)));
    for (int k = 0; k < 200; ++k) {
      machine.step();
      const double t = 1e-3 * k;
      EXPECT_NEAR(machine.output(0), -std::expm1(-t / time_constant), 1e-13);
      EXPECT_NEAR(machine.output(1), t * t / 2.0, 1e-13);
    }
  }
}

// Fast poles beside slow ones: each mode of 1/((T1·s + 1)·(T2·s + 1)) has its closed form.
TEST(TransferFunctionZoh, HoldsPolesOfManySizes) {
  const double fast = 1e-5;
  const double slow = 10.0;
  const HeldSystem held = discretise_held(std::vector{1.0}, std::vector{fast * slow, fast + slow, 1.0}, 1e-3);
  Eigen::Vector2d x = Eigen::Vector2d::Zero();
  const Eigen::Matrix2d phi{{held.phi[0], held.phi[1]}, {held.phi[2], held.phi[3]}};
  for (int k = 0; k < 3000; ++k) {
    const double t = 1e-3 * k;
    const double wanted = 1.0 - (slow * std::exp(-t / slow) - fast * std::exp(-t / fast)) / (slow - fast);
    ASSERT_NEAR(held.c[0] * x(0) + held.c[1] * x(1), wanted, 1e-12);
    x = phi * x + Eigen::Vector2d(held.gamma[0], held.gamma[1]);
  }
}

// Tustin maps the frequency ω to (2/TS)·tan(ωTS/2): in the steady state the gain is |G(j·that)|, also where the sample
// time is very short against the poles.
TEST(TransferFunctionS, KeepsItsGainWhereTheSampleTimeIsShort) {
  for (const std::string ts : {"1us", "1ms"}) {
    Machine<double> machine(compile_text(fmt::format(
        "FUNCTION_BLOCK T (* @ts {} *) VAR_INPUT U : LREAL; END_VAR VAR_OUTPUT Y : LREAL; END_VAR VAR G : "
        "HY_TRANSFER_FUNCTION_S := (NUM := [1.0], DEN := [0.0001, 0.004, 1.0]); END_VAR G(XIN := U); Y := G.XOUT; "
        "END_FUNCTION_BLOCK",
        ts)));
    const double period = machine.sample_time();
    const double frequency = 100.0;
    double peak = 0.0;
    for (int k = 0; k * period < 0.6; ++k) {  // the beginning fades with e^(−20·t)
      machine.set_input(0, std::sin(frequency * period * k));
      machine.step();
      peak = k * period > 0.5 ? std::max(peak, std::abs(machine.output(0))) : 0.0;
    }
    const double warped = 2.0 / period * std::tan(frequency * period / 2.0);
    const double gain = 1.0 / std::hypot(1.0 - 0.0001 * warped * warped, 0.004 * warped);
    EXPECT_NEAR(peak, gain, 0.003 * gain) << ts;
  }
}

/// What is said of a declaration of an instance G.
std::string fault_of(const std::string& type, const std::string& settings, const std::string& call = "XIN := U") {
  Diagnostics diagnostics;
  auto parsed = language::parse(
      "t.st",
      fmt::format("FUNCTION_BLOCK T (* @ts 1ms *) VAR_INPUT U : LREAL; END_VAR VAR_OUTPUT Y : LREAL; END_VAR "
                  "VAR G : {} := ({}); END_VAR G({}); Y := U; END_FUNCTION_BLOCK",
                  type, settings, call),
      diagnostics);
  if (!diagnostics.has_errors()) {
    check(std::make_shared<const language::SourceFile>(std::move(parsed)), diagnostics);
  }
  return diagnostics.all().empty() ? ""
                                   : fmt::format("HY{} {}", diagnostics.all()[0].number, diagnostics.all()[0].cause);
}

TEST(SizedBlocks, SizesThatDisagreeAreRefusedByName) {
  const auto ss = [](const std::string& settings) { return fault_of("HY_STATE_SPACE", settings, "U := U"); };
  EXPECT_EQ(ss("A := [0.5], B := [1.0], C := [1.0]"), "");
  EXPECT_EQ(ss("A := 0.5, B := 1.0, C := 1.0, D := 2.0, X0 := 1.0"), "");
  EXPECT_THAT(ss("A := [0.5, 0.1], B := [1.0], C := [1.0]"),
              HasSubstr("HY224 'G': A has 2 numbers, which are no square"));
  EXPECT_THAT(ss("A := [0.5, 0.1, 0.0, 0.2], B := [1.0], C := [1.0, 0.0]"), HasSubstr("HY224 'G': B has 1 numbers"));
  EXPECT_THAT(ss("A := [0.5, 0.1, 0.0, 0.2], B := [1.0, 0.0], C := [1.0]"), HasSubstr("HY224 'G': C has 1 numbers"));
  EXPECT_THAT(ss("A := [0.5], B := [1.0], C := [1.0], D := [1.0, 2.0]"), HasSubstr("HY224 'G': D has 2 numbers"));
  EXPECT_THAT(ss("A := [0.5], B := [1.0], C := [1.0], X0 := [1.0, 2.0]"), HasSubstr("HY224 'G': X0 has 2 numbers"));
  EXPECT_THAT(ss("A := [0.5], B := [1.0]"), HasSubstr("HY224 'G': HY_STATE_SPACE needs C"));
  const auto gain = [](const std::string& settings) { return fault_of("HY_MATRIX_GAIN", settings); };
  EXPECT_EQ(gain("K := [1.0, 2.0], ROWS := 2"), "");
  EXPECT_THAT(gain("K := [1.0, 2.0]"), HasSubstr("HY224 'G': HY_MATRIX_GAIN needs ROWS"));
  EXPECT_THAT(gain("K := [1.0, 2.0, 3.0], ROWS := 2"), HasSubstr("HY224 'G': K has 3 numbers"));
  EXPECT_THAT(gain("K := [1.0, 2.0], ROWS := 2.0"), HasSubstr("HY207 ROWS is DINT, the value is LREAL"));
  EXPECT_THAT(gain("K := [1.0, 2.0], ROWS := 0"), HasSubstr("HY224 'G': ROWS is not a number of rows"));
  for (const std::string type : {"HY_TRANSFER_FUNCTION", "HY_TRANSFER_FUNCTION_S", "HY_TRANSFER_FUNCTION_ZOH"}) {
    EXPECT_EQ(fault_of(type, "NUM := [1.0], DEN := [1.0, -0.5]"), "") << type;
    EXPECT_THAT(fault_of(type, "NUM := [1.0, 2.0, 3.0], DEN := [1.0, -0.5]"),
                HasSubstr("HY224 'G': NUM has degree 2 and DEN degree 1: the transfer function is improper"));
    EXPECT_THAT(fault_of(type, "NUM := [1.0], DEN := [0.0, -0.5]"), HasSubstr("HY224 'G': DEN begins with 0"));
    EXPECT_THAT(fault_of(type, "NUM := [1.0], DEN := [1.0]"), HasSubstr("HY224 'G': DEN has 1 number"));
    EXPECT_THAT(fault_of(type, "NUM := [1.0]"), HasSubstr("HY224 'G': " + type + " needs DEN"));
    EXPECT_THAT(fault_of(type, "NUM := [U], DEN := [1.0, 2.0]"), HasSubstr("HY207 the value of NUM is not a constant"));
  }
  EXPECT_THAT(fault_of("HY_MATRIX_GAIN", "K := [1.0]", "XIN := U, ROWS := 1"), HasSubstr("HY224 ROWS is no pin"));
  EXPECT_THAT(fault_of("HY_TRANSFER_FUNCTION", "NUM := [1.0], DEN := [1.0, -0.5]", "XIM := U"),
              HasSubstr("HY202 HY_TRANSFER_FUNCTION has no input 'XIM'"));
}

TEST(SizedBlocks, ZeroAsTheFirstOfDenIsAContradictionAlsoWhenItIsSet) {
  const SizedKind& kind = *find_sized_kind("hy_transfer_function");
  const BlockType& block = sized_block(kind, {.n = 1, .m = 1, .p = 2});
  const std::vector<double> num{1.0};
  const std::vector<double> den{0.0, 1.0};
  const std::vector<std::span<const double>> values{num, den};
  ASSERT_EQ(contradictions(block, "G", values, 1e-3).size(), 1U);
}

TEST(SizedBlocks, AHeldInputNeedsTheSampleTime) {
  Diagnostics diagnostics;
  auto parsed = language::parse("t.st",
                                "FUNCTION_BLOCK T VAR_INPUT U : LREAL; END_VAR VAR_OUTPUT Y : LREAL; END_VAR VAR G : "
                                "HY_TRANSFER_FUNCTION_ZOH := (NUM "
                                ":= [1.0], DEN := [1.0, 1.0]); END_VAR Y := G.XOUT; G(XIN := U); END_FUNCTION_BLOCK",
                                diagnostics);
  check(std::make_shared<const language::SourceFile>(std::move(parsed)), diagnostics);
  ASSERT_EQ(diagnostics.all().size(), 1U);
  EXPECT_EQ(diagnostics.all()[0].number, error::missing_sample_time);
}

TEST(SizedBlocks, ALoopMayBeClosedWhereNothingPassesAtOnce) {
  const auto loop = [](const std::string& num) {
    try {
      compile_text(
          fmt::format(
              "FUNCTION_BLOCK T (* @ts 1ms *) VAR_INPUT U : LREAL; END_VAR VAR_OUTPUT Y : LREAL; END_VAR VAR G : "
              "HY_TRANSFER_FUNCTION := (NUM := {}, DEN := [1.0, -0.5]); END_VAR Y := G.XOUT; G(XIN := U - Y); "
              "END_FUNCTION_BLOCK",
              num),
          {.any_order = true});
      return true;
    } catch (const InputError&) {
      return false;
    }
  };
  EXPECT_TRUE(loop("[0.1]"));
  EXPECT_FALSE(loop("[0.1, 0.2]"));
}

}  // namespace
}  // namespace hysteron::testing
