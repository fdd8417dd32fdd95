// The effects of clock time: drifts, a load, a disturbance, a clock that lags behind.
#include <gtest/gtest.h>

#include <cmath>

#include "blocks/clock.hpp"
#include "blocks/drift.hpp"
#include "blocks/gain_drift.hpp"
#include "blocks/load.hpp"
#include "blocks/periodic_disturbance.hpp"
#include "blocks/thermal_drift.hpp"
#include "tests/blocks/stepper.hpp"

namespace hysteron::testing {
namespace {

TEST(Drift, IsExactAfterAHundredMillionSteps) {
  const double ts = 5e-5;
  Drift::State<double> state = Drift::initial(Drift::Params<double>{.RATE = 1.0});
  for (int k = 0; k < 100'000'000; ++k) {
    Drift::count(state);
  }
  EXPECT_EQ(Drift::output<double>({.RATE = 0.2}, state, {.XIN = 0.0}, ts).XOUT, 0.2 * (1e8 * ts));
  EXPECT_EQ(GainDrift::output<double>({.RATE = 0.002, .SETTLING = 0.0}, state, {.XIN = 3.0}, ts).XOUT,
            3.0 + 3.0 * (0.002 * 5000.0));
}

TEST(Drift, StandsStillAtTheEndOfItsCount) {
  Stepper<Drift> block(1.0, {.RATE = 1.0});
  block.state.COUNT = 2147483647;
  EXPECT_EQ(block({.XIN = 0.0}).XOUT, 2147483647.0);
  EXPECT_EQ(block({.XIN = 0.0}).XOUT, 2147483647.0);
}

TEST(ThermalDrift, ObeysItsDifferentialEquation) {
  // T1·d' + d = SIZE from 0, by small steps of the implicit midpoint rule.
  const double ts = 0.01;
  Stepper<ThermalDrift> block(ts, {.SIZE = 2.0, .T1 = 0.7});
  double d = 0.0;
  const int fine = 200;
  const double h = ts / fine;
  for (int k = 0; k < 300; ++k) {
    EXPECT_NEAR(block({.XIN = 5.0}).XOUT, 5.0 + d, 1e-8);
    for (int j = 0; j < fine; ++j) {
      d += h * (2.0 - d) / (0.7 + 0.5 * h);
    }
  }
}

TEST(GainDrift, LeavesZeroAlone) {
  Stepper<GainDrift> block(0.5, {.RATE = 0.1, .SETTLING = 0.0});
  for (int k = 0; k < 10; ++k) {
    EXPECT_EQ(block({.XIN = 0.0}).XOUT, 0.0);
  }
  EXPECT_EQ(block({.XIN = 2.0}).XOUT, 2.0 * (1.0 + 0.1 * 5.0));
}

TEST(GainDrift, SettlesByItsDifferentialEquation) {
  // g' = RATE − SETTLING·(g − 1), by small steps of the implicit midpoint rule; from the series to the exponential.
  const double ts = 0.01;
  for (const double settling : {0.02, 0.9, 40.0}) {
    Stepper<GainDrift> block(ts, {.RATE = 0.3, .SETTLING = settling});
    double drifted = 0.0;
    const int fine = 200;
    const double h = ts / fine;
    for (int k = 0; k < 300; ++k) {
      EXPECT_NEAR(block({.XIN = 2.0}).XOUT, 2.0 * (1.0 + drifted), 1e-7) << "settling " << settling << " step " << k;
      for (int j = 0; j < fine; ++j) {
        drifted += h * (0.3 - settling * drifted) / (1.0 + 0.5 * settling * h);
      }
    }
  }
}

TEST(GainDrift, SettlesSmoothlyWhereTheSeriesEnds) {
  const auto at = [](double settling) {
    GainDrift::State<double> state = GainDrift::initial(GainDrift::Params<double>{.RATE = 1.0, .SETTLING = settling});
    GainDrift::count(state);
    return GainDrift::output<double>({.RATE = 1.0, .SETTLING = settling}, state, {.XIN = 1.0}, 1.0).XOUT;
  };
  EXPECT_NEAR(at(0.01), at(std::nextafter(0.01, 0.0)), 1e-12);
}

TEST(Load, TakesOffItsMeanOverEachInterval) {
  // The second implementation: the mean over the interval before each sample, of 1000 points.
  const double ts = 0.1;
  for (const double off : {0.43, 0.58, 1.37, infinity, 0.2}) {
    Stepper<Load> block(ts, {.SIZE = 3.0, .T_ON = 0.42, .T_OFF = off});
    for (int k = 0; k < 20; ++k) {
      double mean = 0.0;
      for (int j = 0; j < 1000; ++j) {
        const double t = (k - 1) * ts + (j + 0.5) * ts / 1000;
        mean += t > 0.42 && t <= off ? 3.0 / 1000 : 0.0;
      }
      EXPECT_NEAR(block({.XIN = 7.0}).XOUT, 7.0 - mean, 1e-9) << "off " << off << " step " << k;
    }
  }
}

TEST(PeriodicDisturbance, DoesNotDriftOverAHundredMillionSteps) {
  const double ts = 5e-5;
  const PeriodicDisturbance::Params<double> params{.SINE = 2.0, .COSINE = 0.5, .FREQUENCY = 137.3};
  auto state = PeriodicDisturbance::initial(params);
  const int count = 100'000'000;
  for (int k = 0; k < count; ++k) {
    PeriodicDisturbance::update<double>(params, state, {.XIN = 0.0}, {.XOUT = 0.0}, ts);
  }
  const long double turns = static_cast<long double>(params.FREQUENCY * ts) * count;
  const long double angle = 2.0L * std::acos(-1.0L) * (turns - std::floor(turns));
  const auto exact = static_cast<double>(2.0L * std::sin(angle) + 0.5L * std::cos(angle));
  EXPECT_NEAR(PeriodicDisturbance::output<double>(params, state, {.XIN = 10.0}, ts).XOUT, 10.0 + exact, 1e-11);
}

TEST(Clock, ShowsTheSignalAsItWas) {
  // A signal that runs straight between samples is shown exactly wherever the clock looks.
  const double ts = 1e-3;
  Stepper<Clock> block(ts, {.SKEW = 0.013, .LOST = 0.0205, .T_LOST = 0.5});
  const auto signal = [](double t) { return t <= 0.0 ? 1.0 : 1.0 + 3.0 * t; };
  for (int k = 0; k < 1500; ++k) {
    const double t = k * ts;
    const auto out = block({.XIN = signal(t)});
    const double seen = t - 0.013 * t - (t > 0.5 + 0.5 * ts ? 0.0205 : 0.0);
    EXPECT_NEAR(out.XOUT, signal(seen), 1e-12) << "step " << k;
    EXPECT_FALSE(out.ERROR);
  }
}

TEST(Clock, ThatRunsFastGoesOnAtTheRateOfTheLastSample) {
  const double ts = 0.01;
  const double skew = -0.004;
  Stepper<Clock> block(ts, {.SKEW = skew, .LOST = 0.0, .T_LOST = 0.0});
  const auto signal = [](double t) { return std::sin(1.3 * t); };
  EXPECT_EQ(block({.XIN = signal(0.0)}).XOUT, signal(0.0));
  for (int k = 1; k < 1500; ++k) {
    const double t = k * ts;
    const double ahead = -skew * t;
    // What a straight line misses: half the curvature, over what is ahead and the sample before.
    EXPECT_NEAR(block({.XIN = signal(t)}).XOUT, signal(t + ahead), 0.5 * 1.3 * 1.3 * ahead * (ahead + ts) + 1e-12);
  }
}

TEST(Clock, LosesSamplesAsARecordWithAHoleDoes) {
  // A record of which 17 samples were dropped, and shown as if it had none missing.
  Stepper<Clock> block(0.01, {.SKEW = 0.0, .LOST = 0.17, .T_LOST = 1.0});
  for (int k = 0; k < 400; ++k) {
    const double x = std::sin(0.1 * k * k);
    const double shown = k > 100 ? std::sin(0.1 * (k - 17.0) * (k - 17.0)) : x;
    EXPECT_NEAR(block({.XIN = x}).XOUT, shown, 1e-11) << "step " << k;
  }
}

TEST(Clock, HoldsAtTheEndOfItsMemoryWithAnError) {
  Stepper<Clock> block(1.0, {.SKEW = 0.5, .LOST = 0.0, .T_LOST = 0.0});
  for (int k = 0; k < 3000; ++k) {
    const auto out = block({.XIN = static_cast<double>(k)});
    EXPECT_EQ(out.ERROR, k > 2048);
    EXPECT_EQ(out.ERRORID, k > 2048 ? fault::dead_time_too_long : 0);
    EXPECT_EQ(out.XOUT, k > 2048 ? k - 1024.0 : 0.5 * k);
  }
}

}  // namespace
}  // namespace hysteron::testing
