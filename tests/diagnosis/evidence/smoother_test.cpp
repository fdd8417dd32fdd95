#include "diagnosis/evidence/smoother.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "tests/diagnosis/simulated_machine.hpp"

namespace hysteron::diagnosis {
namespace {

/// x' = 0.9 x + 0.2 w + d, y = x + 0.1 w + e, over a few steps.
LinearSystem first_order(Index steps) {
  test::Noise noise(7);
  LinearSystem system{.states = 1, .outputs = 1};
  system.a.resize(2, 2 * steps);
  system.constants.resize(2, steps);
  system.measured.resize(1, steps);
  for (Index k = 0; k < steps; ++k) {
    system.a.middleCols(2 * k, 2) << 0.9, 0.2, 1.0, 0.1;
    system.constants.col(k) << 0.3 * noise(), 0.1;
    system.measured(0, k) = noise();
  }
  system.first = VectorXd::Constant(1, 0.4);
  system.spread = VectorXd::Constant(2, 3.0);
  system.noise = VectorXd::Constant(1, 0.25);
  return system;
}

/// Second implementation: all unknowns at once, x(0), w(0) and the changes of w, by least squares with their priors.
struct AtOnce {
  MatrixXd of_w{};    ///< w by the unknowns
  MatrixXd normal{};  ///< the normal matrix
  VectorXd w{};
};
AtOnce at_once(const LinearSystem& system, double step) {
  const Index steps = system.steps();
  const Index unknowns = steps + 1;  // x(0), w(0), w(k) − w(k−1)
  MatrixXd rows(steps, unknowns);
  VectorXd right(steps);
  MatrixXd of_w = MatrixXd::Zero(steps, unknowns);
  for (Index k = 0; k < steps; ++k) {
    of_w.row(k).segment(1, k + 1).setOnes();
  }
  VectorXd x = VectorXd::Zero(unknowns);
  x[0] = 1.0;
  double fixed = system.first[0];
  for (Index k = 0; k < steps; ++k) {
    const MatrixXd slopes = system.a.middleCols(2 * k, 2);
    rows.row(k) = slopes(1, 0) * x.transpose() + slopes(1, 1) * of_w.row(k);
    right[k] = system.measured(0, k) - system.constants(1, k) - slopes(1, 0) * fixed;
    x = slopes(0, 0) * x + slopes(0, 1) * of_w.row(k).transpose();
    fixed = slopes(0, 0) * fixed + system.constants(0, k);
  }
  VectorXd prior = VectorXd::Constant(unknowns, 1.0 / (step * step));
  prior[0] = 1.0 / (system.spread[0] * system.spread[0]);
  prior[1] = 1.0 / (system.spread[1] * system.spread[1]);
  MatrixXd normal = rows.transpose() * rows / system.noise[0];
  normal.diagonal() += prior;
  VectorXd w = of_w * normal.lu().solve(rows.transpose() * right / system.noise[0]);
  return {.of_w = std::move(of_w), .normal = std::move(normal), .w = std::move(w)};
}

TEST(Smoother, GivesWhatLeastSquaresOverAllStepsAtOnceGives) {
  const LinearSystem system = first_order(30);
  for (const double step : {0.01, 0.3, 5.0}) {
    const VectorXd expected = at_once(system, step).w;
    const MatrixXd smoothed = Smoother(system, step).smoothed();
    EXPECT_LT((smoothed.row(1).transpose() - expected).norm(), 1e-9 * expected.norm()) << step;
  }
}

TEST(Smoother, DeviationsAreThoseOfLeastSquaresOverAllStepsAtOnce) {
  const LinearSystem system = first_order(30);
  for (const double step : {0.01, 0.3, 5.0}) {
    const AtOnce whole = at_once(system, step);
    const MatrixXd found = Smoother(system, step).deviations();
    // Their ratio: both rest on one estimate of σ.
    const MatrixXd spread = whole.of_w * whole.normal.inverse() * whole.of_w.transpose();
    const VectorXd expected = spread.diagonal().cwiseSqrt();
    const double sigma = found(1, 0) / expected[0];
    EXPECT_LT((found.row(1).transpose() - sigma * expected).norm(), 1e-8 * found.row(1).norm()) << step;
  }
}

TEST(Smoother, AKnownSignalTakesItsPartOffTheMissingOne) {
  const LinearSystem system = first_order(40);
  test::Noise noise(3);
  MatrixXd ways(2, 40);
  MatrixXd signals(40, 2);
  for (Index k = 0; k < 40; ++k) {
    ways.col(k) << 0.2 + 0.01 * static_cast<double>(k), 0.1;
    signals.row(k) << noise(), 1.0;
  }
  const double step = 0.4;
  LinearSystem with = system;
  for (Index k = 0; k < 40; ++k) {
    with.constants.col(k) += ways.col(k) * (0.7 * signals(k, 0) - 0.2 * signals(k, 1));
  }
  const Smoother smoother(system, step);
  const VectorXd expected = Smoother(with, step).smoothed().row(1).transpose();
  const VectorXd found =
      smoother.smoothed().row(1).transpose() + smoother.missing_for(ways, signals) * Eigen::Vector2d(0.7, -0.2);
  EXPECT_LT((found - expected).norm(), 1e-10 * expected.norm());
}

TEST(Smoother, TheLikelihoodIsHighestAboutTheStepThatMadeTheRecord) {
  // y is w itself in noise, w a random walk in steps of 0.1.
  constexpr Index steps = 2000;
  test::Noise noise(5);
  LinearSystem system{.states = 0, .outputs = 1};
  system.a = MatrixXd::Ones(1, steps);
  system.constants = MatrixXd::Zero(1, steps);
  system.measured.resize(1, steps);
  double w = 0.0;
  for (Index k = 0; k < steps; ++k) {
    system.measured(0, k) = w + 0.5 * noise();
    w += 0.1 * noise();
  }
  system.first.resize(0);
  system.spread = VectorXd::Constant(1, 10.0);
  system.noise = VectorXd::Constant(1, 0.25);
  const double at = Smoother(system, 0.1).log_likelihood();
  EXPECT_GT(at, Smoother(system, 0.03).log_likelihood());
  EXPECT_GT(at, Smoother(system, 0.3).log_likelihood());
}

}  // namespace
}  // namespace hysteron::diagnosis
