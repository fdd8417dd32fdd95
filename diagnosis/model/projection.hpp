// What of a vector the columns of a matrix cannot make up.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace hysteron::diagnosis {

/// v − J (JᵀJ + Λ)⁻¹ Jᵀ v with the precisions Λ of a prior. The columns may depend on each other, be zero, or differ in
/// size by orders of magnitude: each counts by its length.
class Projection {
 public:
  Projection() = default;
  /// `prior` is √Λ, one number a column; empty: none.
  explicit Projection(Eigen::MatrixXd columns, const Eigen::VectorXd& prior = {});

  [[nodiscard]] Eigen::VectorXd rest(const Eigen::VectorXd& v) const;

 private:
  Eigen::MatrixXd columns_{};  ///< of length 1, with the prior's part
  Eigen::LDLT<Eigen::MatrixXd> normal_{};
};

}  // namespace hysteron::diagnosis
