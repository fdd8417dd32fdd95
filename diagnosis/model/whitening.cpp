#include "diagnosis/model/whitening.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>

namespace hysteron::diagnosis {

Whitening::Whitening(const Eigen::MatrixXd& shapes, Eigen::Index most) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solved(shapes.transpose() * shapes);
  const Eigen::VectorXd& squares = solved.eigenvalues();  // ascending
  // A direction whose variance is far below the noise's takes nothing, and its vector is made of rounding.
  constexpr double notable = 1e-3;
  Eigen::Index first = std::max<Eigen::Index>(0, squares.size() - most);
  while (first < squares.size() && !(squares[first] > notable)) {
    ++first;
  }
  const Eigen::VectorXd kept = squares.tail(squares.size() - first);
  directions_ = shapes * solved.eigenvectors().rightCols(kept.size()) * kept.cwiseSqrt().cwiseInverse().asDiagonal();
  taken_ = 1.0 - (1.0 + kept.array()).rsqrt();
}

void Whitening::apply(Eigen::Ref<Eigen::MatrixXd> columns) const {
  const Eigen::MatrixXd along = taken_.asDiagonal() * (directions_.transpose() * columns);
  columns.noalias() -= directions_ * along;
}

}  // namespace hysteron::diagnosis
