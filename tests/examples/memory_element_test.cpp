// Example 1: the figures of the paper's Figs. 2 to 6, by their closed forms.
#include "examples/01_memory_element/memory_element.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "examples/03_feedforward/actuator.hpp"

namespace hysteron::examples {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;

const records::Record& loop() {
  static const records::Record record = run_memory_element(Material{}.reconciled());
  return record;
}

TEST(MemoryElement, InputIsEquationFour) {
  const auto u = column(loop(), "U");
  for (std::size_t k = 0; k < u.size(); ++k) {
    const double t = loop().time()[k];
    const double wave = std::sin(2.0 * std::numbers::pi * t);
    EXPECT_NEAR(u[k], t <= 1.75 ? 250.0 * wave : 125.0 * wave - 125.0, 1e-11) << "t = " << t;
  }
}

TEST(MemoryElement, ConversionGivesTheConstantsOfTheMap) {
  const StaticMap map = Material{}.reconciled().map();
  EXPECT_NEAR(Material{}.reconciled().alpha, 3.2653, 5e-5);
  EXPECT_NEAR(map.C1, 2.45e-9, 1e-23);
  EXPECT_NEAR(map.C2, 1.6e-11, 1e-25);
  EXPECT_DOUBLE_EQ(map.C3, 1.0);
}

TEST(MemoryElement, AlphaAsPrintedShowsNoHysteresis) {
  const LoopFigures figures = figures_of(run_memory_element(Material{}));
  EXPECT_NEAR(figures.least, -0.6125e-6, 1e-14);
  EXPECT_NEAR(figures.largest, 0.6125e-6, 1e-14);
  EXPECT_LT(figures.opening, 1e-8);
}

TEST(MemoryElement, AlphaReconciledGivesTheLoopOfFigThree) {
  const LoopFigures figures = figures_of(loop());
  EXPECT_NEAR(figures.least, -1.6125e-6, 1e-18);
  EXPECT_NEAR(figures.largest, 1.6125e-6, 1e-18);
  // the fall from t_1, the rise from t_2, the fall from t_3, and the turn at u = 0 after t_4
  const auto near = [](double y) { return DoubleNear(y, 1e-15); };
  EXPECT_THAT(figures.crossings, ElementsAre(near(0.5e-6), near(-0.5e-6), near(0.5e-6), near(-0.5e-6)));
}

TEST(MemoryElement, BranchingPointsAreWhereTheInputTurns) {
  const auto near = [](double t) { return DoubleNear(t, 1e-12); };
  EXPECT_THAT(figures_of(loop()).branching_times,
              ElementsAre(near(0.25), near(0.75), near(1.25), near(1.75), near(2.25), near(2.75)));
}

TEST(MemoryElement, BlockAgreesWithThePrintedEquations) {
  RambergOsgoodActuator printed_equations(Material{}.reconciled());
  const auto u = column(loop(), "U");
  const auto y = column(loop(), "Y");
  for (std::size_t k = 0; k < u.size(); ++k) {
    EXPECT_NEAR(y[k], printed_equations(u[k]), 1e-14 * 3.225e-6) << "t = " << loop().time()[k];
  }
}

TEST(MemoryElement, MomentumIsTheDistanceFromTheBranchingPoint) {
  const auto u = column(loop(), "U");
  const auto p = column(loop(), "P");
  const auto branch = column(loop(), "BRANCH");
  double branching_point = 0.0;
  for (std::size_t k = 1; k < u.size(); ++k) {
    if (branch[k] != branch[k - 1]) {
      branching_point = u[k - 1];
    }
    EXPECT_NEAR(p[k], std::fabs(u[k] - branching_point) * (branch[k] > 0.0 ? 1.0 : 2.0), 1e-12);
  }
}

TEST(MemoryElement, GradientDependsOnTheMomentumAlone) {
  const StaticMap map = Material{}.reconciled().map();
  for (const Gradient& point : gradients_of(loop())) {
    EXPECT_NEAR(point.gradient, map(point.p), 1e-9 * 1.05e-8) << "branch " << point.branch << ", p = " << point.p;
  }
}

TEST(MemoryElement, LoopOfTheRatesIsPinched) {
  // Theorem 4: the rates of the loop are those of a MEM element, which gives 0 for 0. Forward Euler takes the momentum
  // at the start of each step, so it is off by less than C2 times the travel in one step.
  const LoopFigures figures = figures_of(loop());
  const double largest_travel = 1e-3 * range(column(loop(), "U_RATE")) * 0.5;
  const double largest_rate = 0.5 * range(column(loop(), "Y_RATE"));
  EXPECT_LT(figures.element_error * largest_rate, 0.51 * 1.6e-11 * largest_travel * largest_travel / 1e-3);
  const auto u_rate = column(loop(), "U_RATE");
  const auto y_rate = column(loop(), "Y_RATE");
  for (std::size_t k = 0; k < u_rate.size(); ++k) {
    EXPECT_LE(std::fabs(y_rate[k]), 1.05e-8 * std::fabs(u_rate[k]) * (1.0 + 1e-9));
    EXPECT_GE(y_rate[k] * u_rate[k], 0.0);
  }
}

}  // namespace
}  // namespace hysteron::examples
