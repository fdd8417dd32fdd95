#include "tuning/excitation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "support/errors.hpp"
#include "tuning/rollout.hpp"

namespace hysteron {
namespace {

Excited excited_by(double standard_error, double size) {
  constexpr double well = 0.05;
  constexpr double weakly = 0.5;
  return standard_error <= well * size     ? Excited::Well
         : standard_error <= weakly * size ? Excited::Weakly
                                           : Excited::No;
}

}  // namespace

Excitation excitation_of(const OutputErrorProblem& problem, const std::vector<double>& noise) {
  detail::Rollout rollout(problem);
  rollout.set_scales(noise);
  Eigen::VectorXd start(rollout.unknowns());
  Eigen::VectorXd beside(rollout.unknowns());
  std::vector<double> sizes;
  Excitation result;
  Eigen::Index j = 0;
  for (const FreeParameter& free : problem.parameters) {
    const double step = 0.1 * free.typical;
    start[j] = free.start;
    beside[j++] = free.upper - free.start > step ? free.start + step
                                                 : std::max(free.start - step, 0.5 * (free.lower + free.start));
    sizes.push_back(std::max(std::fabs(free.start), free.typical));
    result.parameters.push_back({.name = free.name, .unit = free.unit, .value = free.start});
  }
  const std::vector<double> states = rollout.own_states(start);
  for (const detail::Rollout::StateColumn& column : rollout.state_columns()) {
    const FreeState& state = problem.initial_states[column.state];
    const double own = states[static_cast<std::size_t>(j) - problem.parameters.size()];
    start[j] = own;
    beside[j++] = own;
    sizes.push_back(own != 0.0 ? std::fabs(own) : 1.0);
    result.parameters.push_back({.name = problem.experiments.size() > 1 ? fmt::format("{} at the start of record {}",
                                                                                      state.path, column.experiment + 1)
                                                                        : fmt::format("{} at the start", state.path),
                                 .unit = state.unit,
                                 .value = own});
  }
  Eigen::VectorXd residuals(rollout.residual_count());
  Eigen::MatrixXd jacobian(rollout.residual_count(), rollout.unknowns());
  if (!rollout.residuals(start, residuals, &jacobian)) {
    throw InputError(error::start_without_value, {},
                     "The diagram has no finite value on this record with the parameters as they are.",
                     "start from other values, or narrow the bounds in [fit].");
  }
  if ((jacobian.cwiseAbs().colwise().maxCoeff().array() == 0.0).any() && beside.allFinite()) {
    Eigen::MatrixXd there(jacobian.rows(), jacobian.cols());
    if (rollout.residuals(beside, residuals, &there)) {
      jacobian = std::move(there);
    }
  }
  std::vector<std::string> names;
  for (const Excitation::OfParameter& one : result.parameters) {
    names.push_back(one.name);
  }
  // The noise is known: of a sum of squares of N − n, the variance is 1.
  const auto freedom = static_cast<double>(jacobian.rows() - jacobian.cols());
  const Covariance covariance =
      covariance_of(jacobian.transpose() * jacobian, std::max(freedom, 1.0), jacobian.rows(), 1.0, names);
  for (std::size_t k = 0; k < result.parameters.size(); ++k) {
    Excitation::OfParameter& one = result.parameters[k];
    one.standard_error = covariance.standard_errors[static_cast<Eigen::Index>(k)];
    one.excited = excited_by(one.standard_error, sizes[k]);
  }
  result.notes = covariance.warnings;
  return result;
}

}  // namespace hysteron
