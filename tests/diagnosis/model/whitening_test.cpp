// Whitened residuals against the inverse of their covariance.
#include "diagnosis/model/whitening.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "tests/diagnosis/simulated_machine.hpp"

namespace hysteron::diagnosis {
namespace {

Eigen::MatrixXd random_matrix(Eigen::Index rows, Eigen::Index columns, std::uint64_t seed) {
  test::Noise random(seed);
  return Eigen::MatrixXd::NullaryExpr(rows, columns, [&] { return random(); });
}

TEST(Whitening, IsTheRootOfTheInverseCovariance) {
  const Eigen::MatrixXd shapes = random_matrix(40, 6, 1);
  const Eigen::MatrixXd residuals = random_matrix(40, 3, 2);
  const Eigen::MatrixXd covariance = Eigen::MatrixXd::Identity(40, 40) + shapes * shapes.transpose();
  Eigen::MatrixXd white = residuals;
  Whitening(shapes, 6).apply(white);
  const Eigen::MatrixXd expected = residuals.transpose() * covariance.ldlt().solve(residuals);
  EXPECT_LT((white.transpose() * white - expected).norm(), 1e-10 * expected.norm());
}

TEST(Whitening, TakesTheStrongestDirections) {
  Eigen::MatrixXd shapes = Eigen::MatrixXd::Zero(5, 2);
  shapes(0, 0) = 10.0;
  shapes(1, 1) = 3.0;
  Eigen::MatrixXd ones = Eigen::MatrixXd::Ones(5, 1);
  Whitening(shapes, 1).apply(ones);
  EXPECT_NEAR(ones(0), 1.0 / std::sqrt(101.0), 1e-12);
  EXPECT_NEAR(ones(1), 1.0, 1e-12) << "the weaker one stays";
  EXPECT_NEAR(ones(2), 1.0, 1e-12);
}

TEST(Whitening, OfNothingChangesNothing) {
  const Eigen::MatrixXd residuals = random_matrix(8, 1, 3);
  Eigen::MatrixXd same = residuals;
  Whitening(Eigen::MatrixXd::Zero(8, 4), 4).apply(same);
  EXPECT_EQ(same, residuals);
}

}  // namespace
}  // namespace hysteron::diagnosis
