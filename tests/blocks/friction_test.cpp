// The dry frictions beside HY_COULOMB_FRICTION: one that bends before it slides, one with a level for each direction,
// one that grows with a load.
#include "blocks/friction.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "blocks/asymmetric_friction.hpp"
#include "blocks/coulomb_friction.hpp"
#include "blocks/dahl_friction.hpp"
#include "blocks/load_friction.hpp"
#include "tests/blocks/stepper.hpp"

namespace hysteron::testing {
namespace {

constexpr double ts = 1e-3;

/// A motion that turns, rests and goes on.
double velocity(int k) {
  const double t = k * ts;
  return t > 0.7 && t < 0.8 ? 0.0 : std::sin(9.0 * t) * std::cos(2.0 * t);
}

TEST(DahlFriction, TurnsOverAlongAnExponentialOfTheTravel) {
  const double preslide = 0.004;
  Stepper<DahlFriction> block(ts, {.LEVEL = 3.0, .PRESLIDE = preslide});
  double travel = 0.0;
  double reached = 0.0;
  for (int k = 0; k < 40; ++k) {
    travel += (k == 0 ? 1.5 : 1.0) * 0.2 * ts;
    reached = 3.0 * (1.0 - std::exp(-travel / preslide));
    EXPECT_NEAR(block({.XIN = 10.0, .V = 0.2}).XOUT, 10.0 - reached, 1e-12) << k;
  }
  travel = 0.0;
  for (int k = 0; k < 40; ++k) {
    travel += (k == 0 ? 2.0 : 1.0) * 0.2 * ts;
    const double expected = -3.0 + (3.0 + reached) * std::exp(-travel / preslide);
    EXPECT_NEAR(block({.XIN = 10.0, .V = -0.2}).XOUT, 10.0 - expected, 1e-12) << k;
  }
}

TEST(DahlFriction, IsDahlsDifferentialEquation) {
  const double preslide = 0.01;
  Stepper<DahlFriction> block(ts, {.LEVEL = 1.0, .PRESLIDE = preslide});
  double z = 0.0;
  const auto v = [](double t) { return 0.3 * std::sin(9.0 * t); };
  constexpr int fine = 400;
  for (int k = 0; k < 2000; ++k) {
    for (int i = 0; i < fine; ++i) {  // z' = V·(1 − z·sgn V)/PRESLIDE by Euler, up to the end of the step
      const double now = v((k + (i + 0.5) / fine) * ts);
      z += ts / fine * now * (1.0 - z * (now < 0.0 ? -1.0 : 1.0)) / preslide;
    }
    EXPECT_NEAR(-block({.XIN = 0.0, .V = v(k * ts)}).XOUT, z, 3e-4) << k;
  }
}

TEST(DahlFriction, HoldsAtRestAndStaysWithinItsLevel) {
  Stepper<DahlFriction> block(ts, {.LEVEL = 2.0, .PRESLIDE = 1e-4});
  double before = 0.0;
  double largest = 0.0;
  for (int k = 0; k < 2000; ++k) {
    const double friction = -block({.XIN = 0.0, .V = velocity(k)}).XOUT;
    largest = std::max(largest, std::fabs(friction));
    if (k > 702 && k < 800) {
      EXPECT_EQ(friction, before);
    }
    before = friction;
  }
  EXPECT_LE(largest, 2.0);
  EXPECT_GT(largest, 1.99);
}

TEST(AsymmetricFriction, OfEqualLevelsIsCoulombFriction) {
  Stepper<AsymmetricFriction> block(ts, {.UP = 2.5, .DOWN = 2.5, .PRESLIDE = 0.01});
  Stepper<CoulombFriction> coulomb(ts, {.LEVEL = 2.5, .PRESLIDE = 0.01});
  for (int k = 0; k < 2000; ++k) {
    EXPECT_TRUE(same_bits(block({.XIN = 7.0, .V = velocity(k)}).XOUT, coulomb({.XIN = 7.0, .V = velocity(k)}).XOUT));
  }
}

TEST(AsymmetricFriction, WhileItSlidesIsCoulombFrictionAndAnOffset) {
  Stepper<AsymmetricFriction> block(ts, {.UP = 5.0, .DOWN = 2.0, .PRESLIDE = 1e-3});
  Stepper<CoulombFriction> coulomb(ts, {.LEVEL = 3.5, .PRESLIDE = 1e-3});
  int slides = 0;
  for (int k = 0; k < 2000; ++k) {
    const double friction = -block({.XIN = 0.0, .V = velocity(k)}).XOUT;
    const double symmetric = -coulomb({.XIN = 0.0, .V = velocity(k)}).XOUT;
    EXPECT_GE(friction, -2.0);
    EXPECT_LE(friction, 5.0);
    if (std::fabs(symmetric) == 3.5) {
      ++slides;
      EXPECT_NEAR(friction, symmetric + 1.5, 1e-12);
    }
  }
  EXPECT_GT(slides, 1000);
}

LoadFriction::In<double> loaded(double v, double load) {
  LoadFriction::In<double> in{};
  in.XIN = 7.0;
  in.V = v;
  in.W = load;
  return in;
}

TEST(LoadFriction, WithoutACoefficientIsCoulombFriction) {
  Stepper<LoadFriction> block(ts, {.LEVEL = 2.5, .COEFFICIENT = 0.0, .PRESLIDE = 0.01});
  Stepper<CoulombFriction> coulomb(ts, {.LEVEL = 2.5, .PRESLIDE = 0.01});
  for (int k = 0; k < 2000; ++k) {
    EXPECT_TRUE(same_bits(block(loaded(velocity(k), k)).XOUT, coulomb({.XIN = 7.0, .V = velocity(k)}).XOUT));
  }
}

TEST(LoadFriction, GrowsWithTheSizeOfTheLoad) {
  Stepper<LoadFriction> block(ts, {.LEVEL = 1.0, .COEFFICIENT = 0.25, .PRESLIDE = 1e-4});
  block(loaded(0.3, 0.0));
  EXPECT_EQ(block(loaded(0.3, 0.0)).XOUT, 6.0);
  EXPECT_EQ(block(loaded(0.3, 8.0)).XOUT, 4.0);
  EXPECT_EQ(block(loaded(0.3, -8.0)).XOUT, 4.0) << "its size alone";
  block(loaded(-0.3, 4.0));
  EXPECT_EQ(block(loaded(-0.3, 4.0)).XOUT, 9.0);
}

/// Work that an axis loses which swings as A·sin: four times its whole friction over the amplitude (Coulomb), less what
/// the bending gives back.
TEST(DahlFriction, LosesInACycleWhatCoulombFrictionLosesWhereItHardlyBends) {
  const double amplitude = 0.2;
  const double omega = 2.0 * std::numbers::pi;
  Stepper<DahlFriction> block(ts, {.LEVEL = 3.0, .PRESLIDE = 1e-5});
  double work = 0.0;
  for (int k = 0; k < 3000; ++k) {
    const double v = amplitude * omega * std::cos(omega * k * ts);
    work += k < 1000 ? 0.0 : -block({.XIN = 0.0, .V = v}).XOUT * v * ts / 2.0;
  }
  EXPECT_NEAR(work, 4.0 * 3.0 * amplitude, 0.02 * work);
}

}  // namespace
}  // namespace hysteron::testing
