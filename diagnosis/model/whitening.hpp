// Residuals whose rows are not independent, transformed to ones that are.
#pragma once

#include <Eigen/Core>

namespace hysteron::diagnosis {

/// For residuals with the covariance V = I + S Sᵀ: with the left singular vectors U of S and its singular values s,
///
///   V^(−½) r = r − U diag(1 − 1/√(1 + s²)) Uᵀ r,
///
/// which has the covariance I. Of the columns of S those directions count that are strongest.
class Whitening {
 public:
  Whitening(const Eigen::MatrixXd& shapes, Eigen::Index most);

  /// Each column is a residual, or its derivative by one unknown.
  void apply(Eigen::Ref<Eigen::MatrixXd> columns) const;

 private:
  Eigen::MatrixXd directions_{};
  Eigen::VectorXd taken_{};  ///< of each direction, as a share
};

}  // namespace hysteron::diagnosis
