// Points (p, M) from a record that is known in closed form: y = y_i ± Y(|u − u_i|), Y(p) = C1·p + C2·p^(C3+1)/(C3+1).
#include "tuning/hysteresis_points.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "support/diagnostic.hpp"
#include "support/errors.hpp"

namespace hysteron {
namespace {

struct Signals {
  std::vector<double> u{};
  std::vector<double> y{};
};

/// A sine of 1 Hz on the hysteresis, sampled so that the branching points fall on samples; the first quarter is the
/// skeleton curve.
Signals loop(const StaticMap& map, double amplitude, int samples_a_cycle, int cycles) {
  const auto primitive = [&map](double p) { return map.C1 * p + map.C2 * std::pow(p, map.C3 + 1.0) / (map.C3 + 1.0); };
  Signals signals;
  double u_branch = 0.0;
  double y_branch = 0.0;
  double direction = 1.0;
  for (int k = 0; k <= samples_a_cycle * cycles; ++k) {
    const double u = amplitude * std::sin(2.0 * std::numbers::pi * k / samples_a_cycle);
    signals.u.push_back(u);
    const bool skeleton = 4 * k <= samples_a_cycle;
    signals.y.push_back(skeleton ? 0.5 * primitive(2.0 * u)
                                 : y_branch + direction * primitive(std::fabs(u - u_branch)));
    if ((4 * k) % samples_a_cycle == 0 && ((4 * k) / samples_a_cycle) % 2 == 1) {
      u_branch = u;
      y_branch = signals.y.back();
      direction = u > 0.0 ? -1.0 : 1.0;
    }
  }
  return signals;
}

constexpr StaticMap actuator{0.02, 1e-4, 0.8};  // µm/V

TEST(HysteresisPoints, BranchingPointsAreTheExtremesOfTheInput) {
  const Signals s = loop(actuator, 50.0, 400, 3);
  const HysteresisPoints points = hysteresis_points(s.u, s.y, 1.0 / 400);
  EXPECT_EQ(points.branching_samples, (std::vector<std::size_t>{100, 300, 500, 700, 900, 1100}));
  EXPECT_GT(points.sample.front(), 100U);
}

TEST(HysteresisPoints, TheFitReturnsTheMapAtTheOrderOfEveryFormula) {
  // The error of a formula of second order falls by four when the sample time is halved.
  for (const auto formula : {RateFormula::TwoPoint, RateFormula::Central, RateFormula::LocalQuadratic}) {
    double error[2] = {};
    for (const int refinement : {1, 2}) {
      const int rate = 1000 * refinement;
      const Signals s = loop(actuator, 50.0, rate, 3);
      const HysteresisPoints points =
          hysteresis_points(s.u, s.y, 1.0 / rate, {.formula = formula, .half_width = 3, .rate_threshold = 100.0});
      const StaticMapFit fit = fit_static_map(points.points());
      EXPECT_TRUE(fit.converged());
      EXPECT_NEAR(fit.map.C1, actuator.C1, 1e-3 * actuator.C1);
      EXPECT_NEAR(fit.map.C3, actuator.C3, 1e-2 * actuator.C3);
      error[refinement - 1] = fit.rms;
    }
    EXPECT_GT(error[0], 2.8 * error[1]);
  }
}

TEST(HysteresisPoints, AQuadraticBranchIsExactInTheMiddleOfTheStep) {
  const StaticMap linear{0.02, 1e-4, 1.0};
  const Signals s = loop(linear, 50.0, 400, 2);
  const HysteresisPoints points = hysteresis_points(s.u, s.y, 1.0 / 400, {.formula = RateFormula::TwoPoint});
  for (std::size_t i = 0; i < points.p.size(); ++i) {
    EXPECT_NEAR(points.M[i], linear(points.p[i]), 1e-11);
  }
}

TEST(HysteresisPoints, SlowSamplesAreLeftOut) {
  const Signals s = loop(actuator, 50.0, 400, 2);
  const double threshold = 250.0;
  const HysteresisPoints points = hysteresis_points(s.u, s.y, 1.0 / 400, {.rate_threshold = threshold});
  const HysteresisPoints all = hysteresis_points(s.u, s.y, 1.0 / 400);
  EXPECT_EQ(points.slow + points.p.size(), all.slow + all.p.size());
  EXPECT_GT(points.slow, 0U);
  for (const std::size_t k : points.sample) {
    EXPECT_GT(std::fabs(s.u[k + 1] - s.u[k - 1]) * 200.0, threshold);
  }
}

TEST(HysteresisPoints, ADeadBandIgnoresNoiseOfTheInput) {
  Signals s = loop(actuator, 50.0, 400, 3);
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> noise(-0.05, 0.05);
  for (double& u : s.u) {
    u += noise(random);
  }
  EXPECT_GT(hysteresis_points(s.u, s.y, 1.0 / 400).branching_samples.size(), 6U);
  const auto points = hysteresis_points(s.u, s.y, 1.0 / 400, {.dead_band = 0.2});
  EXPECT_EQ(points.branching_samples.size(), 6U);
}

TEST(HysteresisPoints, NoFormulaReachesAcrossABranchingPoint) {
  const Signals s = loop(actuator, 50.0, 400, 2);
  const std::size_t h = 7;
  const auto points = hysteresis_points(s.u, s.y, 1.0 / 400, {.formula = RateFormula::LocalQuadratic, .half_width = h});
  for (const std::size_t k : points.sample) {
    for (const std::size_t turn : points.branching_samples) {
      EXPECT_FALSE(k - h < turn && turn < k + h) << k;
    }
  }
}

int error_number(const Signals& s, const HysteresisPointOptions& options = {}) {
  try {
    hysteresis_points(s.u, s.y, 1e-3, options, "log.csv");
  } catch (const InputError& error) {
    EXPECT_EQ(error.diagnostics().all().front().place.file, "log.csv");
    return error.diagnostics().all().front().number;
  }
  return 0;
}

TEST(HysteresisPoints, RecordsThatCannotBeUsedAreErrors) {
  Signals s = loop(actuator, 50.0, 400, 2);
  EXPECT_EQ(error_number(s, {.rate_threshold = 1e9}), error::no_motion);
  s.y[40] = std::numeric_limits<double>::infinity();
  EXPECT_EQ(error_number(s), error::unusable_point);
  EXPECT_EQ(error_number({{0.0, 1.0, 2.0, 3.0}, {0.0, 1.0, 2.0, 3.0}}), error::too_few_points);
  EXPECT_EQ(error_number({}), error::too_few_points);
}

}  // namespace
}  // namespace hysteron
