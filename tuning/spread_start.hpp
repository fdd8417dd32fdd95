// Points to begin a search from, spread over the bounds of its unknowns.
#pragma once

#include <Eigen/Core>

#include "tuning/ipopt_problem.hpp"

namespace hysteron {

/// Point 0 is the start itself; the others are always the same ones: anywhere between two finite bounds, within a
/// decade of a start above 0 whose lower bound is not below 0, else within two typical sizes of the start.
[[nodiscard]] Eigen::VectorXd spread_start(int point, const Eigen::VectorXd& start, const Eigen::VectorXd& lower,
                                           const Eigen::VectorXd& upper, const Eigen::VectorXd& typical);

[[nodiscard]] inline Eigen::VectorXd spread_start(int point, const LeastSquaresProblem& problem) {
  return spread_start(point, problem.start, problem.lower, problem.upper, problem.typical);
}

}  // namespace hysteron
