// Standard errors against closed forms and repeated experiments; certified ones are held in nist_test.cpp.
#include "tuning/covariance.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>
#include <random>

namespace hysteron {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using ::testing::HasSubstr;

/// A linear model r = A·x − b as a finished fit.
LeastSquaresResult linear_fit(const MatrixXd& a, const VectorXd& b) {
  LeastSquaresResult fit;
  fit.x = (a.transpose() * a).ldlt().solve(a.transpose() * b);
  fit.residuals = a * fit.x - b;
  fit.jacobian = a;
  fit.at_bound.assign(static_cast<std::size_t>(a.cols()), AtBound::Free);
  return fit;
}

VectorXd white_noise(Index n, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  return VectorXd::NullaryExpr(n, [&](Index) { return normal(random); });
}

/// e(k) = φ·e(k−1) + w(k), stationary from the first sample, variance 1.
VectorXd coloured_noise(Index n, double phi, unsigned seed) {
  VectorXd e = white_noise(n, seed);
  for (Index k = 1; k < n; ++k) {
    e[k] = phi * e[k - 1] + std::sqrt(1.0 - phi * phi) * e[k];
  }
  return e;
}

MatrixXd line(Index n) {
  MatrixXd a(n, 2);
  a.col(0).setOnes();
  a.col(1) = VectorXd::LinSpaced(n, 0.0, 1.0);
  return a;
}

TEST(Covariance, OfAStraightLineIsTheTextbookFormula) {
  const Index n = 40;
  const MatrixXd a = line(n);
  VectorXd b = 2.0 * a.col(0) + 3.0 * a.col(1);
  for (Index i = 0; i < n; ++i) {
    b[i] += (i % 2 == 0 ? 0.1 : -0.1) + (i % 5 == 0 ? 0.03 : 0.0);  // alternating: correlation time 1
  }
  const Covariance c = covariance_of(linear_fit(a, b), {"offset", "slope"});
  EXPECT_EQ(c.correlation_time, 1.0);
  EXPECT_EQ(c.degrees_of_freedom, n - 2);
  const double mean = a.col(1).mean();
  const double sxx = (a.col(1).array() - mean).square().sum();
  const double s2 = linear_fit(a, b).residuals.squaredNorm() / (n - 2.0);
  EXPECT_NEAR(c.standard_errors[1], std::sqrt(s2 / sxx), 1e-14);
  EXPECT_NEAR(c.standard_errors[0], std::sqrt(s2 * (1.0 / n + mean * mean / sxx)), 1e-14);
  EXPECT_NEAR(c.correlation(0, 1), -mean / std::sqrt(sxx / n + mean * mean), 1e-13);
  EXPECT_TRUE(c.warnings.empty());

  // the same in other units, and from the normal matrix
  const VectorXd unit = (VectorXd(2) << 1e-9, 1e7).finished();
  const MatrixXd scaled = a * unit.asDiagonal();
  const Covariance other = covariance_of(linear_fit(scaled, b), {"offset", "slope"});
  EXPECT_NEAR(other.standard_errors[0] * unit[0], c.standard_errors[0], 1e-12);
  EXPECT_NEAR(other.standard_errors[1] * unit[1], c.standard_errors[1], 1e-12);
  EXPECT_NEAR(other.condition, c.condition, 1e-10);
  const Covariance normal = covariance_of(MatrixXd(scaled.transpose() * scaled),
                                          linear_fit(a, b).residuals.squaredNorm(), n, 1.0, {"offset", "slope"});
  EXPECT_NEAR(normal.standard_errors[0] * unit[0], c.standard_errors[0], 1e-12);
  EXPECT_NEAR(normal.correlation(1, 0), c.correlation(0, 1), 1e-12);
}

TEST(Covariance, NamesTheParametersThatOnlyActTogether) {
  // r = (K1 + 2·K2)·t + c: K1 and K2 are one parameter, c is well determined
  const MatrixXd straight = line(50);
  MatrixXd a(50, 3);
  a << straight.col(1), 2.0 * straight.col(1), straight.col(0);
  LeastSquaresResult fit;
  fit.x = VectorXd::Ones(3);
  fit.jacobian = a;
  fit.residuals = white_noise(50, 1);
  fit.at_bound.assign(3, AtBound::Free);
  for (const bool from_normal : {false, true}) {
    const Covariance c = from_normal ? covariance_of(MatrixXd(a.transpose() * a), fit.residuals.squaredNorm(), 50, 1.0,
                                                     {"K1", "K2", "c"})
                                     : covariance_of(fit, {"K1", "K2", "c"});
    ASSERT_EQ(c.indistinguishable.size(), 1U);
    EXPECT_EQ(c.indistinguishable[0].parameters, (std::vector<Index>{0, 1}));
    const VectorXd& direction = c.indistinguishable[0].direction;
    EXPECT_NEAR(direction[0] / direction[1], -2.0, 1e-6);
    EXPECT_EQ(c.standard_errors[0], std::numeric_limits<double>::infinity());
    EXPECT_EQ(c.standard_errors[1], std::numeric_limits<double>::infinity());
    EXPECT_LT(c.standard_errors[2], 1.0);
    EXPECT_NEAR(c.correlation(0, 1), -1.0, 1e-6);
    EXPECT_THAT(c.warnings.front(), HasSubstr("K1 and K2 cannot be told apart by this record"));
  }
}

TEST(Covariance, NamesAParameterWithoutInfluence) {
  MatrixXd a = line(50);
  LeastSquaresResult fit = linear_fit(a, white_noise(50, 2));
  fit.jacobian.col(1).setZero();
  const Covariance c = covariance_of(fit, {"offset", "slope"});
  EXPECT_EQ(c.standard_errors[1], std::numeric_limits<double>::infinity());
  EXPECT_LT(c.standard_errors[0], 1.0);
  ASSERT_FALSE(c.warnings.empty());
  EXPECT_EQ(c.warnings.front(), "This record does not determine slope.");
}

TEST(Covariance, WarnsOfAStrongCorrelation) {
  MatrixXd a = line(50);
  a.col(1).array() += 10.0;
  const Covariance c = covariance_of(linear_fit(a, white_noise(50, 3)), {"offset", "slope"});
  EXPECT_TRUE(c.indistinguishable.empty());
  ASSERT_EQ(c.warnings.size(), 1U);
  EXPECT_THAT(c.warnings[0], HasSubstr("offset and slope can hardly be told apart"));
  EXPECT_LT(c.correlation(0, 1), -0.99);
}

TEST(Covariance, ParametersThatAreWellDeterminedMayGoTogether) {
  MatrixXd a = line(50);
  a.col(1).array() += 10.0;
  LeastSquaresResult fit = linear_fit(a, white_noise(50, 3));
  const Covariance rough = covariance_of(fit, {"offset", "slope"});
  fit.x = 30.0 * rough.standard_errors;  // the same record, of a machine with larger parameters
  EXPECT_TRUE(covariance_of(fit, {"offset", "slope"}).warnings.empty());
  fit.x[1] = 10.0 * rough.standard_errors[1];
  EXPECT_EQ(covariance_of(fit, {"offset", "slope"}).warnings.size(), 1U);
}

TEST(Covariance, ParametersOnBoundsHaveNone) {
  const MatrixXd a = line(50);
  LeastSquaresResult fit = linear_fit(a, white_noise(50, 4));
  fit.at_bound = {AtBound::Free, AtBound::Upper};
  const Covariance c = covariance_of(fit, {"offset", "slope"});
  EXPECT_TRUE(std::isnan(c.standard_errors[1]));
  EXPECT_TRUE(std::isnan(c.correlation(0, 1)));
  EXPECT_EQ(c.degrees_of_freedom, 49);
  EXPECT_NEAR(c.standard_errors[0], c.residual_deviation * std::sqrt(c.correlation_time / 50.0), 1e-14);
  EXPECT_THAT(c.warnings.front(), HasSubstr("slope ran into its upper bound, 0.58"));
}

TEST(Covariance, AsManyParametersAsSamplesLeaveNoStandardErrors) {
  const Covariance c = covariance_of(linear_fit(line(2), white_noise(2, 5)), {"offset", "slope"});
  EXPECT_EQ(c.degrees_of_freedom, 0);
  EXPECT_TRUE(std::isnan(c.standard_errors[0]));
  EXPECT_THAT(c.warnings.front(), HasSubstr("there are no standard errors"));
}

TEST(Covariance, CorrelationTimeOfAFirstOrderProcess) {
  // τ = (1 + φ)/(1 − φ)
  EXPECT_NEAR(correlation_time(white_noise(200'000, 6)), 1.0, 0.05);
  EXPECT_NEAR(correlation_time(coloured_noise(200'000, 0.9, 7)), 19.0, 2.0);
  EXPECT_NEAR(correlation_time(coloured_noise(1'000'000, 0.995, 8)), 399.0, 80.0);
  EXPECT_EQ(correlation_time(VectorXd::Zero(100)), 1.0);
  EXPECT_EQ(correlation_time(VectorXd(0)), 1.0);
}

TEST(Covariance, PredictsTheScatterOfRepeatedExperimentsWithColouredNoise) {
  const Index n = 4000;
  const MatrixXd a = line(n);
  const int experiments = 200;
  double sum_of_squares = 0.0;
  double predicted = 0.0;
  double without = 0.0;
  for (int k = 0; k < experiments; ++k) {
    const VectorXd b = 3.0 * a.col(1) + coloured_noise(n, 0.9, 100U + static_cast<unsigned>(k));
    const LeastSquaresResult fit = linear_fit(a, b);
    const Covariance c = covariance_of(fit, {"offset", "slope"});
    sum_of_squares += std::pow(fit.x[1] - 3.0, 2);
    predicted += c.standard_errors[1] / experiments;
    without += c.standard_errors[1] / std::sqrt(c.correlation_time) / experiments;
  }
  const double scatter = std::sqrt(sum_of_squares / experiments);
  EXPECT_NEAR(predicted / scatter, 1.0, 0.2);
  EXPECT_LT(without / scatter, 0.3);
}

TEST(Covariance, AHuberFitLosesFivePercentOfEfficiencyOnNormalNoise) {
  const Index n = 100'000;
  const VectorXd noise = white_noise(n, 9);
  LeastSquaresProblem problem;
  problem.residual_count = n;
  problem.start = VectorXd::Ones(1);
  problem.evaluate = [&noise](const VectorXd& x, VectorXd& r, MatrixXd* jacobian) {
    r = (x[0] - noise.array()).matrix();
    if (jacobian != nullptr) {
      jacobian->setOnes();
    }
    return true;
  };
  const auto error = [&](Loss loss) {
    const Covariance c = covariance_of(solve(problem, {.loss = loss}), {"location"});
    return c.standard_errors[0] / std::sqrt(c.correlation_time);
  };
  const double ratio = error(Loss::Squares) / error(Loss::Huber);
  EXPECT_NEAR(ratio * ratio, 0.95, 0.01);
}

}  // namespace
}  // namespace hysteron
