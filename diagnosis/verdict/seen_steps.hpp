// A sensor's coarse steps show in the measured values themselves, whatever else there is. Beside an effect that no
// formula repeats, as a delay that varies, what they close in the residual may be too little to name them.
#pragma once

#include <vector>

#include "diagnosis/model/model.hpp"
#include "diagnosis/search/fitting.hpp"

namespace hysteron::diagnosis {

/// Of each output the step on which it lies, in every record, and on which what the explanation says of it does not
/// lie; 0 where there is none, or fewer than four of them hold values. Steps that round off less than 1.3 times the
/// noise floor do not count: a floor that holds the rounding of a sensor is as large.
[[nodiscard]] std::vector<double> seen_steps(const Task& task, const Explanation& calibrated);

/// Whether an output has one.
[[nodiscard]] bool shows_steps(const Task& task, const Explanation& calibrated);

}  // namespace hysteron::diagnosis
