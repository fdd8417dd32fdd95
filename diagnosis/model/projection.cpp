#include "diagnosis/model/projection.hpp"

#include <cmath>
#include <utility>

namespace hysteron::diagnosis {

Projection::Projection(Eigen::MatrixXd columns, const Eigen::VectorXd& prior) : columns_(std::move(columns)) {
  Eigen::VectorXd precision = Eigen::VectorXd::Zero(columns_.cols());
  for (Eigen::Index j = 0; j < columns_.cols(); ++j) {
    const double own = prior.size() > 0 ? prior[j] : 0.0;
    const double length = std::hypot(columns_.col(j).norm(), own);
    if (length > 0.0) {
      columns_.col(j) /= length;
      precision[j] = (own / length) * (own / length);
    }
  }
  constexpr double dependent = 1e-9;
  Eigen::MatrixXd normal = columns_.transpose() * columns_;
  normal.diagonal() += precision;
  normal.diagonal().array() += dependent;
  normal_.compute(normal);
}

Eigen::VectorXd Projection::rest(const Eigen::VectorXd& v) const {
  if (columns_.cols() == 0) {
    return v;
  }
  return v - columns_ * normal_.solve(columns_.transpose() * v);
}

}  // namespace hysteron::diagnosis
