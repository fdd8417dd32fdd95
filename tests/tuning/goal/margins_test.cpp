// Margins against closed forms, and their derivatives against differences.
#include "tuning/goal/margins.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/tuning/goal/loops.hpp"

namespace hysteron {
namespace {

using Eigen::Index;
using Eigen::VectorXd;
using std::numbers::pi;

/// L = TS·K·z⁻ᵈ/(z − 1): |L| = TS·K/(2·sin(w/2)), arg L = −90° − (d + ½)·w, w = ω·TS.
struct KnownIntegrator {
  double gain;
  int delays;
  [[nodiscard]] double crossover() const { return 2.0 * std::asin(0.5 * loops::ts * gain); }
  [[nodiscard]] double phase_margin() const { return 90.0 - (delays + 0.5) * crossover() * 180.0 / pi; }
  [[nodiscard]] double gain_margin() const {
    const double w = pi / (2.0 * (delays + 0.5));
    return -20.0 * std::log10(loops::ts * gain / (2.0 * std::sin(0.5 * w)));
  }
};

class MarginsOfIntegrators : public ::testing::TestWithParam<KnownIntegrator> {};

TEST_P(MarginsOfIntegrators, AreThoseOfTheClosedForm) {
  const KnownIntegrator known = GetParam();
  const auto settings = fmt::format(
      "[parameters.P]\nK = {}\n[fit.P]\nK = {{min = 0.0}}\n[goal]\nsettling_time = 1.0\nloop = \"P.XOUT\"\n",
      known.gain);
  const GoalProblem problem = loops::problem_of(loops::integrator(known.delays), settings);
  GoalModel model(problem);
  ASSERT_EQ(model.evaluate(loops::start_of(problem), true), LoopState::Settles);
  const LoopMargins margins = *model.figures(0).margins;
  EXPECT_NEAR(margins.phase.value, known.phase_margin(), 1e-4);
  EXPECT_NEAR(margins.phase.frequency, known.crossover() / loops::ts, 1e-4 * margins.phase.frequency);
  EXPECT_NEAR(margins.gain.value, known.gain_margin(), 1e-4);
  // d/dK of the closed forms
  const double slope = loops::ts / std::cos(0.5 * known.crossover());
  EXPECT_NEAR(margins.phase.by[0], -(known.delays + 0.5) * slope * 180.0 / pi, 1e-3 * std::fabs(margins.phase.by[0]));
  EXPECT_NEAR(margins.gain.by[0], -20.0 / (std::log(10.0) * known.gain), 1e-4 * std::fabs(margins.gain.by[0]));
}

INSTANTIATE_TEST_SUITE_P(All, MarginsOfIntegrators,
                         ::testing::Values(KnownIntegrator{1.0, 0}, KnownIntegrator{20.0, 1}, KnownIntegrator{5.0, 7},
                                           KnownIntegrator{60.0, 0}, KnownIntegrator{14.0, 4}));

/// A gain behind a delay, L = K/z: S = 1/(1 + K/z), |S| is largest at the Nyquist frequency, 1/(1 − K).
TEST(Margins, OfAGainBehindADelay) {
  constexpr double gain = 0.6;
  Signal impulse;
  Eigen::MatrixXd by(200, 1);
  for (int k = 0; k < 200; ++k) {
    impulse.push_back(std::pow(-gain, k));
    by(k, 0) = k == 0 ? 0.0 : -k * std::pow(-gain, k - 1);
  }
  const Sensitivity sensitivity(impulse, by, loops::ts);
  const LoopMargins margins = sensitivity.margins();
  EXPECT_NEAR(margins.sensitivity.value, 1.0 / (1.0 - gain), 1e-9);
  EXPECT_NEAR(margins.sensitivity.frequency, pi / loops::ts, 1e-6 * pi / loops::ts);
  EXPECT_NEAR(margins.sensitivity.by[0], 1.0 / std::pow(1.0 - gain, 2), 1e-6);
  EXPECT_NEAR(margins.gain.value, -20.0 * std::log10(gain), 1e-9);
  EXPECT_NEAR(margins.gain.by[0], -20.0 / (std::log(10.0) * gain), 1e-6);
  EXPECT_TRUE(std::isinf(margins.phase.value)) << "|L| is below 1 everywhere";
}

/// Every limit of a loop of which nothing is known by hand, against central differences.
TEST(Margins, DerivativesOfAllLimitsAreThoseOfDifferences) {
  const GoalProblem problem = loops::problem_of(loops::oven, R"(
[fit.PID]
KP = {min = 0.0}
TR = {min = 0.1}
TD = {min = 0.0}
[fit.DEAD]
DEAD_TIME = {}
[fit.WALL]
T1 = {}
[goal]
settling_time = 4.0
loop = "PID.XOUT"
effort_weight = 0.3
[goal.limits]
effort = 2.0
effort_rate = 10.0
overshoot_percent = 3.0
gain_margin_db = 12.0
phase_margin_deg = 60.0
sensitivity = 1.6
)");
  ASSERT_EQ(problem.limits.size(), 6U);
  GoalModel model(problem);
  const VectorXd x = loops::start_of(problem);
  ASSERT_EQ(model.evaluate(x, true), LoopState::Settles);
  std::vector<LimitPlace> places;
  for (std::size_t limit = 0; limit < 6; ++limit) {
    const auto some = model.places(limit, 0, -10.0);
    ASSERT_FALSE(some.empty()) << limit;
    places.push_back(some.front());
  }
  std::vector<Margin> exact;
  for (const LimitPlace& place : places) {
    exact.push_back(model.excess(place));
    const GoalLimit& limit = problem.limits[place.limit];
    const double over = excess_over(limit.kind, model.value_of(place.limit, 0), limit.limit);
    EXPECT_NEAR(exact.back().value, limit.kind == LimitKind::Overshoot ? exact.back().value : std::max(over, -1.0),
                1e-6);
  }
  const VectorXd cost_by = model.cost_by(0);
  for (Index j = 0; j < x.size(); ++j) {
    const double step = 1e-3 * x[j];  // rounding of h over it stays below the truncation
    std::vector<double> at[2];
    double cost[2];
    for (int side = 0; side < 2; ++side) {
      VectorXd moved = x;
      moved[j] += side == 0 ? -step : step;
      ASSERT_EQ(model.evaluate(moved, true), LoopState::Settles);
      cost[side] = model.cost(0);
      for (const LimitPlace& place : places) {
        at[side].push_back(model.excess(place).value);
      }
    }
    EXPECT_NEAR(cost_by[j], (cost[1] - cost[0]) / (2.0 * step), 1e-4 * std::fabs(cost_by[j]) + 1e-9);
    for (std::size_t i = 0; i < places.size(); ++i) {
      EXPECT_NEAR(exact[i].by[j], (at[1][i] - at[0][i]) / (2.0 * step), 1e-3 * std::fabs(exact[i].by[j]) + 1e-5)
          << text_of(problem.limits[i].kind).name << " by " << problem.parameters[static_cast<std::size_t>(j)].name;
    }
  }
}

/// The same loop written down by hand, at any frequency: PID of the block's equations, lags and dead time as they are
/// sampled.
TEST(Margins, OfAPidAreThoseOfItsTransferFunctions) {
  const GoalProblem problem =
      loops::problem_of(loops::oven, "[fit.PID]\nKP = {}\n[goal]\nsettling_time = 4.0\nloop = \"PID.XOUT\"\n");
  GoalModel model(problem);
  ASSERT_EQ(model.evaluate(loops::start_of(problem), false), LoopState::Settles);
  constexpr double step = 0.05;
  const auto open_loop = [](double frequency) {
    using Complex = std::complex<double>;
    const Complex z = std::polar(1.0, frequency * step);
    const Complex back = 1.0 / z;
    const double filter = 0.1 / 10.0;  // TD/N
    const Complex pid = 1.0 + step / 2.0 / (1.0 - back) + 0.1 * (1.0 - back) / (filter + step - filter * back);
    // Ramp-invariant: (z − 1)²/(TS·z) times the z-transform of the response to a ramp; 1 − e·z in closed form.
    const auto lag = [&](double time) {
      const double pole = std::exp(-step / time);
      const double late = time / step * (1.0 - pole);
      return ((1.0 - late) + (late - pole) * back) / (1.0 - pole * back);
    };
    const Complex dead = std::pow(back, 6.0) * (0.6 + 0.4 * back);  // 6.4 samples, straight between them
    return pid * back * dead * lag(1.5) * lag(0.4);
  };
  for (std::size_t i = 40; i < model.sensitivity(0)->grid().size(); i += 40) {
    const FrequencyPoint& point = model.sensitivity(0)->grid()[i];
    const auto expected = open_loop(point.frequency);
    EXPECT_LT(std::abs(point.open_loop() - expected), 1e-4 * std::abs(expected) + 1e-6) << point.frequency;
  }
}

}  // namespace
}  // namespace hysteron
