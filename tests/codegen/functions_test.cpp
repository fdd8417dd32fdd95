// Functions that are made of several operations: against the C++ library.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <string>

#include "codegen/compile.hpp"
#include "codegen/interpreter/machine.hpp"

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

}  // namespace
}  // namespace hysteron::testing
