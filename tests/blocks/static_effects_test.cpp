// The effects without memory, and that every effect that adds a term leaves its input alone at the neutral setting.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <cstddef>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "blocks/absolute_sensor.hpp"
#include "blocks/asymmetric_friction.hpp"
#include "blocks/clock.hpp"
#include "blocks/cogging.hpp"
#include "blocks/coulomb_friction.hpp"
#include "blocks/creep.hpp"
#include "blocks/cross_coupling.hpp"
#include "blocks/cutout.hpp"
#include "blocks/cyclic_error.hpp"
#include "blocks/cyclic_force.hpp"
#include "blocks/dahl_friction.hpp"
#include "blocks/drift.hpp"
#include "blocks/even_nonlinearity.hpp"
#include "blocks/gain_drift.hpp"
#include "blocks/held.hpp"
#include "blocks/load.hpp"
#include "blocks/load_friction.hpp"
#include "blocks/odd_nonlinearity.hpp"
#include "blocks/offset.hpp"
#include "blocks/periodic_disturbance.hpp"
#include "blocks/periodic_error.hpp"
#include "blocks/relaxation.hpp"
#include "blocks/saturating_curve.hpp"
#include "blocks/scheduled_gain.hpp"
#include "blocks/stribeck_friction.hpp"
#include "blocks/thermal_drift.hpp"
#include "blocks/valve_stiction.hpp"
#include "blocks/viscous_friction.hpp"
#include "tests/blocks/neutral_run.hpp"
#include "tests/blocks/random_io.hpp"
#include "tests/blocks/stepper.hpp"

namespace hysteron::testing {
namespace {

TEST(NeutralTerm, LeavesEvenTheSignOfAZero) {
  for (const About& about : {Offset::about,
                             Drift::about,
                             ThermalDrift::about,
                             GainDrift::about,
                             Creep::about,
                             Relaxation::about,
                             CoulombFriction::about,
                             StribeckFriction::about,
                             ViscousFriction::about,
                             Cogging::about,
                             PeriodicError::about,
                             EvenNonlinearity::about,
                             OddNonlinearity::about,
                             PeriodicDisturbance::about,
                             CrossCoupling::about,
                             Load::about,
                             Clock::about,
                             DahlFriction::about,
                             AsymmetricFriction::about,
                             LoadFriction::about,
                             ValveStiction::about,
                             CyclicForce::about,
                             CyclicError::about,
                             SaturatingCurve::about,
                             AbsoluteSensor::about,
                             ScheduledGain::about,
                             Cutout::about,
                             Held::about}) {
    SCOPED_TRACE(std::string(about.name));
    NeutralRun run(about.name, 5e-5);
    RandomIo random(3, 5e-5);
    for (int k = 0; k < 2000; ++k) {
      const auto in = random.numbers(run.inputs());  // second signals too are at work
      const double x =
          k % 7 == 0 ? -0.0 : (k % 11 == 0 ? 0.0 : (random.unit() - 0.5) * std::pow(10.0, 40.0 * random.unit()));
      const double y = run.step(in, x);
      if (about.name == Clock::about.name) {
        EXPECT_EQ(y, x);  // newer + 0·(older − newer), as HY_DEAD_TIME: a zero may lose its sign
      } else {
        EXPECT_TRUE(same_bits(y, x)) << "step " << k << ", XIN " << x;
      }
    }
  }
}

TEST(Offset, IsAdded) {
  Stepper<Offset> block(1.0, {.BIAS = -0.25});
  EXPECT_EQ(block({.XIN = 3.0}).XOUT, 2.75);
}

TEST(Nonlinearity, HasItsSizeAtTheReferenceAndItsParity) {
  Stepper<EvenNonlinearity> even(1.0, {.SIZE = 0.5, .CENTRE = 1.0, .REFERENCE = 2.0});
  Stepper<OddNonlinearity> odd(1.0, {.SIZE = 0.5, .CENTRE = 1.0, .REFERENCE = 2.0});
  EXPECT_EQ(even({.XIN = 3.0}).XOUT, 3.5);
  EXPECT_EQ(odd({.XIN = 3.0}).XOUT, 3.5);
  for (double d = 0.0; d < 5.0; d += 0.1) {
    const double up = even({.XIN = 1.0 + d}).XOUT - (1.0 + d);
    EXPECT_NEAR(even({.XIN = 1.0 - d}).XOUT - (1.0 - d), up, 1e-14);
    EXPECT_NEAR(up, 0.5 * std::pow(d / 2.0, 2.0), 1e-14);
    const double right = odd({.XIN = 1.0 + d}).XOUT - (1.0 + d);
    EXPECT_NEAR(odd({.XIN = 1.0 - d}).XOUT - (1.0 - d), -right, 1e-13);
    EXPECT_NEAR(right, 0.5 * std::pow(d / 2.0, 3.0), 1e-13);
  }
}

TEST(PeriodicError, IsTheRealPartOfAComplexHarmonic) {
  const double pitch = 0.02;
  Stepper<PeriodicError> block(1.0, {.SINE = 0.3, .COSINE = -0.4, .PITCH = pitch});
  for (double x = -1.0; x < 1.0; x += 0.00137) {
    const auto turned = std::complex<double>(-0.4, -0.3) * std::polar(1.0, 2.0 * std::acos(-1.0) * x / pitch);
    EXPECT_NEAR(block({.XIN = x}).XOUT - x, turned.real(), 1e-12);
  }
  EXPECT_NEAR(block({.XIN = 1e5 * pitch}).XOUT - 1e5 * pitch, -0.4, 1e-9) << "whole turns are taken off";
}

TEST(CyclicError, IsTheRealPartOfItsComplexHarmonics) {
  CyclicError::Params<double> params{};
  params.PITCH = 0.5;
  params.SINE = 0.3;
  params.COSINE = -0.4;
  params.SINE2 = -0.2;
  params.COSINE2 = 0.1;
  params.SINE3 = 0.05;
  params.COSINE3 = 0.25;
  params.SINE4 = 0.15;
  params.COSINE4 = -0.1;
  const std::vector<std::complex<double>> harmonics{{-0.4, -0.3}, {0.1, 0.2}, {0.25, -0.05}, {-0.1, -0.15}};
  Stepper<CyclicError> block(1.0, params);
  Stepper<CyclicForce> force(1.0, {});
  const auto copy = [&](auto member, auto of) { force.params.*member = params.*of; };
  using Force = CyclicForce::Params<double>;
  using Error = CyclicError::Params<double>;
  copy(&Force::PITCH, &Error::PITCH);
  copy(&Force::SINE, &Error::SINE);
  copy(&Force::COSINE, &Error::COSINE);
  copy(&Force::SINE2, &Error::SINE2);
  copy(&Force::COSINE2, &Error::COSINE2);
  copy(&Force::SINE3, &Error::SINE3);
  copy(&Force::COSINE3, &Error::COSINE3);
  copy(&Force::SINE4, &Error::SINE4);
  copy(&Force::COSINE4, &Error::COSINE4);
  const auto expected = [&](double x) {
    std::complex<double> sum = 0.0;
    for (std::size_t n = 0; n < harmonics.size(); ++n) {
      sum += harmonics[n] * std::polar(1.0, 2.0 * std::acos(-1.0) * static_cast<double>(n + 1) * x / 0.5);
    }
    return sum.real();
  };
  double before = 0.0;
  for (double x = -1.0; x < 1.0; x += 0.0137) {
    EXPECT_NEAR(block({.XIN = x}).XOUT - x, expected(x), 1e-12);
    EXPECT_NEAR(force({.XIN = 5.0, .POS = x}).XOUT - 5.0, expected(before), 1e-12) << "of the step before";
    before = x;
  }
}

TEST(SaturatingCurve, IsAHyperbolicTangent) {
  for (const double bend : {1e-9, 1e-4, 0.1, 1.0, 9.0}) {
    Stepper<SaturatingCurve> block(1.0, {.BEND = bend, .CENTRE = 0.5, .REFERENCE = 2.0});
    for (double d = -8.0; d <= 8.0; d += 0.01) {
      const double limit = 2.0 / std::sqrt(bend);
      EXPECT_NEAR(block({.XIN = 0.5 + d}).XOUT, 0.5 + limit * std::tanh(d / limit), 4e-15 * (1.0 + std::fabs(d)))
          << bend << ", " << d;
    }
  }
}

TEST(SaturatingCurve, BeginsWithACubeAndEndsAtItsLimit) {
  Stepper<SaturatingCurve> block(1.0, {.BEND = 1e-4, .CENTRE = 0.0, .REFERENCE = 3.0});
  EXPECT_NEAR(block({.XIN = 3.0}).XOUT, 3.0 - 1e-4, 2e-8) << "BEND/3 of REFERENCE";
  block.params.BEND = 4.0;
  EXPECT_NEAR(block({.XIN = 1e6}).XOUT, 1.5, 1e-9);
  EXPECT_NEAR(block({.XIN = -1e6}).XOUT, -1.5, 1e-9);
}

TEST(AbsoluteSensor, ShowsTheSizeAndItsShareOfTheSign) {
  Stepper<AbsoluteSensor> blind(1.0, {.SHARE = 1.0});
  Stepper<AbsoluteSensor> half(1.0, {.SHARE = 0.5});
  EXPECT_EQ(blind({.XIN = -3.0}).XOUT, 3.0);
  EXPECT_EQ(blind({.XIN = 2.0}).XOUT, 2.0);
  EXPECT_EQ(half({.XIN = -3.0}).XOUT, 0.0);
  EXPECT_EQ(half({.XIN = 2.0}).XOUT, 2.0);
}

TEST(ScheduledGain, IsMovedByAnotherSignal) {
  Stepper<ScheduledGain> block(1.0, {.SHARE = 0.25, .Z_REFERENCE = 2.0});
  EXPECT_EQ(block({.XIN = 8.0, .Z = 2.0}).XOUT, 8.0);
  EXPECT_EQ(block({.XIN = 8.0, .Z = 4.0}).XOUT, 12.0);
  EXPECT_EQ(block({.XIN = 8.0, .Z = -2.0}).XOUT, 0.0);
  EXPECT_EQ(block({.XIN = 0.0, .Z = 9.0}).XOUT, 0.0);
}

TEST(Cogging, SeesThePositionOfTheStepBefore) {
  Stepper<Cogging> block(1.0, {.SINE = 2.0, .COSINE = 0.5, .PITCH = 4.0});
  EXPECT_NEAR(block({.XIN = 10.0, .POS = 1.0}).XOUT, 10.5, 1e-15) << "it begins with 0";
  EXPECT_NEAR(block({.XIN = 20.0, .POS = 2.0}).XOUT, 22.0, 1e-15);
  EXPECT_NEAR(block({.XIN = 30.0, .POS = 0.0}).XOUT, 29.5, 1e-14);
}

}  // namespace
}  // namespace hysteron::testing
