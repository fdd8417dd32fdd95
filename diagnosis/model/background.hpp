// What is left of a fit for effects to explain: its residual without what the known parameters could still close.
#pragma once

#include "diagnosis/model/least_squares.hpp"
#include "diagnosis/model/projection.hpp"

namespace hysteron::diagnosis {

/// The residual that candidates are screened against, with the known part projected off.
class Background {
 public:
  Background(VectorXd residuals, Projection known);
  Background(const Model& model, const Fit& at);

  /// ½‖P r‖²
  [[nodiscard]] double unexplained() const { return unexplained_; }
  [[nodiscard]] const VectorXd& residuals() const { return residuals_; }
  /// P v
  [[nodiscard]] VectorXd projected(const VectorXd& v) const { return projection_.rest(v); }
  /// What is gained by the best r + D α with low ≤ α ≤ high; D as columns.
  [[nodiscard]] double gain(const MatrixXd& changes, const VectorXd& low, const VectorXd& high, VectorXd& alpha) const;

 private:
  VectorXd residuals_{};
  Projection projection_{};
  double unexplained_ = 0.0;
};

}  // namespace hysteron::diagnosis
