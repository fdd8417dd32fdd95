// M(p) by formula and by table, and their inverses.
#include "blocks/m.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "blocks/m_inverse.hpp"
#include "blocks/m_table.hpp"
#include "blocks/m_table_inverse.hpp"
#include "tests/blocks/random_io.hpp"
#include "tests/blocks/stepper.hpp"

namespace hysteron::testing {
namespace {

double slope(double c1, double c2, double c3, double p) {
  return Stepper<SlopeM>(1.0, {.C1 = c1, .C2 = c2, .C3 = c3})({.XIN = 1.0, .P = p, .R1 = false}).M;
}

TEST(SlopeM, IsTheFormula) {
  EXPECT_EQ(slope(0.5, 2.0, 1.0, 3.0), 6.5);
  EXPECT_EQ(slope(0.5, 2.0, 0.5, 9.0), 6.5);
  EXPECT_EQ(slope(0.5, 2.0, 2.0, 3.0), 18.5);
  EXPECT_EQ(slope(0.5, 2.0, 0.0, 3.0), 2.5);
  EXPECT_NEAR(slope(0.05, 1.3, 1.7, 0.8), 0.05 + 1.3 * std::exp(1.7 * std::log(0.8)), 1e-15);
}

TEST(SlopeM, AtABranchingPointIsC1) {
  for (const double c3 : {1e-3, 0.1, 0.5, 1.0, 2.0, 10.0}) {
    EXPECT_EQ(slope(0.5, 2.0, c3, 0.0), 0.5) << "C3 " << c3;
  }
  EXPECT_EQ(slope(0.5, 2.0, 0.0, 0.0), 2.5) << "C3 = 0 is a constant slope";
}

TEST(SlopeM, IsContinuousInTheExponentAtZero) {
  for (const double p : {1e-3, 1.0, 1e3}) {
    EXPECT_NEAR(slope(0.5, 2.0, 1e-12, p), slope(0.5, 2.0, 0.0, p), 1e-10);
  }
}

TEST(SlopeM, IsOneToOneForSignedMomentum) {
  double last = -infinity;
  for (int i = -100; i <= 100; ++i) {
    const double now = slope(5.0, 0.2, 1.7, 0.1 * i);
    EXPECT_GT(now, last);
    last = now;
  }
  EXPECT_NEAR(slope(5.0, 0.2, 1.0, -3.0), 5.0 - 0.6, 1e-15) << "C3 = 1 is a straight line through 0";
}

TEST(SlopeM, ConvertsFromRambergOsgood) {
  // Slope of (3): y*/u*·(1 + γ·α·(p/2u*)^(γ−1)), with the constants of Example 1.
  const double y_star = 1.225e-6;
  const double u_star = 500.0;
  const double alpha = 3.2653;
  const double gamma = 2.3;
  const double c1 = y_star / u_star;
  const double c2 = c1 * alpha * gamma / std::pow(2.0 * u_star, gamma - 1.0);
  for (const double p : {0.0, 1.0, 100.0, 500.0}) {
    const double expected = c1 * (1.0 + gamma * alpha * std::pow(p / (2.0 * u_star), gamma - 1.0));
    EXPECT_NEAR(slope(c1, c2, gamma - 1.0, p), expected, 1e-15 * expected + 1e-23);
  }
}

TEST(SlopeMInverse, UndoesTheSlope) {
  RandomIo random(3, 1.0);
  for (int k = 0; k < 1000; ++k) {
    const double c3 = 10.0 * random.unit();
    const MemSlopeParams<double> params{.C1 = random.unit(), .C2 = random.unit(), .C3 = c3};
    const double u = random.unit() - 0.5;
    const double p = 3.0 * random.unit();
    const double y = Stepper<SlopeM>(1.0, params)({.XIN = u, .P = p, .R1 = false}).XOUT;
    const auto out = Stepper<SlopeMInverse>(1.0, params)({.XIN = y, .P = p, .R1 = false});
    EXPECT_NEAR(out.XOUT, u, 4e-16 * std::fabs(u));
    EXPECT_FALSE(out.ERROR);
    EXPECT_EQ(out.ERRORID, 0);
  }
}

TEST(SlopeMInverse, SaysWhereThereIsNone) {
  Stepper<SlopeMInverse> block(1.0, {.C1 = 1.0, .C2 = -1.0, .C3 = 1.0});
  EXPECT_FALSE(block({.XIN = 1.0, .P = 0.5, .R1 = false}).ERROR);
  for (const double p : {1.0, 2.0, infinity, not_a_number}) {
    const auto out = block({.XIN = 1.0, .P = p, .R1 = false});
    EXPECT_EQ(out.XOUT, 0.0) << p;
    EXPECT_TRUE(out.ERROR) << p;
    EXPECT_EQ(out.ERRORID, fault::slope_not_positive);
  }
}

SlopeTableParams<double> sampled_square_root(int count) {
  SlopeTableParams<double> table{};
  for (int i = 0; i < count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    table.P_TABLE[k] = 0.01 * i * i;
    table.M_TABLE[k] = 1.0 + std::sqrt(table.P_TABLE[k]);
  }
  table.COUNT = count;
  return table;
}

TEST(SlopeMTable, PassesThroughItsPointsAndHoldsOutside) {
  for (const int count : {2, 3, 7, 31, 32}) {
    const auto table = sampled_square_root(count);
    Stepper<SlopeMTable> block(1.0, table);
    for (int i = 0; i < count; ++i) {
      const auto k = static_cast<std::size_t>(i);
      EXPECT_EQ(block({.XIN = 1.0, .P = table.P_TABLE[k], .R1 = false}).M, table.M_TABLE[k]);
    }
    const auto last = static_cast<std::size_t>(count - 1);
    EXPECT_EQ(block({.XIN = 1.0, .P = -1.0, .R1 = false}).M, table.M_TABLE[0]);
    EXPECT_EQ(block({.XIN = 1.0, .P = 1e9, .R1 = false}).M, table.M_TABLE[last]);
  }
}

TEST(SlopeMTable, IsStraightBetweenItsPoints) {
  // Against a search from the left instead of by bisection.
  const auto table = sampled_square_root(20);
  Stepper<SlopeMTable> block(1.0, table);
  for (double p = 0.001; p < 3.6; p += 0.0173) {
    std::size_t i = 0;
    while (table.P_TABLE[i + 1] < p) {
      ++i;
    }
    const double share = (p - table.P_TABLE[i]) / (table.P_TABLE[i + 1] - table.P_TABLE[i]);
    const double expected = std::lerp(table.M_TABLE[i], table.M_TABLE[i + 1], share);
    EXPECT_NEAR(block({.XIN = -2.0, .P = p, .R1 = false}).XOUT, -2.0 * expected, 1e-14);
  }
}

TEST(SlopeMTableInverse, UndoesTheTable) {
  const auto table = sampled_square_root(32);
  Stepper<SlopeMTable> forward(1.0, table);
  Stepper<SlopeMTableInverse> inverse(1.0, table);
  RandomIo random(4, 1.0);
  for (int k = 0; k < 1000; ++k) {
    const double u = random.unit() - 0.5;
    const double p = 12.0 * random.unit() - 1.0;
    const auto out = inverse({.XIN = forward({.XIN = u, .P = p, .R1 = false}).XOUT, .P = p, .R1 = false});
    EXPECT_NEAR(out.XOUT, u, 4e-16 * std::fabs(u));
    EXPECT_FALSE(out.ERROR);
  }
}

TEST(SlopeMTable, SaysThatItsPointsDoNotRise) {
  auto table = sampled_square_root(5);
  std::swap(table.P_TABLE[2], table.P_TABLE[3]);
  const auto forward = Stepper<SlopeMTable>(1.0, table)({.XIN = 1.0, .P = 0.1, .R1 = false});
  EXPECT_EQ(forward.XOUT, 0.0);
  EXPECT_TRUE(forward.ERROR);
  EXPECT_EQ(forward.ERRORID, fault::points_not_rising);
  const auto inverse = Stepper<SlopeMTableInverse>(1.0, table)({.XIN = 1.0, .P = 0.1, .R1 = false});
  EXPECT_EQ(inverse.XOUT, 0.0);
  EXPECT_TRUE(inverse.ERROR);
  EXPECT_EQ(inverse.ERRORID, fault::points_not_rising);
}

TEST(SlopeMTableInverse, SaysWhereTheTableIsNotPositive) {
  auto table = sampled_square_root(3);
  table.M_TABLE = {1.0, 0.5, -0.5};
  Stepper<SlopeMTableInverse> block(1.0, table);
  EXPECT_FALSE(block({.XIN = 1.0, .P = 0.0, .R1 = false}).ERROR);
  const auto out = block({.XIN = 1.0, .P = 1.0, .R1 = false});
  EXPECT_TRUE(out.ERROR);
  EXPECT_EQ(out.ERRORID, fault::slope_not_positive);
  EXPECT_EQ(out.XOUT, 0.0);
}

}  // namespace
}  // namespace hysteron::testing
