// Creep, relaxation, cross coupling and friction against closed forms and finely stepped differential equations.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "blocks/coulomb_friction.hpp"
#include "blocks/creep.hpp"
#include "blocks/cross_coupling.hpp"
#include "blocks/lag.hpp"
#include "blocks/relaxation.hpp"
#include "blocks/stribeck_friction.hpp"
#include "blocks/viscous_friction.hpp"
#include "tests/blocks/random_io.hpp"
#include "tests/blocks/stepper.hpp"

namespace hysteron::testing {
namespace {

TEST(Creep, IsTheLogarithmOverFiveDecades) {
  // From rest at 0 a step at t = 0. Wide samples see late times, narrow ones early times.
  const double onset = 0.1;
  for (const double ts : {1e-4, 1e-2, 1.0}) {
    Stepper<Creep> block(ts, {.GAIN = 0.02, .T_ONSET = onset, .SETTLED = false, .SINCE_START = false});
    for (int k = 0; k < 10'000; ++k) {
      const double t = k * ts;
      const double decades = (block({.XIN = 3.0}).XOUT / 3.0 - 1.0) / 0.02;
      EXPECT_NEAR(decades, std::log10(1.0 + t / onset), t < 3000.0 * onset ? 0.0004 : 0.0045) << "t " << t;
    }
  }
}

TEST(Creep, IsLinearInThePastInput) {
  // A step up at 0 and down at 2 s: the sum of both steps' logarithms; the later step begins over one sample.
  const double ts = 1e-3;
  const double onset = 0.2;
  Stepper<Creep> block(ts, {.GAIN = 0.1, .T_ONSET = onset, .SETTLED = false, .SINCE_START = false});
  for (int k = 0; k < 20'000; ++k) {
    const double t = k * ts;
    const double x = k < 2000 ? 1.0 : 0.0;
    double crept = std::log10(1.0 + t / onset);
    if (k >= 2000) {
      crept -= std::log10(1.0 + (t - 2.0 + 0.5 * ts) / onset);
    }
    EXPECT_NEAR(block({.XIN = x}).XOUT, x + 0.1 * crept, 0.1 * 0.001) << "t " << t;
  }
}

TEST(Creep, StartsSettled) {
  Stepper<Creep> block(0.01, {.GAIN = 0.01, .T_ONSET = 0.1, .SETTLED = true, .SINCE_START = false});
  const double first = block({.XIN = 5.0}).XOUT;
  EXPECT_NEAR(first, 5.0 * (1.0 + 0.01 * 5.7714), 1e-5) << "all of it has crept";
  for (int k = 0; k < 100; ++k) {
    EXPECT_EQ(block({.XIN = 5.0}).XOUT, first);
  }
}

TEST(Creep, SinceTheStartIsTheLogarithmOfTheStepsAfterIt) {
  // At rest at 5 from before the record; a step of 2 at 1 s creeps by itself, over one sample.
  const double ts = 1e-2;
  Stepper<Creep> block(ts, {.GAIN = 0.1, .T_ONSET = 0.2, .SETTLED = true, .SINCE_START = true});
  for (int k = 0; k < 2000; ++k) {
    const double t = k * ts;
    const double expected = k < 100 ? 5.0 : 7.0 + 0.2 * std::log10(1.0 + (t - 1.0 + 0.5 * ts) / 0.2);
    EXPECT_NEAR(block({.XIN = k < 100 ? 5.0 : 7.0}).XOUT, expected, k < 100 ? 1e-14 : 0.2 * 0.001) << "t " << t;
  }
}

TEST(Relaxation, SinceTheStartLeavesOutWhatHasFollowedBefore) {
  const double ts = 0.01;
  Stepper<Relaxation> whole(ts, {.GAIN = 0.3, .T1 = 0.09, .SETTLED = true, .SINCE_START = false});
  Stepper<Relaxation> since(ts, {.GAIN = 0.3, .T1 = 0.09, .SETTLED = true, .SINCE_START = true});
  RandomIo random(5, ts);
  for (int k = 0; k < 300; ++k) {
    const double x = k == 0 ? 4.0 : 10.0 * random.unit();
    EXPECT_NEAR(since({.XIN = x}).XOUT, whole({.XIN = x}).XOUT - 0.3 * 4.0, 1e-14 * 20.0);
  }
}

TEST(Relaxation, AStepApproachesItsEndExponentially) {
  const double ts = 0.01;
  Stepper<Relaxation> block(ts, {.GAIN = 0.3, .T1 = 0.37, .SETTLED = false, .SINCE_START = false});
  for (int k = 0; k < 300; ++k) {
    EXPECT_NEAR(block({.XIN = 2.0}).XOUT, 2.0 * (1.0 + 0.3 * (1.0 - std::exp(-k * ts / 0.37))), 1e-13);
  }
}

TEST(Relaxation, IsTheInputAndItsLag) {
  const double ts = 0.01;
  Stepper<Relaxation> block(ts, {.GAIN = -0.2, .T1 = 0.09, .SETTLED = true, .SINCE_START = false});
  Stepper<Lag> lag(ts, {.T1 = 0.09, .SETTLED = true});
  RandomIo random(4, ts);
  for (int k = 0; k < 300; ++k) {
    const double x = 10.0 * random.unit();
    EXPECT_NEAR(block({.XIN = x}).XOUT, x - 0.2 * lag({.XIN = x, .R1 = false, .X0 = 0.0}).XOUT, 1e-12);
  }
}

TEST(CrossCoupling, IsAFinelySteppedLagOfTheStepBefore) {
  const double ts = 0.01;
  const double t1 = 0.13;
  Stepper<CrossCoupling> block(ts, {.GAIN = 0.5, .T1 = t1, .Z_REFERENCE = 0.0});
  const auto other = [](double t) { return 3.0 + std::sin(2.0 * t); };
  double z = other(0.0);
  EXPECT_EQ(block({.XIN = 1.0, .Z = other(0.0)}).XOUT, 1.0) << "nothing is known of Z yet";
  for (int k = 1; k < 500; ++k) {
    EXPECT_NEAR(block({.XIN = 1.0, .Z = other(k * ts)}).XOUT, 1.0 + 0.5 * z, 1e-4);
    for (int j = 0; j < 100; ++j) {
      z += ts / 100 * (other((k - 1) * ts + (j + 0.5) * ts / 100) - z) / t1;
    }
  }
}

TEST(CoulombFriction, IsElasticBeforeItSlides) {
  const double ts = 1e-3;
  const double preslide = 0.05;
  Stepper<CoulombFriction> block(ts, {.LEVEL = 4.0, .PRESLIDE = preslide});
  // The closed form of the stop under |x| ≤ a after the first slide: ±1 but for the travel of 2·preslide after each
  // reversal.
  const double amplitude = 0.3;
  double before = 0.0;
  double extreme = 0.0;
  bool upwards = true;
  double last = 0.0;
  double v = 0.0;
  for (int k = 0; k < 5000; ++k) {
    const double x = amplitude * std::sin(4.0 * k * ts);  // where the middle of the step is
    v = (v + 2.0 * (x - last) / ts) / 3.0;
    const double next = amplitude * std::sin(4.0 * (k + 1) * ts);
    const double travel = std::fabs(x - extreme);
    double acting = std::min(1.0, travel / preslide);
    if (before != 0.0) {
      acting = upwards ? std::min(1.0, -1.0 + travel / preslide) : std::max(-1.0, 1.0 - travel / preslide);
    }
    EXPECT_NEAR(block({.XIN = 10.0, .V = v}).XOUT, 10.0 - 4.0 * acting, 1e-10) << "step " << k;
    last = x;
    if ((next > x) != upwards) {
      extreme = x;
      upwards = next > x;
      before = 1.0;
    }
  }
}

TEST(CoulombFriction, HoldsAMassOnASlopeWithoutChatter) {
  // x'' = F − friction with |F| < LEVEL: the mass comes to rest, and its velocity does not go on changing its sign.
  const double ts = 1e-4;
  Stepper<CoulombFriction> block(ts, {.LEVEL = 2.0, .PRESLIDE = 1e-3});
  double v = 0.5;
  int reversals = 0;
  for (int k = 0; k < 40'000; ++k) {
    const double force = block({.XIN = 1.0, .V = v}).XOUT - 40.0 * v;
    const double last = v;
    v += ts * force;
    reversals += k > 30'000 && v * last < 0.0 ? 1 : 0;
  }
  EXPECT_NEAR(v, 0.0, 1e-9);
  EXPECT_NEAR(block.state.STOP, 0.5, 1e-6) << "it holds what drives it";
  EXPECT_EQ(reversals, 0);
}

TEST(CoulombFriction, StopsWhatItHolds) {
  // Held by friction alone, a unit mass follows λ² − (2 − 3a/2)·λ + 1 − a/2 = 0 with a = LEVEL·TS²/PRESLIDE: below the
  // double root of a = 16/9 it swings out by √(1 − a/2) in a step.
  const double ts = 1e-3;
  const double level = 2.0;
  for (const double a : {0.2, 1.0}) {
    Stepper<CoulombFriction> block(ts, {.LEVEL = level, .PRESLIDE = level * ts * ts / a});
    const double start = 0.1 * level * ts;  // too slow to make it slide
    block.state = {.STOP = 0.5, .V1 = start};
    double v = start;
    double envelope = start;
    double largest = 0.0;
    for (int k = 0; k < 60; ++k) {
      v += ts * block({.XIN = 0.5 * level, .V = v}).XOUT;
      envelope *= std::sqrt(1.0 - a / 2.0);
      largest = std::max(largest, std::fabs(v) / envelope);
    }
    EXPECT_GT(largest, 0.5) << a;
    EXPECT_LT(largest, 3.0) << a;
    EXPECT_NEAR(block.state.STOP, 0.5, 0.1 * envelope / start) << a;
  }
}

/// A driven mass that dry friction stops and holds, at a hundred steps a sample: where it would reverse within a step
/// it stands, and goes on where the drive exceeds the friction (D. Karnopp, J. Dyn. Syst. Meas. Control 107 (1985)
/// 100).
TEST(CoulombFriction, StopsAndHoldsADrivenMass) {
  const double ts = 1e-3;
  const double level = 15.0;
  const int fine = 100;
  Stepper<CoulombFriction> block(ts, {.LEVEL = level, .PRESLIDE = level * ts * ts});
  double v = 0.0;
  double exact = 0.0;
  double square = 0.0;
  const int steps = 4000;
  for (int k = 0; k < steps; ++k) {
    square += (v - exact) * (v - exact);
    const double drive = 40.0 * std::sin(9.0 * k * ts) * std::sin(0.8 * k * ts);
    v += ts * (block({.XIN = drive, .V = v}).XOUT - 3.0 * v);
    for (int j = 0; j < fine; ++j) {
      const double h = ts / fine;
      if (exact == 0.0) {
        exact = std::fabs(drive) > level ? h * (drive - std::copysign(level, drive)) : 0.0;
        continue;
      }
      const double next = exact + h * (drive - std::copysign(level, exact) - 3.0 * exact);
      exact = next * exact < 0.0 ? 0.0 : next;
    }
  }
  EXPECT_LT(std::sqrt(square / steps), 0.5 * level * ts) << "half of what the friction changes in a step";
}

TEST(StribeckFriction, IsTheStribeckCurveWhileSliding) {
  const double ts = 1e-3;
  for (const double v : {0.001, 0.01, 0.03, 1.0}) {
    Stepper<StribeckFriction> block(ts, {.LEVEL = 3.0, .STICTION = 0.4, .V_STRIBECK = 0.02, .PRESLIDE = 1e-4});
    double last = 0.0;
    for (int k = 0; k < 1000; ++k) {
      last = block({.XIN = 0.0, .V = -v}).XOUT;
    }
    EXPECT_NEAR(last, 3.0 * (1.0 + 0.4 * std::exp(-std::pow(v / 0.02, 2.0))), 1e-12);
  }
}

TEST(StribeckFriction, WithoutStictionIsCoulombFriction) {
  const double ts = 1e-3;
  Stepper<StribeckFriction> block(ts, {.LEVEL = 3.0, .STICTION = 0.0, .V_STRIBECK = 0.02, .PRESLIDE = 0.01});
  Stepper<CoulombFriction> coulomb(ts, {.LEVEL = 3.0, .PRESLIDE = 0.01});
  RandomIo random(9, ts);
  for (int k = 0; k < 1000; ++k) {
    const double v = 4.0 * (random.unit() - 0.5);
    EXPECT_EQ(block({.XIN = 1.0, .V = v}).XOUT, coulomb({.XIN = 1.0, .V = v}).XOUT);
  }
}

TEST(ViscousFriction, DragOfTheSquareSlowsAMassAsOneOverTime) {
  // v' = −q·v·|v|: v = v0/(1 + q·v0·t), and the same backwards.
  const double ts = 1e-4;
  for (const double start : {1.0, -1.0}) {
    Stepper<ViscousFriction> block(ts, {.COEFFICIENT = 0.0, .QUADRATIC = 3.0});
    double v = start;
    for (int k = 0; k < 10'000; ++k) {
      v += ts * block({.XIN = 0.0, .V = v}).XOUT;
    }
    EXPECT_NEAR(v, start / 4.0, 1e-4);
  }
}

TEST(ViscousFriction, SlowsAMassExponentially) {
  // v' = −c·v; a step that begins with the velocity makes v(k) = v(k−1)·(1 − c·TS) exactly.
  const double ts = 1e-4;
  Stepper<ViscousFriction> block(ts, {.COEFFICIENT = 2.0, .QUADRATIC = 0.0});
  double v = 1.0;
  for (int k = 0; k < 10'000; ++k) {
    v += ts * block({.XIN = 0.0, .V = v}).XOUT;
  }
  EXPECT_NEAR(v, std::exp(-2.0), 1e-4);
}

}  // namespace
}  // namespace hysteron::testing
