// The fit that every candidate gets: Levenberg-Marquardt with bounds, priors and weights of rows.
//
//   minimise  ½ Σ wᵢ rᵢ(x)² + ½ Σ ((xⱼ − x⁰ⱼ)/sⱼ)²
//
// Hundreds of candidates are fitted, from starts that a grid has found, to the few digits that a ranking needs: Ipopt
// takes some ten times as long from there and gives the same.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <limits>

#include "diagnosis/model/model.hpp"

namespace hysteron::diagnosis {

struct Fit {
  VectorXd x{};
  double cost = std::numeric_limits<double>::infinity();  ///< ½ Σ w r² + prior; ∞ where there is no value at the start
  VectorXd residuals{};
  MatrixXd jacobian{};
  bool converged = false;
};

struct FitOptions {
  int iterations = 25;
  double tolerance = 1e-5;            ///< of the relative decrease of the cost
  const VectorXd* weights = nullptr;  ///< of the rows; null: 1
  std::function<bool()> stop{};       ///< asked before each step: the fit ends where it stands
};

/// From `start`, which is brought within the bounds. The prior is about the model's own start.
[[nodiscard]] Fit fit(Model& model, const VectorXd& start, const FitOptions& options = {});

/// The cost at x.
[[nodiscard]] double cost_of(const Model& model, const VectorXd& x, const VectorXd& residuals, const VectorXd* weights);

}  // namespace hysteron::diagnosis
