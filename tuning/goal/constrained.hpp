// A cost under inequalities, solved by Ipopt.
//
//   minimise f(x)   subject to   c(x) ≤ 0,   lower ≤ x ≤ upper
//
// The user gives f and c with their exact gradients. The Hessian of the Lagrangian is approximated from them (limited
// memory BFGS), so that the curvature of the constraints counts. x goes to Ipopt in units of its typical size; f and c
// are to be of the order of 1.
#pragma once

#include <Eigen/Core>
#include <functional>

#include "tuning/ipopt_problem.hpp"

namespace hysteron {

struct ConstrainedPoint {
  double cost = 0.0;
  Eigen::VectorXd gradient{};
  Eigen::VectorXd constraints{};
  Eigen::MatrixXd jacobian{};  ///< by constraint and unknown
};

struct ConstrainedProblem {
  Eigen::Index constraint_count = 0;
  Eigen::VectorXd start{};
  Eigen::VectorXd lower{};  ///< −∞ where there is none
  Eigen::VectorXd upper{};
  Eigen::VectorXd typical{};
  /// Fills a point whose vectors have the right size; false where the model has no value, and the step is shortened.
  std::function<bool(const Eigen::VectorXd& x, ConstrainedPoint& point)> evaluate{};
};

struct ConstrainedOptions {
  int max_iterations = 150;
  double tolerance = 1e-6;
  double barrier = 1e-1;  ///< what Ipopt's barrier begins with: small where the start is nearly the solution
  std::function<bool(int iteration)> progress{};  ///< false ends the search where it is
};

struct ConstrainedResult {
  FitStatus status = FitStatus::SolverFailed;
  Eigen::VectorXd x{};
  Eigen::VectorXd multipliers{};  ///< of the constraints, 0 where one is not active
};

/// Deterministic. Exceptions of the user's function pass through. The start must have a value.
[[nodiscard]] ConstrainedResult solve(const ConstrainedProblem& problem, const ConstrainedOptions& options);

}  // namespace hysteron
