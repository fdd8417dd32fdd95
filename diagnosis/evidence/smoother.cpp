#include "diagnosis/evidence/smoother.hpp"

#include <Eigen/LU>
#include <cmath>

namespace hysteron::diagnosis {
namespace {

/// Of many signals at once, one a column: a row is what lies side by side in memory.
using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// target += matrix·source. Matrices of diagrams are small and mostly 0: a product of Eigen's would spend its time on
/// arranging them.
template <class Matrix, class Source, class Target>
void add_product(const Matrix& matrix, const Source& source, Target& target) {
  for (Index i = 0; i < matrix.rows(); ++i) {
    for (Index j = 0; j < matrix.cols(); ++j) {
      if (const double factor = matrix(i, j); factor != 0.0) {
        target.row(i) += factor * source.row(j);
      }
    }
  }
}

template <class Matrix, class Source, class Target>
void subtract_product(const Matrix& matrix, const Source& source, Target& target) {
  add_product(-matrix, source, target);
}

}  // namespace

Smoother::Smoother(const LinearSystem& system, double step) : system_(system) {
  const Index n = system.states;
  const Index z = n + 1;
  const Index p = system.outputs;
  const Index steps = system.steps();
  gains_.resize(z, p * steps);
  inverses_.resize(p, p * steps);
  covariances_.resize(z, z * steps);
  predicted_.resize(z, steps);
  innovations_.resize(p, steps);
  VectorXd at = VectorXd::Zero(z);
  at.head(n) = system.first;
  MatrixXd covariance = system.spread.array().square().matrix().asDiagonal();
  MatrixXd forward = MatrixXd::Identity(z, z);
  double squares = 0.0;
  double determinants = 0.0;
  for (Index k = 0; k < steps; ++k) {
    const auto slopes = system.a.middleCols(k * z, z);
    const auto shows = slopes.bottomRows(p);
    predicted_.col(k) = at;
    covariances_.middleCols(k * z, z) = covariance;
    const VectorXd innovation = system.measured.col(k) - system.constants.col(k).tail(p) - shows * at;
    MatrixXd spread = shows * covariance * shows.transpose();
    spread.diagonal() += system.noise;
    const MatrixXd inverse = spread.inverse();
    const MatrixXd gain = covariance * shows.transpose() * inverse;
    innovations_.col(k) = innovation;
    inverses_.middleCols(k * p, p) = inverse;
    gains_.middleCols(k * p, p) = gain;
    squares += innovation.dot(inverse * innovation);
    determinants += std::log(std::max(spread.determinant(), 1e-300));
    at += gain * innovation;
    covariance -= gain * spread * gain.transpose();
    forward.topRows(n) = slopes.topRows(n);
    at = forward * at;
    at.head(n) += system.constants.col(k).head(n);
    covariance = forward * covariance * forward.transpose();
    covariance(n, n) += step * step;
    covariance = 0.5 * (covariance + covariance.transpose().eval());
  }
  const auto samples = static_cast<double>(steps * p);
  variance_ = std::max(squares / samples, 1e-300);
  log_likelihood_ = -0.5 * determinants - 0.5 * samples * std::log(variance_);
}

MatrixXd Smoother::smoothed() const {
  const Index n = system_.states;
  const Index z = n + 1;
  const Index p = system_.outputs;
  MatrixXd result(z, system_.steps());
  VectorXd adjoint = VectorXd::Zero(z);
  MatrixXd forward = MatrixXd::Identity(z, z);
  for (Index k = system_.steps() - 1; k >= 0; --k) {
    const auto slopes = system_.a.middleCols(k * z, z);
    const auto shows = slopes.bottomRows(p);
    forward.topRows(n) = slopes.topRows(n);
    if (k + 1 < system_.steps()) {
      adjoint = forward.transpose() * adjoint;  // from the prediction of step k + 1
    }
    const VectorXd weighed = inverses_.middleCols(k * p, p) * innovations_.col(k);
    const VectorXd taken = gains_.middleCols(k * p, p).transpose() * adjoint;
    adjoint -= shows.transpose() * (weighed + taken);
    result.col(k) = predicted_.col(k) - covariances_.middleCols(k * z, z) * adjoint;
  }
  return result;
}

MatrixXd Smoother::deviations() const {
  const Index n = system_.states;
  const Index z = n + 1;
  const Index p = system_.outputs;
  MatrixXd result(z, system_.steps());
  MatrixXd known = MatrixXd::Zero(z, z);  // of the adjoint: what the samples from here on tell
  MatrixXd forward = MatrixXd::Identity(z, z);
  for (Index k = system_.steps() - 1; k >= 0; --k) {
    const auto slopes = system_.a.middleCols(k * z, z);
    const auto shows = slopes.bottomRows(p);
    forward.topRows(n) = slopes.topRows(n);
    if (k + 1 < system_.steps()) {
      known = (forward.transpose() * known * forward).eval();
    }
    const MatrixXd kept = MatrixXd::Identity(z, z) - gains_.middleCols(k * p, p) * shows;
    known = (kept.transpose() * known * kept).eval() + shows.transpose() * inverses_.middleCols(k * p, p) * shows;
    const auto covariance = covariances_.middleCols(k * z, z);
    const MatrixXd smoothed = covariance - covariance * known * covariance;
    result.col(k) = (variance_ * smoothed.diagonal().cwiseMax(0.0)).cwiseSqrt();
  }
  return result;
}

MatrixXd Smoother::missing_for(const MatrixXd& ways, const MatrixXd& signals) const {
  const Index n = system_.states;
  const Index z = n + 1;
  const Index p = system_.outputs;
  const Index steps = system_.steps();
  const Index m = signals.cols();
  const Rows entering = signals;
  Rows innovations = Rows::Zero(steps * p, m);
  Rows missing(steps, m);
  Rows at = Rows::Zero(z, m);
  Rows next(z, m);
  for (Index k = 0; k < steps; ++k) {
    const auto slopes = system_.a.middleCols(k * z, z);
    auto innovation = innovations.middleRows(k * p, p);
    subtract_product(slopes.bottomRows(p), at, innovation);
    subtract_product(ways.col(k).tail(p), entering.row(k), innovation);
    missing.row(k) = at.row(n);
    add_product(gains_.middleCols(k * p, p), innovation, at);
    next.setZero();
    next.row(n) = at.row(n);
    auto moved = next.topRows(n);
    add_product(slopes.topRows(n), at, moved);
    add_product(ways.col(k).head(n), entering.row(k), moved);
    at.swap(next);
  }
  Rows adjoint = Rows::Zero(z, m);
  Rows weighed(p, m);
  for (Index k = steps - 1; k >= 0; --k) {
    const auto slopes = system_.a.middleCols(k * z, z);
    if (k + 1 < steps) {
      next.setZero();
      next.row(n) = adjoint.row(n);
      add_product(slopes.topRows(n).transpose(), adjoint.topRows(n), next);
      adjoint.swap(next);
    }
    weighed.setZero();
    add_product(inverses_.middleCols(k * p, p), innovations.middleRows(k * p, p), weighed);
    add_product(gains_.middleCols(k * p, p).transpose(), adjoint, weighed);
    subtract_product(slopes.bottomRows(p).transpose(), weighed, adjoint);
    auto row = missing.middleRows(k, 1);
    subtract_product(covariances_.middleCols(k * z, z).row(n), adjoint, row);
  }
  return missing;
}

}  // namespace hysteron::diagnosis
