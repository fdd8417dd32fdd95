// The references: their curves, and that their time does not drift.
#include <gtest/gtest.h>

#include <cmath>

#include "blocks/ramp.hpp"
#include "blocks/sine_wave.hpp"
#include "blocks/step_reference.hpp"
#include "blocks/triangle_wave.hpp"
#include "tests/blocks/stepper.hpp"

namespace hysteron::testing {
namespace {

constexpr long double two_pi = 6.283185307179586476925286766559L;

TEST(SineWave, PhaseDoesNotDriftOverAHundredMillionSteps) {
  // F·TS is no short binary fraction, so that every addition rounds.
  const double ts = 5e-5;
  auto params = presets<SineWave::Params<double>>();
  params.FREQUENCY = 137.3;
  SineWave::State<double> state = SineWave::initial(params);
  const SineWave::In<double> in{.RUN = true};
  const int count = 100'000'000;
  for (int k = 0; k < count; ++k) {
    SineWave::update(params, state, in, {.XOUT = 0.0}, ts);
  }
  const long double turns = static_cast<long double>(params.FREQUENCY * ts) * count;
  const auto exact = static_cast<double>(std::sin(two_pi * (turns - std::floor(turns))));
  EXPECT_NEAR(SineWave::output(params, state, in, ts).XOUT, exact, 1e-12);
}

TEST(SineWave, PhaseDoesNotDriftInSinglePrecisionEither) {
  const float ts = 1e-3F;
  auto params = presets<SineWave::Params<float>>();
  params.FREQUENCY = 1.7F;
  SineWave::State<float> state = SineWave::initial(params);
  const SineWave::In<float> in{.RUN = true};
  const int count = 10'000'000;
  for (int k = 0; k < count; ++k) {
    SineWave::update(params, state, in, {.XOUT = 0.0F}, ts);
  }
  const double turns = static_cast<double>(params.FREQUENCY * ts) * count;
  const double exact = std::sin(static_cast<double>(two_pi) * (turns - std::floor(turns)));
  EXPECT_NEAR(SineWave::output(params, state, in, ts).XOUT, exact, 1e-5);
}

TEST(SineWave, IsTheSineOfItsParameters) {
  const double ts = 1e-3;
  Stepper<SineWave> wave(ts, {.AMPLITUDE = 3.0, .FREQUENCY = 7.0, .PHASE = 0.25, .OFFSET = -1.0});
  for (int k = 0; k < 5000; ++k) {
    EXPECT_NEAR(wave({.RUN = true}).XOUT, -1.0 + 3.0 * std::cos(static_cast<double>(two_pi) * 7.0 * ts * k), 1e-11);
  }
}

TEST(SineWave, StopsAtItsOffsetAndStartsAgain) {
  Stepper<SineWave> wave(1e-3, {.AMPLITUDE = 3.0, .FREQUENCY = 7.0, .PHASE = 0.1, .OFFSET = 2.0});
  const double first = wave({.RUN = true}).XOUT;
  const double second = wave({.RUN = true}).XOUT;
  EXPECT_EQ(wave({.RUN = false}).XOUT, 2.0);
  EXPECT_EQ(wave({.RUN = true}).XOUT, first);
  EXPECT_EQ(wave({.RUN = true}).XOUT, second);
}

TEST(SineWave, ChangeOfFrequencyDoesNotJump) {
  const double ts = 1e-4;
  Stepper<SineWave> wave(ts);
  double before = 0.0;
  for (int k = 0; k < 20000; ++k) {
    wave.params.FREQUENCY = 1.0 + 1e-3 * k;
    const double x = wave({.RUN = true}).XOUT;
    EXPECT_LE(std::abs(x - before), static_cast<double>(two_pi) * wave.params.FREQUENCY * ts * 1.001);
    before = x;
  }
}

TEST(TriangleWave, HasConstantRateAndTheCornersOfASine) {
  const int period = 400;
  const double ts = 1.0 / 1024.0;
  Stepper<TriangleWave> wave(ts, {.AMPLITUDE = 2.0, .FREQUENCY = 1024.0 / period, .PHASE = 0.0, .OFFSET = 5.0});
  for (int k = 0; k < 4000; ++k) {
    const int place = k % period;
    const double shape = place <= 100 ? place / 100.0 : (place <= 300 ? 2.0 - place / 100.0 : place / 100.0 - 4.0);
    EXPECT_NEAR(wave({.RUN = true}).XOUT, 5.0 + 2.0 * shape, 1e-12) << k;
  }
}

TEST(TriangleWave, NegativePhaseStartsEarlier) {
  Stepper<TriangleWave> wave(0.01, {.AMPLITUDE = 1.0, .FREQUENCY = 1.0, .PHASE = -0.25, .OFFSET = 0.0});
  for (int k = 0; k <= 50; ++k) {
    EXPECT_NEAR(wave({.RUN = true}).XOUT, -1.0 + k / 25.0, 1e-13);
  }
}

TEST(StepReference, JumpsInTheStepOfItsTime) {
  for (int n = 0; n < 3000; ++n) {
    const double ts = 5e-5;
    Stepper<StepReference> step(ts, {.X0 = -1.0, .X1 = 4.0, .T0 = n * ts});
    step.state.COUNT = n - 1;  // the step before the jump
    if (n > 0) {
      EXPECT_EQ(step({.RUN = true}).XOUT, -1.0) << n;
    } else {
      step.state.COUNT = 0;
    }
    EXPECT_EQ(step({.RUN = true}).XOUT, 4.0) << n;
  }
}

TEST(StepReference, StopReturnsToTheStart) {
  Stepper<StepReference> step(1.0, {.X0 = 0.0, .X1 = 1.0, .T0 = 2.0});
  const bool run[] = {true, true, true, false, true, true, true, true};
  const double expected[] = {0, 0, 1, 0, 0, 0, 1, 1};
  for (int k = 0; k < 8; ++k) {
    EXPECT_EQ(step({.RUN = run[k]}).XOUT, expected[k]) << k;
  }
}

TEST(Ramp, IsAStraightLineFromTheRiseOfRun) {
  const double ts = 5e-5;
  const int n = 2000;
  Stepper<Ramp> ramp(ts);
  EXPECT_EQ(ramp({.RUN = false, .X0 = 2.0, .X1 = 5.0, .TR = n * ts}).XOUT, 2.0);
  for (int k = 0; k < n + 10; ++k) {
    const auto out = ramp({.RUN = true, .X0 = 2.0, .X1 = 5.0, .TR = n * ts});
    EXPECT_NEAR(out.XOUT, 2.0 + 3.0 * std::min(1.0, static_cast<double>(k) / n), 1e-14);
    EXPECT_EQ(out.BUSY, k < n);
  }
  EXPECT_EQ(ramp({.RUN = true, .X0 = 2.0, .X1 = 5.0, .TR = n * ts}).XOUT, 5.0);
  const auto out = ramp({.RUN = false, .X0 = -1.0, .X1 = 5.0, .TR = 1.0});
  EXPECT_EQ(out.XOUT, -1.0);
  EXPECT_FALSE(out.BUSY);
}

TEST(Ramp, RemembersX0AndFollowsX1) {
  Stepper<Ramp> ramp(0.25);
  EXPECT_EQ(ramp({.RUN = true, .X0 = 1.0, .X1 = 3.0, .TR = 1.0}).XOUT, 1.0);
  EXPECT_EQ(ramp({.RUN = true, .X0 = 99.0, .X1 = 3.0, .TR = 1.0}).XOUT, 1.5);
  EXPECT_EQ(ramp({.RUN = true, .X0 = 99.0, .X1 = 5.0, .TR = 1.0}).XOUT, 3.0);
}

TEST(Ramp, WithoutTimeItIsAtItsEndAtOnce) {
  Stepper<Ramp> ramp(0.25);
  const auto out = ramp({.RUN = true, .X0 = 1.0, .X1 = 3.0, .TR = 0.0});
  EXPECT_EQ(out.XOUT, 3.0);
  EXPECT_FALSE(out.BUSY);
}

}  // namespace
}  // namespace hysteron::testing
