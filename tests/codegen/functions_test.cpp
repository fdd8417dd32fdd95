// Functions that are made of several operations: against the C++ library.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>

#include "codegen/compile.hpp"
#include "codegen/interpreter/machine.hpp"
#include "support/errors.hpp"

namespace hysteron::testing {
namespace {

double angle(double y, double x) {
  static Machine<double> machine(
      compile_text("FUNCTION_BLOCK F (* @ts 1ms *) VAR_INPUT A, B : LREAL; END_VAR VAR_OUTPUT Y : LREAL; END_VAR "
                   "Y := ATAN2(A, B); END_FUNCTION_BLOCK"));
  machine.set_input(0, y);
  machine.set_input(1, x);
  machine.step();
  return machine.output(0);
}

TEST(Functions, TheAngleOfAPointInAllQuadrants) {
  std::mt19937_64 engine(1);
  const auto unit = [&] { return static_cast<double>(engine() >> 11U) * 0x1p-52 - 1.0; };
  for (int i = 0; i < 20'000; ++i) {
    const double scale = std::pow(10.0, 12.0 * unit());
    const double y = unit();
    const double x = unit() * scale;
    ASSERT_NEAR(angle(y, x), std::atan2(y, x), 9e-16) << y << ", " << x;
  }
}

TEST(Functions, TheAngleOnTheAxes) {
  constexpr double pi = 3.141592653589793;
  struct Point {
    double y;
    double x;
    double angle;
  };
  for (const Point& one : std::array{Point{0.0, 1.0, 0.0}, Point{1.0, 0.0, pi / 2}, Point{0.0, -1.0, pi},
                                     Point{-1.0, 0.0, -pi / 2}, Point{-1.0, -0.0, -pi / 2}, Point{0.0, 0.0, 0.0},
                                     Point{1e300, 1e-300, pi / 2}, Point{INFINITY, 1.0, pi / 2}}) {
    EXPECT_EQ(angle(one.y, one.x), one.angle) << one.y << ", " << one.x;
  }
  EXPECT_TRUE(std::isnan(angle(NAN, 1.0)));
  EXPECT_TRUE(std::isnan(angle(1.0, NAN)));
}

TEST(Functions, ANamedArgumentOfAnotherNameIsRefused) {
  for (const std::string call : {"EXPT(BASE := A, POWER := A)", "ATAN2(X := A, Z := A)", "ATAN2(A)"}) {
    EXPECT_THROW(
        (void)compile_text("FUNCTION_BLOCK F VAR_INPUT A : LREAL; END_VAR VAR_OUTPUT Y : LREAL; END_VAR Y := " + call +
                           "; END_FUNCTION_BLOCK"),
        InputError)
        << call;
  }
}

TEST(Functions, ABitOfAWordIsRead) {
  std::string outputs;
  std::string statements;
  for (int bit = 0; bit < 16; ++bit) {
    outputs += fmt::format("Y{0}, Z{0}, V{0} : BOOL; ", bit);
    statements += fmt::format("Y{0} := W.{0}; Z{0} := NOT D.XOUT.{0} OR W.{0}; V{0} := X[1].{0};\n", bit);
  }
  Machine<double> machine(compile_text(
      "FUNCTION_BLOCK F (* @ts 1ms *) VAR_INPUT W : WORD; X : ARRAY[0..1] OF WORD; END_VAR\nVAR_OUTPUT " + outputs +
      "END_VAR\nVAR D : HY_DELAY_WORD; END_VAR\n" + statements + "D(XIN := W);\nEND_FUNCTION_BLOCK"));
  std::mt19937 engine(1);
  unsigned last = 0;
  for (int k = 0; k < 300; ++k) {
    const auto word = static_cast<unsigned>(k < 16 ? 1UL << static_cast<unsigned>(k) : engine() % 65536);
    const auto other = static_cast<unsigned>(engine() % 65536);
    machine.set_input(0, word);
    machine.set_input(2, other);
    machine.step();
    for (unsigned bit = 0; bit < 16; ++bit) {
      const auto output = [&](unsigned which) { return machine.output(3 * bit + which) != 0.0; };
      const auto is_set = [&](unsigned value) { return ((value >> bit) & 1U) != 0; };
      ASSERT_EQ(output(0), is_set(word)) << word << " " << bit;
      ASSERT_EQ(output(1), !is_set(last) || is_set(word)) << word << " " << bit;
      ASSERT_EQ(output(2), is_set(other)) << other << " " << bit;
    }
    last = word;
  }
}

TEST(Functions, WordsHaveTheirBits) {
  Machine<double> machine(compile_text(
      "FUNCTION_BLOCK F (* @ts 1ms *) VAR_INPUT A, B : WORD; N : DINT; END_VAR\n"
      "VAR_OUTPUT Q1, Q2, Q3, Q4, L0, L3, L16, R1, R16, C : WORD; E, D : BOOL; I : DINT; END_VAR\n"
      "Q1 := A AND B; Q2 := A OR B; Q3 := A XOR 16#00FF; Q4 := NOT A; L0 := SHL(A, 0); L3 := SHL(IN := A, N := 3); "
      "L16 := SHL(A, 16); R1 := SHR(A, 1); R16 := SHR(A, 16); C := DINT_TO_WORD(N); E := (A AND 16#6F) = 16#27; "
      "D := A <> B; I := WORD_TO_DINT(A);\nEND_FUNCTION_BLOCK"));
  std::mt19937 engine(1);
  for (int k = 0; k < 2000; ++k) {
    const unsigned a = k < 256 ? 0xFF00U + static_cast<unsigned>(k) : engine() % 65536;
    const unsigned b = k % 5 == 0 ? a : engine() % 65536;
    const auto n = static_cast<std::int32_t>(engine());
    machine.set_input(0, a);
    machine.set_input(1, b);
    machine.set_input(2, n);
    machine.step();
    const std::array<double, 13> wanted{static_cast<double>(a & b),
                                        static_cast<double>(a | b),
                                        static_cast<double>(a ^ 0xFFU),
                                        static_cast<double>(~a & 0xFFFFU),
                                        static_cast<double>(a),
                                        static_cast<double>((a << 3U) & 0xFFFFU),
                                        0.0,
                                        static_cast<double>(a >> 1U),
                                        0.0,
                                        static_cast<double>(static_cast<std::uint32_t>(n) & 0xFFFFU),
                                        (a & 0x6FU) == 0x27U ? 1.0 : 0.0,
                                        a != b ? 1.0 : 0.0,
                                        static_cast<double>(a)};
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      ASSERT_EQ(machine.output(i), wanted[i]) << "output " << i << ", " << a << ", " << b << ", " << n;
    }
  }
}

TEST(Functions, WhatIsNoOperationOnWordsIsRefused) {
  const auto refused = [](const std::string& expression) {
    try {
      (void)compile_text(
          "FUNCTION_BLOCK F VAR_INPUT A : WORD; N : DINT; X : LREAL; B : BOOL; END_VAR VAR_OUTPUT Y : WORD; "
          "END_VAR Y := " +
          expression + "; END_FUNCTION_BLOCK");
    } catch (const InputError& error) {
      return error.diagnostics().all().front().number;
    }
    return 0;
  };
  for (const char* const expression :
       {"A + A", "A AND 65536", "A AND -1", "A AND N", "A AND B", "A < A", "-A", "A AND X"}) {
    EXPECT_EQ(refused(expression), error::type_mismatch) << expression;
  }
  for (const char* const expression : {"SHL(A, 17)", "SHL(A, -1)", "SHL(A, N)", "SHL(N, 1)", "SHR(A)",
                                       "DINT_TO_WORD(A)", "DINT_TO_WORD(X)", "ROL(A, 1)"}) {
    EXPECT_EQ(refused(expression), error::unknown_function) << expression;
  }
}

}  // namespace
}  // namespace hysteron::testing
