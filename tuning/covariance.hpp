// How well a record determines the parameters fitted to it: standard errors, correlations, and plain warnings.
//
//   Cov = s²·τ·(JᵀJ)⁻¹,   s² = Σrᵢ²/(N − n)
//
// with the Jacobian J = ∂r/∂x at the solution, N samples and n free parameters. Columns are scaled to length 1 first,
// and the inverse comes from a singular value decomposition, so that units do not matter and a direction that the
// record does not see is found and named rather than inverted.
//
// τ is the correlation time of the residuals in samples: N correlated samples are worth N/τ independent ones. It is
// 1 + 2Σρₖ with the autocorrelations ρₖ summed in pairs up to the first pair that is not positive (C. J. Geyer,
// Statistical Science 7 (1992) 473–483, initial positive sequence), and never below 1. A model that leaves slow
// residuals, creep say, has a large τ; without it the standard errors would be far too small.
//
// Robust fits: s² is Σψ²/(N − n) over the square of the share of samples inside the threshold, with ψ = w·r (P. J.
// Huber, Robust Statistics, 1981, section 7.6).
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "tuning/ipopt_problem.hpp"

namespace hysteron {

/// A set of parameters that only act together: a change along `direction` leaves the residuals as they are.
struct Indistinguishable {
  std::vector<Eigen::Index> parameters{};
  Eigen::VectorXd direction{};  ///< one entry for each parameter of the fit, in its unit
};

struct Covariance {
  /// One for each parameter: ∞ where the record does not determine it, NaN where it was held or lies on a bound.
  Eigen::VectorXd standard_errors{};
  Eigen::MatrixXd covariance{};   ///< NaN in the rows of parameters that were not free
  Eigen::MatrixXd correlation{};  ///< −1 … 1, NaN as above
  Eigen::Index samples = 0;
  Eigen::Index degrees_of_freedom = 0;  ///< N − n; at 0 or below there are no standard errors (NaN)
  double residual_deviation = 0.0;      ///< s, in the unit of the residuals
  double condition = 1.0;               ///< of the scaled Jacobian
  double correlation_time = 1.0;        ///< τ, samples
  std::vector<Indistinguishable> indistinguishable{};
  std::vector<std::string> warnings{};

  /// What N correlated samples are worth.
  [[nodiscard]] double effective_samples() const { return static_cast<double>(samples) / correlation_time; }
};

/// From a finished fit. `names` as in the problem; residuals are taken in their order in time for τ.
Covariance covariance_of(const LeastSquaresResult& fit, const std::vector<std::string>& names);

/// From the normal matrix JᵀJ and the sum of squares, for fits that keep no Jacobian of a million rows.
Covariance covariance_of(const Eigen::MatrixXd& normal_matrix, double sum_of_squares, Eigen::Index samples,
                         double correlation_time, const std::vector<std::string>& names);

/// τ of a sequence with mean 0, in samples, 1 at least. Linear time: long correlations are found on block averages.
double correlation_time(const Eigen::VectorXd& residuals);

}  // namespace hysteron
