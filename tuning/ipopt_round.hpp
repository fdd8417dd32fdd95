// One run of Ipopt on a least-squares problem in given units. Internal to ipopt_problem.cpp.
#pragma once

#include <Eigen/Core>
#include <string_view>
#include <vector>

#include "tuning/ipopt_problem.hpp"
#include "tuning/least_squares_model.hpp"

namespace hysteron::detail {

/// What one round hands to Ipopt: x = origin + unit·z for the free parameters, cost/cost_unit.
struct Round {
  Eigen::VectorXd origin{};
  Eigen::VectorXd unit{};
  double cost_unit = 1.0;
  std::vector<Eigen::Index> free{};
  double bound_push = 1e-2;
  double barrier = 1e-1;
  double tolerance = 1e-9;  ///< of the gradient in these units
};

struct Outcome {
  FitStatus status = FitStatus::SolverFailed;
  std::string_view name{};   ///< Ipopt's own
  bool stood_still = false;  ///< ended because the cost no longer moved
};

struct RoundResult {
  Outcome outcome{};
  Eigen::VectorXd x{};
};

/// Runs Ipopt once. Exceptions of the user's functions are thrown again here.
RoundResult run_ipopt(Model& model, const Round& round);

}  // namespace hysteron::detail
