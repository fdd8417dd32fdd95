#include "diagnosis/model/background.hpp"

#include <Eigen/Cholesky>
#include <utility>

namespace hysteron::diagnosis {

Background::Background(VectorXd residuals, Projection known)
    : residuals_(std::move(residuals)), projection_(std::move(known)) {
  unexplained_ = 0.5 * residuals_.dot(projected(residuals_));
}

Background::Background(const Model& model, const Fit& at)
    : Background(at.residuals, Projection(at.jacobian, model.prior())) {}

double Background::gain(const MatrixXd& changes, const VectorXd& low, const VectorXd& high, VectorXd& alpha) const {
  MatrixXd projected_changes(changes.rows(), changes.cols());
  for (Index k = 0; k < changes.cols(); ++k) {
    projected_changes.col(k) = projected(changes.col(k));
  }
  MatrixXd matrix = changes.transpose() * projected_changes;
  const VectorXd slope = projected_changes.transpose() * residuals_;
  for (Index k = 0; k < matrix.rows(); ++k) {
    matrix(k, k) = matrix(k, k) > 0.0 ? matrix(k, k) * (1.0 + 1e-9) : 1.0;
  }
  alpha = (-matrix.ldlt().solve(slope)).cwiseMax(low).cwiseMin(high);
  const double gained = -(alpha.dot(slope) + 0.5 * alpha.dot(matrix * alpha));
  // More than all there is comes of rounding alone, where a change that grows without bound is projected.
  return gained <= 1.001 * unexplained_ ? gained : 0.0;
}

}  // namespace hysteron::diagnosis
