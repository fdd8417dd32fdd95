// A model of what is left that has no name: does the residual depend on what the machine did, whatever the cause?
//
// Ridge regression of the residual on features of the inputs and outputs of the diagram: powers, rates and their signs,
// delayed and smoothed copies over log-spaced times, play operators of several widths, products with the direction.
// Blocks of the record are predicted from the others. What is predicted that way is no noise, so an unknown effect;
// what is not may be coloured noise as well.
#pragma once

#include <vector>

#include "diagnosis/model/model.hpp"

namespace hysteron::diagnosis {

struct Discrepancy {
  double share = 0.0;      ///< of the variance of the residual, predicted on blocks held out; 0 where none
  double share_low = 0.0;  ///< its lower 95 % bound over the blocks
  double rms = 0.0;        ///< of the predictable part, in the unit of the residuals
};

/// `rows` of one output, record by record, as the model orders them.
[[nodiscard]] Discrepancy discrepancy(const std::vector<Experiment>& experiments, const VectorXd& residuals);

}  // namespace hysteron::diagnosis
