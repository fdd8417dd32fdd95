// The derivatives: delay and gain measured with sinusoids, and the first samples.
#include "blocks/derivative.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "blocks/derivative4.hpp"
#include "blocks/derivative_filtered.hpp"
#include "tests/blocks/stepper.hpp"

namespace hysteron::testing {
namespace {

constexpr double derivative_ts = 1e-3;

/// The response to e^(jwk) relative to the ideal derivative, jw/TS: real and imaginary part are measured by a cosine
/// and a sine, after `settle` samples.
template <class B>
std::complex<double> relative_response(Stepper<B> block, double w, int settle) {
  Stepper<B> other = block;
  std::complex<double> last;
  for (int k = 0; k <= settle; ++k) {
    last = {block({.XIN = std::cos(w * k), .RUN = true}).XOUT, other({.XIN = std::sin(w * k), .RUN = true}).XOUT};
  }
  return last / std::polar(1.0, w * settle) / std::complex<double>(0.0, w / derivative_ts);
}

TEST(Derivative, DelayAndGainAreAsStated) {
  for (const double w : {0.01, 0.1, 0.5, 1.0, 2.0, 3.0}) {
    const auto response = relative_response(Stepper<Derivative>(derivative_ts), w, 10);
    EXPECT_NEAR(std::abs(response), std::sin(w / 2) / (w / 2), 1e-12);
    EXPECT_NEAR(-std::arg(response) / w, 0.5, 1e-9) << "delay in samples";
  }
  EXPECT_NEAR(std::abs(relative_response(Stepper<Derivative>(derivative_ts), 1.0, 10)), 0.96, 0.005);
}

TEST(Derivative4, DelayAndGainAreAsStated) {
  for (const double w : {0.01, 0.1, 0.5, 1.0, 2.0}) {
    const auto response = relative_response(Stepper<Derivative4>(derivative_ts), w, 10);
    EXPECT_NEAR(std::abs(response), (3.0 * std::sin(1.5 * w) + std::sin(w / 2)) / (5.0 * w), 1e-12);
    EXPECT_NEAR(-std::arg(response) / w, 1.5, 1e-9) << "delay in samples";
  }
  EXPECT_NEAR(std::abs(relative_response(Stepper<Derivative4>(derivative_ts), 1.0, 10)), 0.69, 0.005);
}

TEST(DerivativeFiltered, DelayAndGainAreAsStated) {
  for (const double t1 : {0.0, 0.2 * derivative_ts, derivative_ts, 5.0 * derivative_ts, 20.0 * derivative_ts}) {
    const double a = t1 > 0.0 ? std::exp(-derivative_ts / t1) : 0.0;
    for (const double w : {0.01, 0.1, 0.5, 1.0, 2.0}) {
      const auto response = relative_response(Stepper<DerivativeFiltered>(derivative_ts, {.T1 = t1}), w, 1500);
      const double gain = std::sin(w / 2) / (w / 2) * (1.0 - a) / std::sqrt(1.0 - 2.0 * a * std::cos(w) + a * a);
      EXPECT_NEAR(std::abs(response), gain, 1e-10) << "T1 " << t1 << ", w " << w;
    }
    const double w = 1e-3;
    const double delay =
        -std::arg(relative_response(Stepper<DerivativeFiltered>(derivative_ts, {.T1 = t1}), w, 1500)) / w;
    EXPECT_NEAR(delay, 0.5 + a / (1.0 - a), 1e-2) << "T1 " << t1;
    if (t1 >= derivative_ts) {
      EXPECT_NEAR(delay * derivative_ts, t1 + derivative_ts * derivative_ts / (12.0 * t1), 0.01 * t1);
    }
  }
}

TEST(DerivativeFiltered, FollowsAPolygonExactly) {
  // x runs with slope 1 for 50 samples, then stands: D = 1 − e^(−t/T), then falls by e^(−t/T).
  const double t1 = 7.3 * derivative_ts;
  Stepper<DerivativeFiltered> block(derivative_ts, {.T1 = t1});
  for (int k = 0; k < 200; ++k) {
    const double t = k * derivative_ts;
    const double corner = 50 * derivative_ts;
    const double expected =
        t <= corner ? 1.0 - std::exp(-t / t1) : (1.0 - std::exp(-corner / t1)) * std::exp(-(t - corner) / t1);
    EXPECT_NEAR(block({.XIN = std::min(t, corner), .RUN = true}).XOUT, expected, 1e-12) << "step " << k;
  }
}

TEST(DerivativeFiltered, WithoutTimeConstantIsTheTwoPointDerivative) {
  Stepper<DerivativeFiltered> filtered(derivative_ts, {.T1 = 0.0});
  Stepper<Derivative> two_point(derivative_ts);
  for (int k = 0; k < 100; ++k) {
    const double x = std::sin(0.3 * k);
    EXPECT_NEAR(filtered({.XIN = x, .RUN = true}).XOUT, two_point({.XIN = x, .RUN = true}).XOUT, 1e-12 / derivative_ts);
  }
}

TEST(Derivative, StartsAtZeroAwayFromZero) {
  Stepper<Derivative> block(derivative_ts);
  EXPECT_EQ(block({.XIN = 5.0, .RUN = true}).XOUT, 0.0);
  EXPECT_NEAR(block({.XIN = 5.001, .RUN = true}).XOUT, 1.0, 1e-9);
}

TEST(Derivative4, ARampRunsInAsTheStandardSays) {
  Stepper<Derivative4> block(1.0);
  const auto expect_run_in = [&](double from) {
    for (const double expected : {0.3, 0.7, 1.0, 1.0}) {
      from += 1.0;
      EXPECT_NEAR(block({.XIN = from, .RUN = true}).XOUT, expected, 1e-12);
    }
  };
  EXPECT_EQ(block({.XIN = 40.0, .RUN = true}).XOUT, 0.0) << "the first sample is the history";
  expect_run_in(40.0);
  EXPECT_EQ(block({.XIN = 80.0, .RUN = false}).XOUT, 0.0);
  expect_run_in(80.0);
}

TEST(Derivative4, PassesATenthOfTheNoise) {
  // Variance of white noise: the squares of the weights, (9 + 1 + 1 + 9)/100 against 1 + 1.
  double variance4 = 0.0;
  double variance2 = 0.0;
  Stepper<Derivative4> four(1.0);
  Stepper<Derivative> two(1.0);
  for (int k = 0; k < 12; ++k) {
    const double pulse = k == 4 ? 1.0 : 0.0;
    variance4 += std::pow(four({.XIN = pulse, .RUN = true}).XOUT, 2);
    variance2 += std::pow(two({.XIN = pulse, .RUN = true}).XOUT, 2);
  }
  EXPECT_NEAR(variance4 / variance2, 0.1, 1e-12);
}

TEST(Derivative, RunFalseGivesZeroAndKeepsTheHistory) {
  Stepper<Derivative> block(1.0);
  block({.XIN = 0.0, .RUN = true});
  EXPECT_EQ(block({.XIN = 10.0, .RUN = false}).XOUT, 0.0);
  EXPECT_EQ(block({.XIN = 12.0, .RUN = true}).XOUT, 2.0) << "no jump from before the pause";
}

TEST(DerivativeFiltered, RunFalseEmptiesTheFilter) {
  Stepper<DerivativeFiltered> block(1.0, {.T1 = 5.0});
  for (int k = 0; k < 20; ++k) {
    block({.XIN = 1.0 * k, .RUN = true});
  }
  EXPECT_EQ(block({.XIN = 20.0, .RUN = false}).XOUT, 0.0);
  EXPECT_EQ(block({.XIN = 20.0, .RUN = true}).XOUT, 0.0);
}

TEST(DerivativeFiltered, FallsToZeroWithoutDenormalNumbers) {
  Stepper<DerivativeFiltered> block(1.0, {.T1 = 3.0});
  block({.XIN = 0.0, .RUN = true});
  double rate = block({.XIN = 1.0, .RUN = true}).XOUT;
  int positive = 1;
  while (rate != 0.0 && positive < 10000) {
    ASSERT_EQ(std::fpclassify(rate), FP_NORMAL);
    rate = block({.XIN = 1.0, .RUN = true}).XOUT;
    ++positive;
  }
  // 0.28·e^(−k/3) falls below 1e-36 after some 245 steps.
  EXPECT_NEAR(positive, 3.0 * 36.0 * std::numbers::ln10, 10.0);
}

}  // namespace
}  // namespace hysteron::testing
