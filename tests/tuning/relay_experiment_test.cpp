// Relay experiments on processes that are known: what they tell is held against the closed form.
#include "tuning/relay_experiment.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <deque>
#include <functional>
#include <numbers>
#include <random>
#include <vector>

#include "support/errors.hpp"

namespace hysteron {
namespace {

using std::numbers::pi;

constexpr double relay_step = 0.005;

struct RelayBench {
  double gain = 2.0;
  double time = 1.5;
  double dead_time = 0.4;
  double high = 1.0;
  double low = -1.0;
  double hysteresis = 0.0;
  double noise = 0.0;
  int rest = 100;
};

struct RelayLog {
  std::vector<double> u;
  std::vector<double> y;
};

/// y' = (K·u(t − L) − y)/T with u held, exact at the samples; the relay switches where y passes ∓hysteresis.
RelayLog relay_log(const RelayBench& bench, double seconds = 30.0) {
  RelayLog result;
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0.0, 1.0);
  std::deque<double> late(static_cast<std::size_t>(std::lround(bench.dead_time / relay_step)), 0.0);
  const double pole = std::exp(-relay_step / bench.time);
  const double sign = bench.gain < 0.0 ? -1.0 : 1.0;
  double y = 0.0;
  double u = bench.high;
  for (int k = 0; k < static_cast<int>(seconds / relay_step); ++k) {
    const double measured = y + bench.noise * noise(random);
    if (sign * measured > bench.hysteresis) {
      u = bench.low;
    } else if (sign * measured < -bench.hysteresis) {
      u = bench.high;
    }
    const double applied = k < bench.rest ? 0.0 : u;
    result.u.push_back(applied);
    result.y.push_back(measured);
    late.push_back(applied);
    y = pole * y + (1.0 - pole) * bench.gain * late.front();
    late.pop_front();
  }
  return result;
}

RelayExperiment told_by_relay(const RelayBench& bench) {
  const RelayLog one = relay_log(bench);
  return relay_experiment(one.u, one.y, relay_step, "relay.csv");
}

TEST(RelayExperiment, GainAndPhaseAreThoseOfTheProcess) {
  for (const RelayBench& bench : {RelayBench{}, RelayBench{.hysteresis = 0.1}, RelayBench{.time = 0.3},
                                  RelayBench{.gain = -2.0, .hysteresis = 0.05}, RelayBench{.high = 1.5, .low = -0.5},
                                  RelayBench{.hysteresis = 0.15, .noise = 0.02}}) {
    const RelayExperiment relay = told_by_relay(bench);
    const double omega = 2.0 * pi / relay.period;
    const double tolerance = bench.noise > 0.0 ? 0.02 : 0.005;
    EXPECT_NEAR(relay.gain, std::fabs(bench.gain) / std::hypot(1.0, omega * bench.time), tolerance * relay.gain);
    const double phase = -(omega * (bench.dead_time + 0.5 * relay_step) + std::atan(omega * bench.time)) * 180.0 / pi;
    EXPECT_NEAR(relay.phase, phase, 1.5);
    EXPECT_EQ(relay.direction, bench.gain < 0.0 ? -1.0 : 1.0);
    EXPECT_NEAR(relay.hysteresis, bench.hysteresis, 0.03 + 3.0 * bench.noise);
    EXPECT_GT(relay.cycles, 3);
  }
}

/// Without hysteresis the loop oscillates where the phase of a lag with dead time is −180°, to what the harmonics
/// leave.
TEST(RelayExperiment, TellsTheUltimateGainAndPeriod) {
  double low = 0.1;
  double high = 20.0;
  const RelayBench bench{.time = 1.0, .dead_time = 1.0};
  for (int k = 0; k < 60; ++k) {
    const double omega = 0.5 * (low + high);
    (omega * bench.dead_time + std::atan(omega * bench.time) < pi ? low : high) = omega;
  }
  const RelayExperiment relay = told_by_relay(bench);
  EXPECT_NEAR(relay.ultimate_period, 2.0 * pi / low, 0.1 * relay.ultimate_period);
  EXPECT_NEAR(relay.ultimate_gain, std::hypot(1.0, low * bench.time) / bench.gain, 0.1 * relay.ultimate_gain);
}

TEST(RelayExperiment, OfAnAsymmetricRelayTellsTheWholeModel) {
  for (const double gain : {2.0, -0.7}) {
    const RelayBench bench{.gain = gain, .high = 1.6, .low = -0.6, .hysteresis = 0.05};
    const RelayExperiment relay = told_by_relay(bench);
    ASSERT_TRUE(relay.model) << relay.why_no_model;
    EXPECT_NEAR(relay.model->gain, gain, 0.03 * std::fabs(gain));
    EXPECT_NEAR(relay.model->time, bench.time, 0.05 * bench.time);
    EXPECT_NEAR(relay.model->dead_time, bench.dead_time, 0.03);
  }
}

TEST(RelayExperiment, SaysWhyThereIsNoModel) {
  EXPECT_NE(told_by_relay({}).why_no_model.find("symmetric"), std::string::npos);
  EXPECT_NE(told_by_relay({.high = 1.6, .low = -0.6, .rest = 0}).why_no_model.find("at rest"), std::string::npos);
}

/// The PID of a start is stable with the process, by its own transfer function: 1 + L has no zero outside, which the
/// distance of L from −1 and the phase at |L| = 1 tell of such a process.
TEST(RelayExperiment, ItsStartHasMargin) {
  const RelayBench bench;
  const RelayExperiment relay = told_by_relay(bench);
  for (const ControllerStart& start : {relay.pi(), relay.pid()}) {
    double nearest = 1e9;
    for (double omega = 0.05; omega < 50.0; omega *= 1.01) {
      const std::complex<double> s(0.0, omega);
      const auto controller =
          start.gain * (1.0 + 1.0 / (s * start.reset_time) + s * start.rate_time / (1.0 + 0.1 * s * start.rate_time));
      const auto process = bench.gain * std::exp(-s * bench.dead_time) / (1.0 + s * bench.time);
      nearest = std::min(nearest, std::abs(1.0 + controller * process));
    }
    EXPECT_GT(nearest, 0.4);
  }
}

int refusal_of_log(const RelayLog& one) {
  try {
    (void)relay_experiment(one.u, one.y, relay_step, "relay.csv");
  } catch (const InputError& error) {
    return error.diagnostics().all().front().number;
  }
  return 0;
}

TEST(RelayExperiment, RefusesWhatIsNone) {
  RelayLog still = relay_log({});
  std::fill(still.u.begin(), still.u.end(), 1.0);
  EXPECT_EQ(refusal_of_log(still), error::no_limit_cycle);
  RelayLog sine = relay_log({});
  for (std::size_t k = 0; k < sine.u.size(); ++k) {
    sine.u[k] = std::sin(0.01 * static_cast<double>(k));
  }
  EXPECT_EQ(refusal_of_log(sine), error::no_limit_cycle);
  EXPECT_EQ(refusal_of_log(relay_log({}, 4.0)), error::no_limit_cycle) << "too few cycles";
  RelayLog growing = relay_log({});
  for (std::size_t k = 0; k < growing.u.size(); ++k) {
    growing.u[k] = std::sin(3e-6 * static_cast<double>(k * k)) > 0.0 ? 1.0 : -1.0;
  }
  EXPECT_EQ(refusal_of_log(growing), error::no_limit_cycle) << "its periods differ";
  RelayLog dead = relay_log({});
  std::fill(dead.y.begin(), dead.y.end(), 3.0);
  EXPECT_EQ(refusal_of_log(dead), error::no_limit_cycle) << "y never moves";
}

}  // namespace
}  // namespace hysteron
