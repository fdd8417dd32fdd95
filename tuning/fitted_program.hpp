// The program that a fit has found.
#pragma once

#include <Eigen/Core>

#include "codegen/compile.hpp"
#include "tuning/output_error.hpp"

namespace hysteron {

/// With the fitted values: the parameters and the initial states of the first record.
[[nodiscard]] Program fitted_program(const OutputErrorProblem& problem, const Eigen::VectorXd& x);

}  // namespace hysteron
